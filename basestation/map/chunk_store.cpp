// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/chunk_store.hpp"

namespace adit::station {
namespace {

using perception::BlockIndex;
using perception::CoarseBlock;

}  // namespace

ChunkStore::Submap* ChunkStore::submap(const std::string& robot, const perception::SubmapKey& key) {
  const auto found = robots_.find(robot);
  if (key.robot != robot || found == robots_.end()) return nullptr;
  auto& submaps = found->second.submaps;
  if (const auto known = submaps.find(key); known != submaps.end()) return &known->second;
  if (submaps.size() >= params_.max_submaps) return nullptr;
  return &submaps[key];
}

const ChunkStore::Submap* ChunkStore::find(const perception::SubmapKey& key) const {
  const auto robot = robots_.find(key.robot);
  if (robot == robots_.end()) return nullptr;
  const auto submap = robot->second.submaps.find(key);
  return submap != robot->second.submaps.end() ? &submap->second : nullptr;
}

std::optional<CoarseBlock> ChunkStore::find(const perception::SubmapKey& key, const BlockIndex& index) const {
  const Submap* submap = find(key);
  if (submap == nullptr) return std::nullopt;
  const auto block = submap->blocks.find(index);
  if (block == submap->blocks.end()) return std::nullopt;
  return CoarseBlock{index, block->second.known, block->second.occupied};
}

void ChunkStore::clear() {
  robots_.clear();
  blocks_ = carried_blocks_ = 0;
  evicted_ = 0;
  ++revision_;
}

bool ChunkStore::make_room(const std::string& robot) {
  // While the disk is read, all are from before.
  if (const auto asks = robots_.find(robot); asks != robots_.end() && !asks->second.heard) return false;
  for (auto it = robots_.begin(); it != robots_.end(); ++it) {
    if (it->second.heard || it->first == robot) continue;
    blocks_ -= it->second.blocks;
    carried_blocks_ -= it->second.carried_blocks;
    evicted_ += it->second.pieces > 0 ? 1 : 0;  // The robot itself does not count on what was carried.
    robots_.erase(it);
    ++revision_;
    return true;
  }
  return false;
}

bool ChunkStore::count(const std::string& robot, std::size_t bytes, std::uint32_t waiting,
                       std::optional<Time> now) {
  if (!robots_.contains(robot) && robots_.size() >= params_.max_robots && !(now && make_room(robot)))
    return false;
  RobotMap& from = robots_[robot];
  from.bytes += bytes;
  ++from.pieces;
  from.waiting = waiting;
  from.heard = now;
  set_now(now);
  return true;
}

bool ChunkStore::take(const std::string& robot, const perception::MapPiece& piece) {
  Submap* into = submap(robot, piece.key);
  if (into == nullptr) {
    refused_ += piece.blocks.size();
    return false;
  }
  bool complete = true;
  if (const std::uint32_t owner = perception::owner_of(piece.key.start); owner != 0)
    robots_.at(robot).owners[owner] = ++direct_parts_;
  for (const perception::BlockUpdate& update : piece.blocks) {
    const auto known = into->blocks.find(update.block.index);
    if (known == into->blocks.end()) {
      while (blocks_ >= params_.max_blocks && make_room(robot)) {
      }
      if (blocks_ >= params_.max_blocks) {
        ++refused_;
        complete = false;
        continue;
      }
    } else if ((known->second.carried == 0 || update.coarse) &&
               !is_newer(known->second.known, known->second.occupied, known->second.revision, update)) {
      continue;
    }
    put(robots_.at(robot), *into, piece.key, update, false);
  }
  return complete;
}

bool ChunkStore::take(const std::string& robot, const perception::SubmapPoses& poses) {
  bool complete = true;
  for (const perception::SubmapPose& pose : poses.poses) {
    Submap* into = submap(robot, pose.key);
    if (into == nullptr) {
      ++refused_;
      complete = false;
    } else if (!into->T_map_submap || pose.revision > into->pose_revision || into->pose_carried) {
      put(robots_.at(robot), *into, pose, false);
    }
  }
  return complete;
}

std::vector<const perception::SubmapKey*> by_age(const ChunkStore::RobotMap& robot) {
  std::vector<std::pair<std::uint64_t, const perception::SubmapKey*>> ordered;
  for (const auto& [key, submap] : robot.submaps) {
    const auto heard = robot.owners.find(perception::owner_of(key.start));
    ordered.emplace_back(heard != robot.owners.end() ? heard->second : 0, &key);
  }
  std::ranges::stable_sort(ordered, {}, &std::pair<std::uint64_t, const perception::SubmapKey*>::first);
  std::vector<const perception::SubmapKey*> out;
  for (const auto& [heard, key] : ordered) out.push_back(key);
  return out;
}

}  // namespace adit::station
