// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/carry/carried_blocks.hpp"

#include <algorithm>

namespace adit::agent {
namespace {

using perception::MapDigest;
using transfer::PeerId;

static_assert(transfer::ContentDigest::kParts == MapDigest::kParts);

constexpr std::uint32_t kCoarse = perception::BlockUpdate::kCoarseRevision;
constexpr std::size_t kLookedAt = 2048;  // Blocks from which one piece is chosen.

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

void CarriedBlocks::compare(const PeerId& station, const transfer::ContentDigest& digest) {
  const auto slot = slots_.find(station);
  const auto robot = robots_.find(digest.robot);
  if (!slot || robot == robots_.end()) return;
  for (std::size_t i = 0; i < MapDigest::kPoses; ++i) {
    Part& part = robot->second.parts[i];
    if (part.missing[*slot] == 0 || part.sum != digest.parts[i]) continue;
    for (auto& [ref, block] : part.blocks) block.had_by |= PeerSlots::bit(*slot);
    part.missing[*slot] = 0;
  }
}

void CarriedBlocks::join(const PeerId& peer) {
  const auto slot = slots_.join(peer);
  if (!slot) return;
  const auto others = static_cast<std::uint16_t>(~PeerSlots::bit(*slot));
  for (auto& [name, robot] : robots_)
    for (Part& part : robot.parts) {
      for (auto& [ref, block] : part.blocks) block.had_by &= others;
      part.missing[*slot] = part.blocks.size();
    }
}

std::size_t CarriedBlocks::missing(const PeerId& peer) const {
  const auto slot = slots_.find(peer);
  if (!slot) return 0;
  std::size_t out = 0;
  for (const auto& [name, robot] : robots_) {
    if (!wants_(peer, name)) continue;
    for (const Part& part : robot.parts) out += part.missing[*slot];
  }
  return out;
}

std::vector<CarriedBlocks::Candidate> CarriedBlocks::lacked(const Robot& robot, std::size_t slot) const {
  std::vector<Candidate> out;
  for (std::size_t i = 0; i < robot.parts.size() && out.size() < kLookedAt; ++i) {
    if (robot.parts[i].missing[slot] == 0) continue;
    for (const auto& [ref, block] : robot.parts[i].blocks) {
      if ((block.had_by & PeerSlots::bit(slot)) != 0 ||
          (!out.empty() && out.front().at.ref.submap != ref.submap))
        continue;
      out.push_back({{i, ref, block.revision},
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

std::optional<transfer::Source::Content> CarriedBlocks::next(std::span<const PeerId> peers,
                                                             std::size_t max_bytes, Time) {
  Flight flight;
  std::vector<Candidate> chosen;
  for (auto peer = peers.begin(); peer != peers.end() && chosen.empty(); ++peer) {
    const auto slot = slots_.find(*peer);
    if (!slot) continue;
    for (auto robot = robots_.begin(); robot != robots_.end() && chosen.empty(); ++robot)
      if (wants_(*peer, robot->first)) {
        flight.robot = robot->first;
        chosen = lacked(robot->second, *slot);
      }
  }
  if (chosen.empty()) return std::nullopt;
  Robot& robot = robots_.at(flight.robot);
  std::vector<perception::BlockUpdate> updates;
  for (const Candidate& candidate : chosen) {
    updates.push_back(candidate.update);
    // Of a block in large voxels the revision does not matter, and equal ones take no space.
    if (candidate.update.coarse) updates.back().revision = chosen.front().update.revision;
  }
  auto packed = perception::pack(robot.submaps[chosen.front().at.ref.submap], updates, max_bytes);
  if (packed.count == 0) return std::nullopt;
  for (std::size_t i = 0; i < packed.count; ++i) {
    Part& part = robot.parts[chosen[i].at.part];
    Block& block = part.blocks.at(chosen[i].at.ref);
    for (const PeerId& peer : peers) {
      const auto slot = slots_.find(peer);
      if (!slot || (block.had_by & PeerSlots::bit(*slot)) != 0) continue;
      block.had_by |= PeerSlots::bit(*slot);
      --part.missing[*slot];
    }
    flight.blocks.push_back(chosen[i].at);
  }
  flights_[++tokens_] = std::move(flight);
  return Content{tokens_, std::move(packed.bytes)};
}

void CarriedBlocks::lost(const PeerId& peer, std::uint64_t token) {
  const auto slot = slots_.find(peer);
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
