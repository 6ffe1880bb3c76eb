// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/carry/carried_blocks.hpp"

#include <algorithm>
#include <utility>

namespace adit::agent {
namespace {

using perception::MapDigest;
using transfer::PeerId;

static_assert(transfer::ContentDigest::kParts == MapDigest::kParts);

constexpr std::uint32_t kCoarse = perception::BlockUpdate::kCoarseRevision;
constexpr std::size_t kLookedAt = 2048;   // Blocks from which one piece is chosen,
constexpr std::size_t kPassed = 10'000;   // after at most so many were looked at.
constexpr std::size_t kComparisons = 64;  // Digests that wait, the oldest of which is dropped.

}  // namespace

std::optional<std::size_t> PeerSlots::join(const PeerId& peer) {
  if (const auto known = find(peer)) return known;
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    if (std::any_of(slots_.begin(), slots_.end(), [slot](const auto& entry) { return entry.second == slot; }))
      continue;
    return slots_[peer] = slot;
  }
  return std::nullopt;
}

std::optional<std::size_t> PeerSlots::find(const PeerId& peer) const {
  const auto found = slots_.find(peer);
  return found == slots_.end() ? std::nullopt : std::optional(found->second);
}

std::size_t CarriedBlocks::Robot::size() const {
  std::size_t out = 0;
  for (const Part& part : parts) out += part.blocks.size();
  return out;
}

std::size_t CarriedBlocks::size(const std::string& robot) const {
  const auto found = robots_.find(robot);
  return found == robots_.end() ? 0 : found->second.size();
}

std::optional<perception::CoarseBlock> CarriedBlocks::find(const perception::SubmapKey& key,
                                                           const perception::BlockIndex& index) const {
  const auto robot = robots_.find(key.robot);
  if (robot == robots_.end()) return std::nullopt;
  const auto submap = robot->second.numbers.find(key);
  if (submap == robot->second.numbers.end()) return std::nullopt;
  const auto& blocks = robot->second.parts[MapDigest::part_of(index)].blocks;
  const auto block = blocks.find({submap->second, index});
  if (block == blocks.end()) return std::nullopt;
  return perception::CoarseBlock{index, block->second.known, block->second.occupied};
}

std::optional<std::size_t> CarriedBlocks::number_of(Robot& robot, const perception::SubmapKey& key) const {
  if (const auto found = robot.numbers.find(key); found != robot.numbers.end()) return found->second;
  if (robot.submaps.size() >= bounds_.max_submaps) return std::nullopt;
  robot.submaps.push_back(key);
  return robot.numbers[key] = robot.submaps.size() - 1;
}

bool CarriedBlocks::take(const perception::MapPiece& piece) {
  if (!robots_.contains(piece.key.robot) && robots_.size() >= bounds_.max_robots) return false;
  Robot& robot = robots_[piece.key.robot];
  const auto submap = number_of(robot, piece.key);
  if (!submap) return false;
  bool complete = true;
  for (const perception::BlockUpdate& update : piece.blocks) {
    perception::CoarseBlock block = update.block;
    const std::uint32_t revision = update.stored_revision();
    Part& part = robot.parts[MapDigest::part_of(block.index)];
    const Ref ref{*submap, block.index};
    auto known = part.blocks.find(ref);
    if (known == part.blocks.end()) {
      if (blocks_ >= bounds_.max_blocks) {
        complete = false;
        continue;
      }
      ++blocks_;
      known = part.blocks.try_emplace(ref).first;
      for (const auto& [peer, slot] : slots_.all()) ++part.missing[slot];
    } else if (!is_newer(known->second.known, known->second.occupied, known->second.revision, update)) {
      continue;
    } else {
      // Also of an equal state: a station may have got another one between the two.
      const Block& old = known->second;
      if (revision == kCoarse) block = merged({block.index, old.known, old.occupied}, block);
      part.sum -= MapDigest::hash(piece.key, {block.index, old.known, old.occupied});
      for (const auto& [peer, slot] : slots_.all()) part.missing[slot] += old.had_by >> slot & 1U;
    }
    part.sum += MapDigest::hash(piece.key, block);
    known->second = {block.known, block.occupied, revision, 0};
  }
  return complete;
}

std::optional<std::size_t> CarriedBlocks::slot_of(const PeerId& peer) const {
  const auto slot = slots_.find(peer);
  return slot && !joining_.contains(*slot) ? slot : std::nullopt;
}

void CarriedBlocks::tick() {
  if (!joining_.empty()) return continue_join(joining_.begin()->first);
  continue_compare();
}

void CarriedBlocks::compare(const PeerId& station, const transfer::ContentDigest& digest) {
  std::erase_if(comparisons_, [&](const Comparison& waits) {
    return waits.station == station && waits.digest.robot == digest.robot;
  });
  if (comparisons_.size() >= kComparisons) comparisons_.pop_front();
  comparisons_.push_back({station, digest, 0});
  continue_compare();
}

void CarriedBlocks::continue_compare() {
  std::size_t looked = 0;
  while (!comparisons_.empty() && looked < bounds_.slice) {
    Comparison& now = comparisons_.front();
    const auto slot = slots_.find(now.station);
    const auto robot = robots_.find(now.digest.robot);
    if (!slot || robot == robots_.end() || now.next_part == MapDigest::kPoses) {
      comparisons_.pop_front();
      continue;
    }
    if (joining_.contains(*slot)) return;
    Part& part = robot->second.parts[now.next_part];
    const bool equal = part.missing[*slot] > 0 && part.sum == now.digest.parts[now.next_part];
    ++now.next_part;
    if (!equal) continue;
    for (auto& [ref, block] : part.blocks) block.had_by |= PeerSlots::bit(*slot);
    part.missing[*slot] = 0;
    looked += part.blocks.size();
  }
}

void CarriedBlocks::join(const PeerId& peer) {
  const auto slot = slots_.join(peer);
  if (!slot) return;
  joining_[*slot] = {};
  continue_join(*slot);
}

void CarriedBlocks::leave(const PeerId& peer) {
  if (const auto slot = slots_.find(peer)) joining_.erase(*slot);
  slots_.leave(peer);
}

bool CarriedBlocks::clear_slice(Cursor& cursor, std::size_t slot) {
  const auto others = static_cast<std::uint16_t>(~PeerSlots::bit(slot));
  std::size_t looked = 0;
  for (auto robot = robots_.lower_bound(cursor.robot); robot != robots_.end(); ++robot) {
    if (robot->first != cursor.robot) cursor = {robot->first, {}};
    for (Position& at = cursor.at; at.part < robot->second.parts.size(); ++at.part, at.ref.reset()) {
      auto& blocks = robot->second.parts[at.part].blocks;
      for (auto block = at.ref ? blocks.lower_bound(*at.ref) : blocks.begin(); block != blocks.end();
           ++block) {
        if (looked++ == bounds_.slice) {
          at.ref = block->first;
          return false;
        }
        block->second.had_by &= others;
      }
    }
  }
  return true;
}

void CarriedBlocks::continue_join(std::size_t slot) {
  if (!clear_slice(joining_.at(slot), slot)) return;
  joining_.erase(slot);
  for (auto& [name, robot] : robots_) {
    robot.lacked_from[slot] = {};
    for (Part& part : robot.parts) part.missing[slot] = part.blocks.size();
  }
}

std::size_t CarriedBlocks::missing(const PeerId& peer) const {
  const auto slot = slots_.find(peer);
  if (!slot) return 0;
  const bool joins = joining_.contains(*slot);
  std::size_t out = 0;
  for (const auto& [name, robot] : robots_) {
    if (!wants_(peer, name)) continue;
    for (const Part& part : robot.parts) out += joins ? part.blocks.size() : part.missing[*slot];
  }
  return out;
}

std::vector<CarriedBlocks::Candidate> CarriedBlocks::lacked(Robot& robot, std::size_t slot) const {
  std::vector<Candidate> out;
  const Position from = std::exchange(robot.lacked_from[slot], {});
  std::size_t looked = 0;
  for (std::size_t i = from.part; i < robot.parts.size() && out.size() < kLookedAt && looked < kPassed; ++i) {
    if (robot.parts[i].missing[slot] == 0) continue;
    const auto& blocks = robot.parts[i].blocks;
    for (auto it = i == from.part && from.ref ? blocks.lower_bound(*from.ref) : blocks.begin();
         it != blocks.end(); ++it) {
      const auto& [ref, block] = *it;
      if (looked++ == kPassed) {
        robot.lacked_from[slot] =
            out.empty() ? Position{i, ref} : Position{out.front().at.part, out.front().at.ref};
        break;
      }
      if ((block.had_by & PeerSlots::bit(slot)) != 0 ||
          (!out.empty() && out.front().at.ref.submap != ref.submap))
        continue;
      out.push_back({{i, ref, block.known, block.occupied, block.revision},
                     {{ref.index, block.known, block.occupied}, block.revision, block.revision == kCoarse}});
    }
  }
  // Equal revisions take no space, and neighbours little.
  std::sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) {
    return std::pair(b.update.revision, a.update.block.index) <
           std::pair(a.update.revision, b.update.block.index);
  });
  return out;
}

void CarriedBlocks::encode_on(Executor& strand, Task ready) {
  strand_ = &strand;
  ready_ = std::move(ready);
}

bool CarriedBlocks::begin_piece(std::span<const PeerId> peers, std::size_t max_bytes) {
  Flight flight;
  std::vector<Candidate> chosen;
  for (auto peer = peers.begin(); peer != peers.end() && chosen.empty(); ++peer) {
    const auto slot = slot_of(*peer);
    if (!slot) continue;
    for (auto robot = robots_.begin(); robot != robots_.end() && chosen.empty(); ++robot)
      if (wants_(*peer, robot->first)) {
        flight.robot = robot->first;
        chosen = lacked(robot->second, *slot);
      }
  }
  if (chosen.empty()) return false;
  chosen.resize(std::min(chosen.size(), perception::kMaxPieceBlocks));
  const Robot& robot = robots_.at(flight.robot);
  PieceJob job{robot.submaps[chosen.front().at.ref.submap], {}, {}, max_bytes};
  for (const Candidate& candidate : chosen) {
    job.blocks.push_back(candidate.update);
    // Of a block in large voxels the revision does not matter, and equal ones take no space.
    if (candidate.update.coarse) job.blocks.back().revision = chosen.front().update.revision;
    flight.blocks.push_back(candidate.at);
  }
  pending_ = Pending{++pieces_begun_, std::move(flight), max_bytes, {}};
  compute_or_now(
      strand_, {.name = "carried piece to send", .modelled = kPieceCoding},
      [job = std::move(job)] { return job.run(); },
      [this, number = pieces_begun_](Result<perception::PackedPiece> packed) {
        if (!pending_ || pending_->number != number) return;
        // Of one that could not be encoded, the blocks are chosen again.
        if (!packed) return pending_.reset();
        pending_->packed = std::move(*packed);
        if (ready_) ready_();
      });
  return true;
}

std::optional<transfer::Source::Content> CarriedBlocks::next(std::span<const PeerId> peers,
                                                             std::size_t max_bytes, Time) {
  // What was encoded for another link, or peers that want it no more, is of no use.
  if (pending_ && pending_->packed) {
    const bool wanted = std::any_of(peers.begin(), peers.end(), [this](const PeerId& peer) {
      return slot_of(peer) && wants_(peer, pending_->content.robot);
    });
    if (!wanted || max_bytes < pending_->max_bytes) pending_.reset();
  }
  if (!pending_ && !begin_piece(peers, max_bytes)) return std::nullopt;
  if (!pending_ || !pending_->packed) return std::nullopt;
  Pending piece = std::move(*pending_);
  pending_.reset();
  piece.content.blocks.resize(piece.packed->count);
  if (piece.content.blocks.empty()) return std::nullopt;
  Robot& robot = robots_.at(piece.content.robot);
  for (const Sent& sent : piece.content.blocks) {
    Part& part = robot.parts[sent.part];
    Block& block = part.blocks.at(sent.ref);
    // A newer state came while the piece was encoded: it goes in another one.
    if (block.revision != sent.revision || block.known != sent.known || block.occupied != sent.occupied)
      continue;
    for (const PeerId& peer : peers) {
      const auto slot = slot_of(peer);
      if (!slot || (block.had_by & PeerSlots::bit(*slot)) != 0) continue;
      block.had_by |= PeerSlots::bit(*slot);
      --part.missing[*slot];
    }
  }
  flights_[++tokens_] = std::move(piece.content);
  return Content{tokens_, std::move(piece.packed->bytes)};
}

void CarriedBlocks::lost(const PeerId& peer, std::uint64_t token) {
  const auto slot = slot_of(peer);
  const auto flight = flights_.find(token);
  if (!slot || flight == flights_.end()) return;
  Robot& robot = robots_.at(flight->second.robot);
  for (const Sent& sent : flight->second.blocks) {
    Part& part = robot.parts[sent.part];
    Block& block = part.blocks.at(sent.ref);
    if (block.revision != sent.revision || (block.had_by & PeerSlots::bit(*slot)) == 0) continue;
    block.had_by &= static_cast<std::uint16_t>(~PeerSlots::bit(*slot));
    ++part.missing[*slot];
  }
}

}  // namespace adit::agent
