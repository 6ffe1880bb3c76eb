// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/block_source.hpp"

#include <algorithm>

#include "perception/stream/piece.hpp"

namespace adit::agent {
namespace {

using perception::BlockIndex;
using perception::BlockUpdate;
using perception::in_large_voxels;
using transfer::PeerId;

constexpr std::uint64_t kAlone = 1ULL << 63U;  // Groups of submaps without a lattice in common.
constexpr double kCovered = 0.9;
constexpr std::size_t kVotes = 3;             // The newest ones decide, see BlockVotes.
constexpr std::size_t kLookedForCovered = 8;  // Oldest submaps: a few ms.
constexpr double kLearned = 0.1;              // Weight of the newest piece in the mean size of a block,
constexpr double kLearnedFrom = 100.0;        // if it has so many.

}  // namespace

void BlockSource::Place::acknowledge(std::uint16_t by) {
  had_by |= by;
  seen_by |= by;
  if (base_change != sent_change) {
    base_known = sent_known;
    base_occupied = sent_occupied;
    base_change = sent_change;
    base_by = missed_by = 0;
  }
  base_by |= by;
  missed_by = static_cast<std::uint16_t>(missed_by & ~by);
}

void BlockSource::Place::forget(std::uint16_t peer) {
  for (std::uint16_t* by :
       {&up_to_date, &had_by, &base_by, &missed_by, &seen_by, &coarse_by, &coarse_missed_by})
    *by = static_cast<std::uint16_t>(*by & ~peer);
}

bool BlockSource::Place::lacks_coarse(std::uint16_t peer) const {
  return (in_large_voxels(known) & ~((coarse_by & peer) != 0 ? coarse_known : 0)) != 0;
}

void BlockSource::open(std::uint32_t submap, const SubmapPlace& place) {
  names_[submap] = place;
  first_.try_emplace(place.group, submap);
}

bool BlockSource::is_first(std::uint32_t submap) const {
  const auto first = first_.find(place_of(submap).group);
  return first == first_.end() || first->second == submap;
}

SubmapPlace BlockSource::place_of(std::uint32_t submap) const {
  const auto named = names_.find(submap);
  return named != names_.end() ? named->second
                               : SubmapPlace{params_.start, submap, kAlone | submap, BlockIndex{}};
}

BlockSource::LatticeCell BlockSource::cell_of(const Ref& ref) const {
  const SubmapPlace place = place_of(ref.submap);
  return {place.group,
          {ref.index.x + place.offset.x, ref.index.y + place.offset.y, ref.index.z + place.offset.z}};
}

BlockSource::Ref BlockSource::ref_in(const LatticeCell& cell, std::uint32_t submap) const {
  const BlockIndex offset = place_of(submap).offset;
  return {submap, {cell.index.x - offset.x, cell.index.y - offset.y, cell.index.z - offset.z}};
}

BlockVotes BlockSource::votes_of(const LatticeCell& cell, const Place& place,
                                 std::optional<std::uint32_t> without) const {
  BlockVotes votes = place.forgotten;
  for (const std::uint32_t submap : place.submaps) {
    if (submap == without) continue;
    const Block& block = blocks_.at(ref_in(cell, submap));
    votes.add(block.known, block.occupied);
  }
  return votes;
}

bool BlockSource::add_missing(BlockRecipient& peer, const LatticeCell& cell, const Place& place) {
  peer.forget(place.change);
  const std::uint64_t has = (place.up_to_date & peer.bit) != 0 ? place.sent_known : 0;
  const bool grows = (in_large_voxels(place.known) & ~in_large_voxels(has)) != 0;
  const bool rests = !place.is_fine(peer.bit) && !place.lacks_coarse(peer.bit);
  (!grows ? peer.changed : rests ? peer.resting : peer.unseen)[place.change] = cell;
  return grows && !rests;
}

void BlockSource::update(std::uint32_t submap, const perception::CoarseBlock& block, std::uint32_t revision) {
  const Ref ref{submap, block.index};
  const auto [found, added] = blocks_.try_emplace(ref);
  Block& stored = found->second;
  if (!added && stored.known == block.known && stored.occupied == block.occupied) return;
  changes_ = std::max<std::uint64_t>(changes_ + 1, revision);
  stored = {block.known, block.occupied, changes_};
  const LatticeCell cell = cell_of(ref);
  Place& place = cells_[cell];
  if (added)
    place.submaps.insert(std::upper_bound(place.submaps.begin(), place.submaps.end(), submap), submap);
  const BlockVotes votes = votes_of(cell, place);
  if (place.change == 0 || votes.known() != place.known || votes.occupied() != place.occupied) {
    bool lacked = false, grew = false;
    for (auto& [id, peer] : peers_) peer.forget(place.change);
    place.known = votes.known();
    place.occupied = votes.occupied();
    place.change = changes_;
    place.changed = now_;
    for (auto& [id, peer] : peers_) {
      if ((place.up_to_date & peer.bit) != 0 && place.is_sent()) continue;
      grew = add_missing(peer, cell, place) || grew;
      lacked = true;
    }
    if (!lacked) place.waits_since.reset(), place.grew_since.reset();
    if (lacked && !place.waits_since) place.waits_since = now_;
    if (grew && !place.grew_since) place.grew_since = now_;
  }
  prune(cell);
  if (blocks_.size() > params_.max_blocks) make_room();
}

void BlockSource::prune(const LatticeCell& cell) {
  const auto found = cells_.find(cell);
  if (found == cells_.end()) return;
  for (std::size_t i = found->second.submaps.size(); i-- > 0;) {
    if (i + kVotes >= found->second.submaps.size() || !is_outvoted(cell, found->second, i)) continue;
    const Ref ref = ref_in(cell, found->second.submaps[i]);
    ++pruned_[ref.submap];
    erase(ref);
  }
}

bool BlockSource::is_outvoted(const LatticeCell& cell, const Place& place, std::size_t position) const {
  std::uint64_t once = 0, twice = 0, thrice = 0;  // Voxels that so many newer submaps know.
  for (std::size_t i = position + 1; i < place.submaps.size(); ++i) {
    const std::uint64_t by = blocks_.at(ref_in(cell, place.submaps[i])).known;
    thrice |= twice & by;
    twice |= once & by;
    once |= by;
  }
  return (blocks_.at(ref_in(cell, place.submaps[position])).known & ~thrice) == 0;
}

std::size_t BlockSource::take_pruned(std::uint32_t submap) {
  const auto found = pruned_.find(submap);
  if (found == pruned_.end()) return 0;
  const std::size_t count = found->second;
  pruned_.erase(found);
  return count;
}

void BlockSource::has(const PeerId& id, const std::set<std::uint32_t>& submaps) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  BlockRecipient& peer = found->second;
  for (auto& [cell, place] : cells_) {
    if (!std::all_of(place.submaps.begin(), place.submaps.end(),
                     [&](std::uint32_t submap) { return submaps.contains(submap); }))
      continue;
    if (place.up_to_date == 0) {
      place.sent_known = place.known;
      place.sent_occupied = place.occupied;
      place.sent_change = place.change;
      place.had_by = 0;
    } else if (!place.is_sent()) {
      continue;
    }
    place.up_to_date |= peer.bit;
    place.acknowledge(peer.bit);
    place.waits_since.reset();
    peer.forget(place.change);
  }
}

bool BlockSource::complete(const PeerId& id, std::uint32_t submap) const {
  const auto peer = peers_.find(id);
  if (peer == peers_.end()) return false;
  for (auto it = blocks_.lower_bound(first_of(submap)); it != blocks_.end() && it->first.submap == submap;
       ++it) {
    const Place& place = cells_.at(cell_of(it->first));
    if (!place.is_sent() || (place.had_by & place.up_to_date & peer->second.bit) == 0) return false;
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

bool BlockSource::is_covered(std::uint32_t submap) const {
  std::size_t all = 0, needed = 0;
  for (auto it = blocks_.lower_bound(first_of(submap)); it != blocks_.end() && it->first.submap == submap;
       ++it, ++all) {
    const LatticeCell cell = cell_of(it->first);
    const Place& place = cells_.at(cell);
    needed += votes_of(cell, place, submap).shows(votes_of(cell, place)) ? 0 : 1;
  }
  return all > 0 && static_cast<double>(needed) < (1.0 - kCovered) * static_cast<double>(all);
}

void BlockSource::erase(const Ref& ref) {
  const auto block = blocks_.find(ref);
  const auto cell = cells_.find(cell_of(ref));
  Place& place = cell->second;
  // Of one that is not the oldest, newer ones know all voxels, or it was dropped for lack of space.
  if (place.submaps.front() == ref.submap) place.forgotten.add(block->second.known, block->second.occupied);
  std::erase(place.submaps, ref.submap);
  blocks_.erase(block);
  if (!place.submaps.empty()) return;
  for (auto& [id, peer] : peers_) peer.forget(place.change);
  cells_.erase(cell);
}

void BlockSource::drop(std::uint32_t submap) {
  for (auto it = blocks_.lower_bound(first_of(submap)); it != blocks_.end() && it->first.submap == submap;
       ++dropped_) {
    const Ref ref = (it++)->first;
    erase(ref);
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
  erase(blocks_.begin()->first);  // One submap alone is too large: its first block goes.
  ++dropped_;
}

void BlockSource::join(const PeerId& id) {
  leave(id);
  if (peers_.size() >= kMaxPeers) return;
  std::uint16_t used = 0;
  for (const auto& [other, peer] : peers_) used |= peer.bit;
  BlockRecipient& peer = peers_[id];
  peer.bit = 1;
  while ((used & peer.bit) != 0) peer.bit = static_cast<std::uint16_t>(peer.bit << 1);
  for (auto& [cell, place] : cells_) {
    if (add_missing(peer, cell, place) && !place.grew_since) place.grew_since = now_;
    if (!place.waits_since) place.waits_since = now_;
  }
  peer.behind = peer.unseen.size() > kBacklog;
}

void BlockSource::leave(const PeerId& id) {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  for (auto& [cell, place] : cells_) place.forget(found->second.bit);
  peers_.erase(found);
}

std::size_t BlockSource::missing(const PeerId& id) const {
  const auto found = peers_.find(id);
  return found == peers_.end()
             ? 0
             : found->second.unseen.size() + found->second.resting.size() + found->second.changed.size();
}

std::optional<transfer::Source::Content> BlockSource::next(std::span<const PeerId> peers,
                                                           std::size_t max_bytes, Time now) {
  now_ = now;
  std::uint16_t to = 0;
  for (const PeerId& id : peers)
    if (const auto peer = peers_.find(id); peer != peers_.end()) to |= peer->second.bit;
  std::vector<Part> chosen;
  // What the one that lacks most lacks may have to wait, while another one lacks what is due.
  for (auto id = peers.begin(); id != peers.end() && chosen.empty(); ++id) {
    const auto peer = peers_.find(*id);
    if (peer == peers_.end()) continue;
    if (is_coarse_first(peer->second, max_bytes)) chosen = choose_coarse(peer->second);
    if (chosen.empty()) chosen = choose(peer->second, max_bytes, now);
  }
  if (chosen.empty()) return std::nullopt;
  const std::uint64_t group = chosen.front().cell.group;
  const auto named = first_.find(group);
  const std::uint32_t submap = named != first_.end() ? named->second : static_cast<std::uint32_t>(group);
  // One revision for all blocks takes no space, and is newer than all that was sent before.
  const auto newest = static_cast<std::uint32_t>(++changes_);
  std::vector<BlockUpdate> updates;
  for (const Part& part : chosen) {
    const Place& place = cells_.at(part.cell);
    updates.push_back({{ref_in(part.cell, submap).index, place.known, place.occupied}, newest, part.coarse});
  }
  const auto find_base = [&](const BlockIndex& index) -> std::optional<perception::CoarseBlock> {
    const Place& place = cells_.at(cell_of({submap, index}));
    if (!place.has_base(to)) return std::nullopt;
    return perception::CoarseBlock{index, place.base_known, place.base_occupied};
  };
  const SubmapPlace name = place_of(submap);
  auto packed = perception::pack({params_.robot, name.start, name.index}, updates, max_bytes, find_base);
  if (packed.count == 0) return std::nullopt;
  chosen.resize(packed.count);
  learn(chosen, to, packed.bytes.size());
  for (Part& part : chosen) {
    Place& place = cells_.at(part.cell);
    part.change = place.change;
    if (part.coarse)
      note_coarse(part.cell, place, to);
    else
      note_sent(part.cell, place, to);
  }
  flights_[++tokens_] = std::move(chosen);
  return Content{tokens_, std::move(packed.bytes)};
}

BlockSource::Bytes BlockSource::bytes_of(const std::vector<Part>& parts, std::uint16_t to) const {
  Bytes out;
  for (const Part& part : parts)
    (part.coarse ? out.coarse : cells_.at(part.cell).has_base(to) ? out.changes : out.complete) += 1.0;
  out.coarse *= coarse_bytes_;
  out.changes *= change_bytes_;
  out.complete *= complete_bytes_;
  return out;
}

void BlockSource::learn(const std::vector<Part>& sent, std::uint16_t to, std::size_t bytes) {
  const Bytes expected = bytes_of(sent, to);
  const double all = expected.sum() - Bytes::kHeader;
  const double factor = (static_cast<double>(bytes) - Bytes::kHeader) / all - 1.0;
  const double weight = std::min(1.0, static_cast<double>(sent.size()) / kLearnedFrom) * kLearned;
  coarse_bytes_ *= 1.0 + weight * factor * expected.coarse / all;
  change_bytes_ *= 1.0 + weight * factor * expected.changes / all;
  complete_bytes_ *= 1.0 + weight * factor * expected.complete / all;
}

void BlockSource::note_coarse(const LatticeCell& cell, Place& place, std::uint16_t to) {
  const std::uint64_t known = in_large_voxels(place.known);
  if (known != place.coarse_known) place.coarse_by = place.coarse_missed_by = 0;
  place.coarse_known = known;
  place.coarse_change = place.change;
  place.coarse_by |= to;
  place.grew_since.reset();
  for (auto& [id, peer] : peers_)
    if ((place.up_to_date & peer.bit) == 0 || !place.is_sent()) add_missing(peer, cell, place);
}

void BlockSource::note_sent(const LatticeCell& cell, Place& place, std::uint16_t to) {
  // A silent peer that acknowledged the same state still has it.
  const auto has = static_cast<std::uint16_t>(place.is_sent() ? place.up_to_date & place.had_by : 0);
  place.waits_since.reset();
  place.grew_since.reset();
  place.sent_known = place.known;
  place.sent_occupied = place.occupied;
  place.sent_change = place.change;
  place.up_to_date = has | to;
  place.had_by = has;
  for (auto& [id, peer] : peers_) {
    if ((place.up_to_date & peer.bit) != 0)
      peer.forget(place.change);
    else
      add_missing(peer, cell, place);  // A peer that is silent now has an older state, or none.
  }
}

void BlockSource::acknowledged(const PeerId& id, std::uint64_t token) {
  const auto peer = peers_.find(id);
  const auto flight = flights_.find(token);
  if (peer == peers_.end() || flight == flights_.end()) return;
  const std::uint16_t bit = peer->second.bit;
  for (const Part& part : flight->second) {
    const auto found = cells_.find(part.cell);
    if (found == cells_.end() || part.coarse) continue;
    Place& place = found->second;
    if (place.sent_change == part.change) {
      place.acknowledge(bit);
    } else if (!place.is_fine(bit)) {
      place.seen_by |= bit;  // It takes no voxels of 0.4 m any more.
      add_missing(peer->second, part.cell, place);
    }
  }
}

void BlockSource::lost(const PeerId& id, std::uint64_t token) {
  const auto peer = peers_.find(id);
  const auto flight = flights_.find(token);
  if (peer == peers_.end() || flight == flights_.end()) return;
  const std::uint16_t bit = peer->second.bit;
  for (const Part& part : flight->second) {
    const auto found = cells_.find(part.cell);
    if (found == cells_.end()) continue;
    Place& place = found->second;
    // A newer state went out since, or it has this one from another piece.
    if (part.coarse ? place.coarse_change != part.change
                    : place.sent_change != part.change || (place.had_by & bit) != 0)
      continue;
    // Twice, it was lost for good: a station that takes no large voxels must get the small ones.
    if (part.coarse && (place.is_fine(bit) || (place.coarse_missed_by & bit) != 0)) continue;
    place.grew_since = Time(Duration::min() / 2);  // Waits are for what arrived.
    if (part.coarse) {
      place.coarse_by &= static_cast<std::uint16_t>(~bit);
      place.coarse_missed_by |= bit;
      peer->second.coarse_below = std::max(peer->second.coarse_below, place.change + 1);
    } else {
      place.waits_since = place.grew_since;
      // Once may be an accident; twice: the peer may have another state than is thought here.
      if ((place.missed_by & bit) != 0) place.base_by &= static_cast<std::uint16_t>(~bit);
      place.missed_by |= bit;
      place.up_to_date &= static_cast<std::uint16_t>(~bit);
    }
    add_missing(peer->second, part.cell, place);
    peer->second.rests_until.reset();
    peer->second.round_ends.reset();
    peer->second.changed_rests_until.reset();
  }
}

}  // namespace adit::agent
