// SPDX-License-Identifier: Apache-2.0
// The pieces of a map on their way: what goes into one, when it is encoded, and what arrived.
#include <algorithm>

#include "robot_agent/perception/block_source.hpp"

namespace adit::agent {
namespace {

using perception::BlockUpdate;
using transfer::PeerId;

constexpr double kLearned = 0.1;        // Weight of the newest piece in the mean size of a block,
constexpr double kLearnedFrom = 100.0;  // if it has so many.

}  // namespace

void BlockSource::encode_on(Executor& strand, Task ready) {
  strand_ = &strand;
  ready_ = std::move(ready);
}

std::uint16_t BlockSource::bits_of(std::span<const PeerId> peers) const {
  std::uint16_t bits = 0;
  for (const PeerId& id : peers)
    if (const auto peer = peers_.find(id); peer != peers_.end() && peer->second.has_joined())
      bits |= peer->second.bit;
  return bits;
}

std::optional<transfer::Source::Content> BlockSource::next(std::span<const PeerId> peers,
                                                           std::size_t max_bytes, Time now) {
  now_ = now;
  const std::uint16_t to = bits_of(peers);
  // What was encoded for other peers, or another link, is of no use.
  if (pending_ && pending_->packed && ((to & ~pending_->to) != 0 || max_bytes < pending_->max_bytes))
    pending_.reset();
  if (!pending_ && !begin_piece(peers, max_bytes, now)) return std::nullopt;
  if (!pending_ || !pending_->packed || to == 0) return std::nullopt;
  Pending piece = std::move(*pending_);
  pending_.reset();
  piece.parts.resize(piece.packed->count);
  if (piece.parts.empty()) return std::nullopt;
  learn(piece.parts, piece.packed->bytes.size());
  note_parts(piece.parts, to);
  flights_[++tokens_] = std::move(piece.parts);
  return Content{tokens_, std::move(piece.packed->bytes)};
}

bool BlockSource::begin_piece(std::span<const PeerId> peers, std::size_t max_bytes, Time now) {
  std::vector<Part> chosen;
  // What the one that lacks most lacks may have to wait, while another one lacks what is due.
  for (auto id = peers.begin(); id != peers.end() && chosen.empty(); ++id) {
    const auto peer = peers_.find(*id);
    if (peer == peers_.end() || !peer->second.has_joined()) continue;
    if (is_coarse_first(peer->second, max_bytes)) chosen = choose_coarse(peer->second);
    if (chosen.empty()) chosen = choose(peer->second, max_bytes, now);
  }
  if (chosen.empty()) return false;
  const std::uint16_t to = bits_of(peers);
  const std::uint64_t group = chosen.front().cell.group;
  const auto named = first_.find(group);
  const std::uint32_t submap = named != first_.end() ? named->second : static_cast<std::uint32_t>(group);
  const SubmapPlace name = place_of(submap);
  // One revision for all blocks takes no space, and is newer than all that was sent before.
  const auto newest = static_cast<std::uint32_t>(++changes_);
  PieceJob job{{params_.robot, name.start, name.index}, {}, {}, max_bytes};
  for (Part& part : chosen) {
    const Place& place = cells_.at(part.cell);
    const perception::BlockIndex index = ref_in(part.cell, submap).index;
    part.known = place.known;
    part.occupied = place.occupied;
    part.change = place.change;
    part.based = place.has_base(to);
    job.blocks.push_back({{index, place.known, place.occupied}, newest, part.coarse});
    if (part.based) job.bases[index] = {index, place.base_known, place.base_occupied};
  }
  pending_ = Pending{++pieces_begun_, std::move(chosen), to, max_bytes, {}};
  compute_or_now(
      strand_, {.name = "map piece", .modelled = kPieceCoding}, [job = std::move(job)] { return job.run(); },
      [this, number = pieces_begun_](Result<perception::PackedPiece> packed) {
        if (!pending_ || pending_->number != number) return;
        // Of one that could not be encoded, the blocks are chosen again.
        if (!packed) return pending_.reset();
        pending_->packed = std::move(*packed);
        if (ready_) ready_();
      });
  return true;
}

void BlockSource::note_parts(const std::vector<Part>& parts, std::uint16_t to) {
  for (const Part& part : parts) {
    const auto found = cells_.find(part.cell);
    if (found == cells_.end()) continue;  // It was erased while the piece was encoded.
    if (part.coarse)
      note_coarse(*found, part, to);
    else
      note_sent(*found, part, to);
  }
}

BlockSource::Bytes BlockSource::expected(Bytes counts) const {
  counts.coarse *= coarse_bytes_;
  counts.changes *= change_bytes_;
  counts.complete *= complete_bytes_;
  return counts;
}

void BlockSource::learn(const std::vector<Part>& sent, std::size_t bytes) {
  Bytes counts;
  for (const Part& part : sent) counts.add(part.coarse, part.based);
  const Bytes expects = expected(counts);
  const double all = expects.sum() - Bytes::kHeader;
  const double factor = (static_cast<double>(bytes) - Bytes::kHeader) / all - 1.0;
  const double weight = std::min(1.0, static_cast<double>(sent.size()) / kLearnedFrom) * kLearned;
  coarse_bytes_ *= 1.0 + weight * factor * expects.coarse / all;
  change_bytes_ *= 1.0 + weight * factor * expects.changes / all;
  complete_bytes_ *= 1.0 + weight * factor * expects.complete / all;
}

void BlockSource::note_coarse(Cell& cell, const Part& part, std::uint16_t to) {
  Place& place = cell.second;
  const std::uint64_t known = perception::in_large_voxels(part.known);
  if (known != place.coarse_known) place.coarse_by = place.coarse_missed_by = 0;
  place.coarse_known = known;
  place.coarse_change = part.change;
  place.coarse_by |= to;
  place.grew_since.reset();
  bool grew = false;
  for (auto& [id, peer] : peers_)
    if (peer.covers(cell.first) && ((place.up_to_date & peer.bit) == 0 || !place.is_sent()))
      grew = add_missing(peer, cell) || grew;
  if (grew && place.change != part.change) place.grew_since = place.changed;
}

void BlockSource::note_sent(Cell& cell, const Part& part, std::uint16_t to) {
  Place& place = cell.second;
  // A silent peer that acknowledged the same state still has it.
  const bool same =
      place.sent_change != 0 && place.sent_known == part.known && place.sent_occupied == part.occupied;
  const auto has = static_cast<std::uint16_t>(same ? place.up_to_date & place.had_by : 0);
  place.waits_since.reset();
  place.grew_since.reset();
  place.sent_known = part.known;
  place.sent_occupied = part.occupied;
  place.sent_change = part.change;
  place.up_to_date = has | to;
  place.had_by = has;
  bool lacked = false, grew = false;
  for (auto& [id, peer] : peers_) {
    if (!peer.covers(cell.first)) continue;
    if ((place.up_to_date & peer.bit) != 0 && place.is_sent()) {
      peer.forget(place.change);
      continue;
    }
    // A peer that is silent now has an older state, or none; or the place changed while the piece was
    // encoded.
    grew = add_missing(peer, cell) || grew;
    lacked = true;
  }
  if (place.change == part.change) return;
  if (lacked) place.waits_since = place.changed;
  if (grew) place.grew_since = place.changed;
}

void BlockSource::acknowledged(const PeerId& id, std::uint64_t token) {
  const auto peer = peers_.find(id);
  const auto flight = flights_.find(token);
  if (peer == peers_.end() || !peer->second.has_joined() || flight == flights_.end()) return;
  const std::uint16_t bit = peer->second.bit;
  for (const Part& part : flight->second) {
    const auto found = cells_.find(part.cell);
    if (found == cells_.end() || part.coarse) continue;
    Place& place = found->second;
    if (place.sent_change == part.change) {
      place.acknowledge(bit);
    } else if (!place.is_fine(bit)) {
      place.seen_by |= bit;  // It takes no voxels of 0.4 m any more.
      add_missing(peer->second, *found);
    }
  }
}

void BlockSource::lost(const PeerId& id, std::uint64_t token) {
  const auto peer = peers_.find(id);
  const auto flight = flights_.find(token);
  if (peer == peers_.end() || !peer->second.has_joined() || flight == flights_.end()) return;
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
    add_missing(peer->second, *found);
    peer->second.rests_until.reset();
    peer->second.round_ends.reset();
    peer->second.changed_rests_until.reset();
  }
}

}  // namespace adit::agent
