// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/map_keeper.hpp"

#include "core/time/random.hpp"

namespace adit::agent {
namespace {

constexpr Duration kMaxInsertion = 3s;

std::uint32_t drawn_session(std::uint64_t seed) {
  return static_cast<std::uint32_t>(Random(seed).fork(2).next()) | 1U;
}

}  // namespace

MapKeeper::MapKeeper(MapKeeperParams params)
    : params_(std::move(params)),
      poses_(params_.robot, Random(params_.seed).fork(1).next()),
      blocks_({.robot = params_.robot, .start = Random(params_.seed).fork(1).next()}),
      sender_({.session = drawn_session(params_.seed)}) {
  sender_.add(poses_);
  sender_.add(blocks_);
}

std::shared_ptr<const MapJob> MapKeeper::job(const std::shared_ptr<const Scan>& scan,
                                             std::vector<TeamRobot> team, std::uint32_t odom_epoch,
                                             Time now) {
  // The completion is lost when the command component ends meanwhile.
  if (busy_ && now - *inserted_ < kMaxInsertion) return nullptr;
  const bool moved = (scan->body.position - inserted_at_.position).norm() >= params_.min_move ||
                     scan->body.orientation.angularDistance(inserted_at_.orientation) >= params_.min_turn;
  if (inserted_ && inserted_epoch_ == odom_epoch && !moved && now - *inserted_ < params_.min_period)
    return nullptr;
  auto job = std::make_shared<MapJob>();
  job->scan = scan;
  job->origin = params_.origin;
  job->team = std::move(team);
  job->odom_epoch = odom_epoch;
  job->next_submap = static_cast<std::uint32_t>(submaps_.size());
  if (!submaps_.empty()) job->known_submap = job->next_submap - 1;
  job->known_revision = revision_;
  job->made = now;
  busy_ = true;
  inserted_ = now;
  inserted_at_ = scan->body;
  inserted_epoch_ = odom_epoch;
  return job;
}

void MapKeeper::taken(const Result<MapStep>& step, const MapFrame& frame) {
  busy_ = false;
  if (!step || step->submap > submaps_.size()) return;
  if (step->submap == submaps_.size()) {
    submaps_.push_back({step->T_odom_submap, step->odom_epoch});
    if (step->odom_epoch == frame.odom_epoch)
      poses_.update(step->submap, frame.T_map_odom * step->T_odom_submap);
    if (!frame_) frame_ = frame;
  }
  for (const perception::CoarseBlock& block : step->blocks) blocks_.update(step->submap, block);
  if (step->submap + 1 == submaps_.size()) revision_ = step->revision;
}

void MapKeeper::follow(const MapFrame& frame) {
  if (!frame_ || (frame_->map_epoch == frame.map_epoch && frame_->odom_epoch == frame.odom_epoch)) return;
  frame_ = frame;
  // Submaps of an earlier odometry frame stay where they were in the map.
  for (std::size_t i = 0; i < submaps_.size(); ++i)
    if (submaps_[i].odom_epoch == frame.odom_epoch)
      poses_.update(static_cast<std::uint32_t>(i), frame.T_map_odom * submaps_[i].T_odom_submap);
}

}  // namespace adit::agent
