// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/block_source.hpp"

#include <algorithm>

#include "perception/stream/piece.hpp"

namespace adit::agent {
namespace {

using perception::BlockIndex;
using perception::in_large_voxels;
using transfer::PeerId;

constexpr std::uint64_t kAloneSubmap = 1ULL << 63U;  // Groups of submaps without a lattice in common.
constexpr double kCovered = 0.9;
constexpr std::size_t kVotes = 3;             // The newest ones decide, see BlockVotes.
constexpr std::size_t kLookedForCovered = 8;  // Oldest submaps: a few ms.

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
                               : SubmapPlace{params_.start, submap, kAloneSubmap | submap, BlockIndex{}};
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

bool BlockSource::add_missing(BlockRecipient& peer, Cell& cell) {
  const Place& place = cell.second;
  peer.forget(place.change);
  const std::uint64_t has = (place.up_to_date & peer.bit) != 0 ? place.sent_known : 0;
  const bool grows = (in_large_voxels(place.known) & ~in_large_voxels(has)) != 0;
  const bool rests = !place.is_fine(peer.bit) && !place.lacks_coarse(peer.bit);
  (!grows ? peer.changed : rests ? peer.resting : peer.unseen)[place.change] = &cell;
  return grows && !rests;
}

void BlockSource::update(std::uint32_t submap, const perception::CoarseBlock& block, std::uint32_t revision) {
  const Ref ref{submap, block.index};
  const auto [found, added] = blocks_.try_emplace(ref);
  Block& stored = found->second;
  if (!added && stored.known == block.known && stored.occupied == block.occupied) return;
  changes_ = std::max<std::uint64_t>(changes_ + 1, revision);
  stored = {block.known, block.occupied, changes_};
  Cell& entry = *cells_.try_emplace(cell_of(ref)).first;
  const LatticeCell cell = entry.first;
  Place& place = entry.second;
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
      if (!peer.covers(cell) || ((place.up_to_date & peer.bit) != 0 && place.is_sent())) continue;
      grew = add_missing(peer, entry) || grew;
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
  for (auto cell = cells_.begin(); cell != cells_.end() && peer.covers(cell->first); ++cell)
    note_had(peer, *cell, submaps);
  if (!peer.has_joined()) peer.has = submaps;
}

void BlockSource::note_had(BlockRecipient& peer, Cell& cell, const std::set<std::uint32_t>& submaps) {
  Place& place = cell.second;
  if (!std::all_of(place.submaps.begin(), place.submaps.end(),
                   [&](std::uint32_t submap) { return submaps.contains(submap); }))
    return;
  if (place.up_to_date == 0) {
    place.sent_known = place.known;
    place.sent_occupied = place.occupied;
    place.sent_change = place.change;
    place.had_by = 0;
  } else if (!place.is_sent()) {
    return;
  }
  place.up_to_date |= peer.bit;
  place.acknowledge(peer.bit);
  place.waits_since.reset();
  peer.forget(place.change);
}

bool BlockSource::complete(const PeerId& id, std::uint32_t submap) const {
  const auto peer = peers_.find(id);
  if (peer == peers_.end() || !peer->second.has_joined()) return false;
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

void BlockSource::tick(Time now) {
  now_ = now;
  const auto joining =
      std::find_if(peers_.begin(), peers_.end(), [](const auto& peer) { return !peer.second.has_joined(); });
  if (joining != peers_.end()) continue_join(joining->second);
}

void BlockSource::join(const PeerId& id) {
  leave(id);
  if (peers_.size() >= kMaxPeers) return;
  std::uint16_t used = 0;
  for (const auto& [other, peer] : peers_) used |= peer.bit;
  BlockRecipient& peer = peers_[id];
  peer.bit = 1;
  while ((used & peer.bit) != 0) peer.bit = static_cast<std::uint16_t>(peer.bit << 1);
  // The bases of a piece that is encoded may be those of the peer that had this bit before.
  if (pending_ && (pending_->to & peer.bit) != 0) pending_.reset();
  peer.joins_from = cells_.empty() ? LatticeCell{} : cells_.begin()->first;
  continue_join(peer);
}

void BlockSource::continue_join(BlockRecipient& peer) {
  auto cell = cells_.lower_bound(*peer.joins_from);
  for (std::size_t looked = 0; cell != cells_.end() && looked < params_.slice; ++cell, ++looked) {
    Place& place = cell->second;
    place.forget(peer.bit);
    if (add_missing(peer, *cell) && !place.grew_since) place.grew_since = now_;
    if (!place.waits_since) place.waits_since = now_;
    if (!peer.has.empty()) note_had(peer, *cell, peer.has);
  }
  if (cell != cells_.end()) {
    peer.joins_from = cell->first;
    return;
  }
  peer.joins_from.reset();
  peer.has.clear();
  peer.behind = peer.unseen.size() > kBacklog;
}

// Its bits stay until another peer joins under them.
void BlockSource::leave(const PeerId& id) { peers_.erase(id); }

std::size_t BlockSource::missing(const PeerId& id) const {
  const auto found = peers_.find(id);
  if (found == peers_.end()) return 0;
  const BlockRecipient& peer = found->second;
  return peer.has_joined() ? peer.unseen.size() + peer.resting.size() + peer.changed.size() : cells_.size();
}

}  // namespace adit::agent
