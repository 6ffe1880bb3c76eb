// SPDX-License-Identifier: Apache-2.0
// What is stored of maps, and how: by the robot itself, or by one that carried it here.
#include <algorithm>

#include "basestation/map/chunk_store.hpp"

namespace adit::station {
namespace {

constexpr Duration kTick = 100ms;
constexpr Duration kHeardNow = 10s;  // A carrier sends nothing of a robot that was heard more recently.

constexpr std::uint32_t kCoarse = perception::BlockUpdate::kCoarseRevision;

bool is_heard(const ChunkStore::RobotMap& robot, std::optional<Time> now) {
  return robot.heard && now && *now - *robot.heard < kHeardNow;
}

}  // namespace

std::uint32_t ChunkStore::clock(Time now) const {
  if (!begun_) return 0;
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>((now - *begun_) / kTick, 0, 1LL << 30)) + 1;
}

void ChunkStore::set_now(std::optional<Time> now) {
  if (now && !begun_) begun_ = now;
  now_ = now ? clock(*now) : 0;
}

void ChunkStore::put(RobotMap& robot, Submap& submap, const perception::SubmapKey& key,
                     const perception::BlockUpdate& update, bool carried) {
  const auto [found, added] = submap.blocks.try_emplace(update.block.index);
  Block& block = found->second;
  if (added) {
    ++blocks_;
    ++robot.blocks;
  } else {
    robot.digest.remove(key, {update.block.index, block.known, block.occupied});
    robot.carried_blocks -= block.carried;
    carried_blocks_ -= block.carried;
  }
  const std::uint32_t revision = update.stored_revision();
  // What the robot itself sends replaces what was carried, and all that is known comes again.
  const bool adds =
      !added && block.revision == kCoarse && revision == kCoarse && (carried || block.carried == 0);
  const perception::CoarseBlock shown =
      adds ? merged({update.block.index, block.known, block.occupied}, update.block) : update.block;
  block = {shown.known, shown.occupied, revision, now_, carried ? 1U : 0U};
  robot.carried_blocks += block.carried;
  carried_blocks_ += block.carried;
  robot.digest.add(key, shown);
  ++revision_;
}

void ChunkStore::put(RobotMap& robot, Submap& submap, const perception::SubmapPose& pose, bool carried) {
  if (submap.T_map_submap) robot.digest.remove(pose.key, submap.pose_revision);
  submap.T_map_submap = pose.T_map_submap;
  submap.pose_revision = pose.revision;
  submap.pose_carried = carried;
  robot.digest.add(pose.key, pose.revision);
  ++revision_;
}

void ChunkStore::note_waiting(const std::string& robot, std::uint32_t waiting) {
  if (const auto found = robots_.find(robot); found != robots_.end()) found->second.waiting = waiting;
}

ChunkStore::RobotMap* ChunkStore::count_carried(const std::string& carrier, const std::string& robot,
                                                std::size_t bytes, std::optional<Time> now) {
  if (!robots_.contains(robot)) {
    const auto carried_only = std::count_if(robots_.begin(), robots_.end(),
                                            [](const auto& entry) { return entry.second.pieces == 0; });
    if (robots_.size() >= params_.max_robots ||
        static_cast<std::size_t>(carried_only) >= params_.max_carried_robots)
      return nullptr;
  }
  RobotMap& from = robots_[robot];
  if (!from.carriers.contains(carrier) && from.carriers.size() >= params_.max_carriers)
    from.carriers.erase(
        std::min_element(from.carriers.begin(), from.carriers.end(),
                         [](const auto& a, const auto& b) { return a.second.last < b.second.last; }));
  Carried& count = from.carriers[carrier];
  count.bytes += bytes;
  ++count.pieces;
  count.heard = now;
  count.last = ++carried_pieces_;
  set_now(now);
  return &from;
}

bool ChunkStore::note_carried(RobotMap* robot, const std::string& carrier, std::size_t newer,
                              std::size_t refused) {
  if (robot != nullptr) robot->carriers.at(carrier).parts += newer;
  refused_carried_ += refused;
  return refused == 0;
}

bool ChunkStore::take_carried(const std::string& carrier, perception::MapPiece& piece, std::size_t bytes,
                              std::optional<Time> now) {
  RobotMap* robot = count_carried(carrier, piece.key.robot, bytes, now);
  Submap* into = robot != nullptr ? submap(piece.key.robot, piece.key) : nullptr;
  std::size_t refused = into != nullptr ? 0 : piece.blocks.size();
  std::erase_if(piece.blocks, [&](const perception::BlockUpdate& update) {
    if (into == nullptr) return true;
    const auto known = into->blocks.find(update.block.index);
    const bool is_new = known == into->blocks.end();
    const bool replaces_carried = !is_new && known->second.carried != 0;
    if (!is_new && !is_newer(known->second.known, known->second.occupied, known->second.revision, update))
      return true;
    if (!is_new && !replaces_carried && is_heard(*robot, now)) return true;
    if ((is_new && blocks_ >= params_.max_blocks) ||
        (!replaces_carried && carried_blocks_ >= params_.max_carried_blocks)) {
      ++refused;
      return true;
    }
    put(*robot, *into, piece.key, update, true);
    return false;
  });
  return note_carried(robot, carrier, piece.blocks.size(), refused);
}

bool ChunkStore::take_carried(const std::string& carrier, perception::SubmapPoses& poses, std::size_t bytes,
                              std::optional<Time> now) {
  const std::string name = poses.poses.front().key.robot;
  RobotMap* robot = count_carried(carrier, name, bytes, now);
  std::size_t refused = 0;
  std::erase_if(poses.poses, [&](const perception::SubmapPose& pose) {
    Submap* into = robot != nullptr ? submap(name, pose.key) : nullptr;
    refused += into == nullptr ? 1 : 0;
    if (into == nullptr || (into->T_map_submap && (pose.revision <= into->pose_revision ||
                                                   (!into->pose_carried && is_heard(*robot, now)))))
      return true;
    put(*robot, *into, pose, true);
    return false;
  });
  return note_carried(robot, carrier, poses.poses.size(), refused);
}

}  // namespace adit::station
