// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/block_source.hpp"

#include <algorithm>

#include "perception/stream/piece.hpp"

namespace adit::agent {
namespace {

using perception::BlockIndex;
using perception::BlockUpdate;
using transfer::PeerId;

constexpr std::uint64_t kAlone = 1ULL << 63U;  // Groups of submaps without a lattice in common.
constexpr double kCovered = 0.9;
constexpr std::size_t kVotes = 3;             // The newest ones decide, see BlockVotes.
constexpr std::size_t kLookedForCovered = 8;  // Oldest submaps: a few ms.
constexpr double kLearned = 0.1;              // Weight of the newest piece in the mean size of a block.

/// The voxels of 0.4 m of a block of which any part is in these of 0.2 m; each is the first of its eight.
std::uint64_t halved(std::uint64_t voxels) {
  voxels |= voxels >> 1;
  voxels |= voxels >> 4;
  voxels |= voxels >> 16;
  return voxels & 0x0000'0505'0000'0505ULL;
}

}  // namespace

SubmapPlace BlockSource::place_of(std::uint32_t submap) const {
  const auto named = names_.find(submap);
  return named != names_.end() ? named->second
                               : SubmapPlace{params_.start, submap, kAlone | submap, BlockIndex{}};
}

BlockSource::Cell BlockSource::cell_of(const Ref& ref) const {
  const SubmapPlace place = place_of(ref.submap);
  return {place.group,
          {ref.index.x + place.offset.x, ref.index.y + place.offset.y, ref.index.z + place.offset.z}};
}

BlockSource::Ref BlockSource::ref_in(const Cell& cell, std::uint32_t submap) const {
  const BlockIndex offset = place_of(submap).offset;
  return {submap, {cell.index.x - offset.x, cell.index.y - offset.y, cell.index.z - offset.z}};
}

bool BlockSource::grows(const Peer& peer, const Ref& ref) const {
  std::uint64_t known = 0;
  const Cell cell = cell_of(ref);
  for (const std::uint32_t submap : cells_.at(cell).submaps) {
    const Entry& entry = blocks_.at(ref_in(cell, submap));
    if ((entry.up_to_date & peer.bit) != 0) known |= entry.sent_known;
  }
  return (halved(blocks_.at(ref).known) & ~halved(known)) != 0;
}

void BlockSource::add_missing(Peer& peer, const Ref& ref, Entry& entry) {
  if (!entry.waits_since) entry.waits_since = now_;
  peer.unseen.erase(entry.change);
  peer.changed.erase(entry.change);
  (grows(peer, ref) ? peer.unseen : peer.changed)[entry.change] = ref;
}

void BlockSource::queue(Peer& peer, const Cell& cell) {
  const std::vector<std::uint32_t>& submaps = cells_.at(cell).submaps;
  const bool any = std::any_of(submaps.begin(), submaps.end(), [&](std::uint32_t submap) {
    return (blocks_.at(ref_in(cell, submap)).chosen_for & peer.bit) != 0;
  });
  if (!any) return choose_fewest(peer, cell, submaps);
  for (const std::uint32_t submap : submaps) {
    const Ref ref = ref_in(cell, submap);
    Entry& entry = blocks_.at(ref);
    const bool chosen = (entry.chosen_for & peer.bit) != 0;
    const bool stale = (entry.up_to_date & peer.bit) == 0 || entry.sent_known != entry.known ||
                       entry.sent_occupied != entry.occupied;
    if (chosen && !stale) continue;
    add_missing(peer, ref, entry);
  }
}

void BlockSource::update(std::uint32_t submap, const perception::CoarseBlock& block, std::uint32_t revision) {
  const Ref ref{submap, block.index};
  const auto [found, added] = blocks_.try_emplace(ref);
  Entry& entry = found->second;
  if (!added && entry.known == block.known && entry.occupied == block.occupied) return;
  const std::uint64_t before = entry.change;
  entry.known = block.known;
  entry.occupied = block.occupied;
  changes_ = std::max<std::uint64_t>(changes_ + 1, revision);
  entry.change = changes_;
  const Cell cell = cell_of(ref);
  Place& place = cells_[cell];
  place.changed = now_;
  std::vector<std::uint32_t>& submaps = place.submaps;
  if (added) submaps.insert(std::upper_bound(submaps.begin(), submaps.end(), submap), submap);
  for (auto& [id, peer] : peers_) {
    peer.unseen.erase(before);
    peer.changed.erase(before);
    queue(peer, cell);
  }
  prune(cell);
  if (blocks_.size() > params_.max_blocks) make_room();
}

void BlockSource::prune(const Cell& cell) {
  const auto found = cells_.find(cell);
  if (found == cells_.end() || found->second.submaps.size() <= kVotes) return;
  const std::vector<std::uint32_t> submaps = found->second.submaps;
  for (std::size_t i = submaps.size() - kVotes; i-- > 0;) {
    const Ref ref = ref_in(cell, submaps[i]);
    const Entry& entry = blocks_.at(ref);
    // A peer that has the block must have what outvotes it, too: it forgets nothing.
    bool outvoted = is_outvoted(entry.known, cell, submaps, i, 0);
    for (const auto& [id, peer] : peers_)
      if (outvoted && (entry.chosen_for & peer.bit) != 0)
        outvoted = is_outvoted(entry.known | entry.sent_known, cell, submaps, i, peer.bit);
    if (!outvoted) continue;
    erase(ref);
    ++pruned_[ref.submap];
  }
}

bool BlockSource::is_outvoted(std::uint64_t known, const Cell& cell,
                              const std::vector<std::uint32_t>& submaps, std::size_t position,
                              std::uint16_t peer) const {
  std::uint64_t once = 0, twice = 0, thrice = 0;  // Voxels that so many newer submaps know.
  for (std::size_t i = position + 1; i < submaps.size(); ++i) {
    const auto found = blocks_.find(ref_in(cell, submaps[i]));
    if (found == blocks_.end()) continue;  // Erased just now.
    const Entry& entry = found->second;
    if (peer != 0 && (entry.had_by & entry.up_to_date & peer) == 0) continue;
    const std::uint64_t by = peer != 0 ? entry.sent_known & entry.known : entry.known;
    thrice |= twice & by;
    twice |= once & by;
    once |= by;
  }
  return (known & ~thrice) == 0;
}

std::size_t BlockSource::take_pruned(std::uint32_t submap) {
  const auto found = pruned_.find(submap);
  if (found == pruned_.end()) return 0;
  const std::size_t count = found->second;
  pruned_.erase(found);
  return count;
}

void BlockSource::has(const PeerId& id, std::uint32_t submap) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  Peer& peer = found->second;
  for (auto it = blocks_.lower_bound(first_of(submap)); it != blocks_.end() && it->first.submap == submap;
       ++it) {
    Entry& entry = it->second;
    if (entry.up_to_date == 0) {
      entry.sent_known = entry.known;
      entry.sent_occupied = entry.occupied;
    } else if (entry.sent_known != entry.known || entry.sent_occupied != entry.occupied) {
      continue;
    }
    entry.had_by |= peer.bit;
    entry.chosen_for |= peer.bit;
    entry.up_to_date |= peer.bit;
    peer.unseen.erase(entry.change);
    peer.changed.erase(entry.change);
  }
}

bool BlockSource::complete(const PeerId& id, std::uint32_t submap) const {
  const auto peer = peers_.find(id);
  if (peer == peers_.end()) return false;
  for (auto it = blocks_.lower_bound(first_of(submap)); it != blocks_.end() && it->first.submap == submap;
       ++it) {
    const Entry& entry = it->second;
    if ((entry.chosen_for & peer->second.bit) != 0 && (entry.had_by & peer->second.bit) == 0) return false;
    if (peer->second.unseen.contains(entry.change) || peer->second.changed.contains(entry.change))
      return false;
  }
  return true;
}

void BlockSource::for_each(
    std::uint32_t submap,
    const std::function<void(const perception::CoarseBlock&, std::uint32_t)>& visit) const {
  for (auto it = blocks_.lower_bound(first_of(submap)); it != blocks_.end() && it->first.submap == submap;
       ++it)
    visit({it->first.index, it->second.known, it->second.occupied},
          static_cast<std::uint32_t>(it->second.change));
}

BlockVotes BlockSource::votes_of(const Cell& cell, const std::vector<std::uint32_t>& submaps) const {
  BlockVotes all;
  for (const std::uint32_t submap : submaps) {
    const Entry& entry = blocks_.at(ref_in(cell, submap));
    all.add(entry.known, entry.occupied);
  }
  return all;
}

std::vector<BlockSource::Ref> BlockSource::fewest(const Cell& cell,
                                                  const std::vector<std::uint32_t>& submaps) const {
  const BlockVotes all = votes_of(cell, submaps);
  std::vector<Ref> out;
  for (std::size_t first = submaps.size(); first-- > 0;) {
    out.push_back(ref_in(cell, submaps[first]));
    BlockVotes some;
    for (auto it = out.rbegin(); it != out.rend(); ++it)
      some.add(blocks_.at(*it).known, blocks_.at(*it).occupied);
    if (some.shows(all)) break;
  }
  return out;
}

void BlockSource::choose_fewest(Peer& peer, const Cell& cell, const std::vector<std::uint32_t>& submaps) {
  for (const Ref& ref : fewest(cell, submaps)) {
    Entry& entry = blocks_.at(ref);
    entry.chosen_for |= peer.bit;
    if (!entry.waits_since) entry.waits_since = now_;
    peer.unseen[entry.change] = ref;
  }
}

bool BlockSource::is_covered(std::uint32_t submap) const {
  std::size_t all = 0, needed = 0;
  for (auto it = blocks_.lower_bound(first_of(submap)); it != blocks_.end() && it->first.submap == submap;
       ++it, ++all) {
    const Cell cell = cell_of(it->first);
    const std::vector<Ref> shown = fewest(cell, cells_.at(cell).submaps);
    needed += std::find(shown.begin(), shown.end(), it->first) != shown.end() ? 1 : 0;
  }
  return all > 0 && static_cast<double>(needed) < (1.0 - kCovered) * static_cast<double>(all);
}

void BlockSource::erase(const Ref& ref) {
  const auto found = blocks_.find(ref);
  for (auto& [id, peer] : peers_) {
    peer.unseen.erase(found->second.change);
    peer.changed.erase(found->second.change);
  }
  const auto cell = cells_.find(cell_of(ref));
  std::erase(cell->second.submaps, ref.submap);
  blocks_.erase(found);
  if (cell->second.submaps.empty()) cells_.erase(cell);
}

void BlockSource::remove(const Ref& ref) {
  const Cell cell = cell_of(ref);
  erase(ref);
  ++dropped_;
  if (cells_.contains(cell))
    for (auto& [id, peer] : peers_) queue(peer, cell);
}

void BlockSource::drop(std::uint32_t submap) {
  for (auto it = blocks_.lower_bound(first_of(submap)); it != blocks_.end() && it->first.submap == submap;) {
    const Ref ref = (it++)->first;
    remove(ref);
  }
}

std::optional<std::uint32_t> BlockSource::oldest_to_drop() const {
  if (blocks_.empty() || blocks_.begin()->first.submap == blocks_.rbegin()->first.submap) return std::nullopt;
  const std::uint32_t oldest = blocks_.begin()->first.submap, newest = blocks_.rbegin()->first.submap;
  auto at = blocks_.begin();
  for (std::size_t looked = 0; looked < kLookedForCovered && at->first.submap != newest; ++looked) {
    if (is_covered(at->first.submap)) return at->first.submap;
    at = blocks_.lower_bound(first_of(at->first.submap + 1));
  }
  return oldest;
}

void BlockSource::make_room() {
  if (const auto submap = oldest_to_drop()) return drop(*submap);
  remove(blocks_.begin()->first);  // One submap alone is too large: its first block goes.
}

void BlockSource::join(const PeerId& id) {
  leave(id);
  if (peers_.size() >= kMaxPeers) return;
  std::uint16_t used = 0;
  for (const auto& [other, peer] : peers_) used |= peer.bit;
  Peer& peer = peers_[id];
  peer.bit = 1;
  while ((used & peer.bit) != 0) peer.bit = static_cast<std::uint16_t>(peer.bit << 1);
  for (const auto& [cell, place] : cells_) choose_fewest(peer, cell, place.submaps);
}

void BlockSource::leave(const PeerId& id) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  const auto others = static_cast<std::uint16_t>(~found->second.bit);
  for (auto& [ref, entry] : blocks_) {
    entry.had_by &= others;
    entry.chosen_for &= others;
    entry.up_to_date &= others;
  }
  peers_.erase(found);
}

std::size_t BlockSource::missing(const PeerId& id) const {
  const auto found = peers_.find(id);
  return found == peers_.end() ? 0 : found->second.unseen.size() + found->second.changed.size();
}

std::optional<transfer::Source::Content> BlockSource::next(std::span<const PeerId> peers,
                                                           std::size_t max_bytes, Time now) {
  const auto first = peers_.find(peers.front());
  if (first == peers_.end()) return std::nullopt;
  now_ = now;
  const std::vector<Ref> chosen = choose(first->second, max_bytes, now);
  if (chosen.empty()) return std::nullopt;
  // One revision for all blocks takes no space. The newest one will do: whatever changes one of them later is
  // newer still.
  std::uint64_t newest = 0;
  for (const Ref& ref : chosen) newest = std::max(newest, blocks_.at(ref).change);
  std::vector<BlockUpdate> updates;
  for (const Ref& ref : chosen) {
    const Entry& entry = blocks_.at(ref);
    updates.push_back({{ref.index, entry.known, entry.occupied}, static_cast<std::uint32_t>(newest)});
  }
  const SubmapPlace place = place_of(chosen.front().submap);
  auto packed = perception::pack({params_.robot, place.start, place.index}, updates, max_bytes);
  if (packed.count == 0) return std::nullopt;
  block_bytes_ += kLearned * (static_cast<double>(packed.bytes.size()) / static_cast<double>(packed.count) -
                              block_bytes_);
  std::vector<Part>& parts = flights_[++tokens_];
  for (std::size_t i = 0; i < packed.count; ++i) {
    Entry& entry = blocks_.at(chosen[i]);
    entry.waits_since.reset();
    entry.sent_known = entry.known;
    entry.sent_occupied = entry.occupied;
    entry.sent_change = entry.change;
    entry.up_to_date = 0;
    parts.push_back({chosen[i], entry.change});
    for (const PeerId& id : peers) {
      const auto peer = peers_.find(id);
      if (peer == peers_.end()) continue;
      entry.chosen_for |= peer->second.bit;
      entry.up_to_date |= peer->second.bit;
      peer->second.unseen.erase(entry.change);
      peer->second.changed.erase(entry.change);
    }
    // A peer that is silent now has an older state, or none.
    for (auto& [id, peer] : peers_)
      if ((entry.chosen_for & peer.bit) != 0 && (entry.up_to_date & peer.bit) == 0)
        add_missing(peer, chosen[i], entry);
    // What the peer shows of this place changes now: other blocks of it may be needed that were not.
    for (const PeerId& id : peers)
      if (const auto peer = peers_.find(id); peer != peers_.end()) queue(peer->second, cell_of(chosen[i]));
  }
  return Content{tokens_, std::move(packed.bytes)};
}

void BlockSource::acknowledged(const PeerId& id, std::uint64_t token) {
  const auto peer = peers_.find(id);
  const auto flight = flights_.find(token);
  if (peer == peers_.end() || flight == flights_.end()) return;
  for (const Part& part : flight->second) {
    const auto block = blocks_.find(part.ref);
    if (block == blocks_.end()) continue;
    Entry& entry = block->second;
    entry.had_by |= peer->second.bit;
  }
}

void BlockSource::lost(const PeerId& id, std::uint64_t token) {
  const auto peer = peers_.find(id);
  const auto flight = flights_.find(token);
  if (peer == peers_.end() || flight == flights_.end()) return;
  for (const Part& part : flight->second) {
    const auto block = blocks_.find(part.ref);
    if (block == blocks_.end()) continue;
    Entry& entry = block->second;
    if (entry.sent_change != part.change) continue;  // A newer state went out since.
    entry.up_to_date &= static_cast<std::uint16_t>(~peer->second.bit);
    entry.waits_since = Time(Duration::min() / 2);  // The hold is for what arrived.
    add_missing(peer->second, part.ref, entry);
    peer->second.rests_until.reset();
    peer->second.round_ends.reset();
    peer->second.changed_rests_until.reset();
  }
}

}  // namespace adit::agent
