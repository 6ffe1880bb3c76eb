// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/perception/map_part.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace adit::agent {
namespace {

/// Inserts a scan into a grid and collects what the caller does not have yet. Work of a compute thread.
MapStep inserted(const MapJob& job, MapStep step, perception::SubmapGrid& grid, double range) {
  const auto scan = without_team(job.scan, job.team);
  const Pose3 T_submap_base = step.T_odom_submap.inverse() * scan->located;
  const Eigen::Affine3f T =
      (Eigen::Translation3d(T_submap_base.position) * T_submap_base.orientation).cast<float>();
  std::vector<Eigen::Vector3f> points;
  points.reserve(scan->points.size());
  for (const Eigen::Vector3f& point : scan->points) points.push_back(T * point);
  // A new submap is unknown everywhere: one return of dust would be an obstacle in it at once.
  const std::vector<std::uint8_t> passing = scan->passing();
  std::span<const std::uint8_t> rest(passing);
  ScanPoints(points, scan->parts)
      .each_part(job.origin, [&](std::span<const Eigen::Vector3f> part, const Eigen::Vector3d& origin) {
        const auto passes = rest.first(std::min(part.size(), rest.size()));
        rest = rest.subspan(passes.size());
        grid.insert(T * origin.cast<float>(), part, static_cast<float>(range), passes);
      });
  const std::uint32_t since = job.known_submap == step.submap ? job.known_revision : 0;
  for (const perception::BlockIndex& index : grid.changed_since(since))
    if (const auto block = grid.coarse(index)) step.blocks.push_back(*block);
  step.revision = grid.revision();
  return step;
}

/// The corner of a block next to a position: the blocks of all submaps of an odometry frame lie in one
/// lattice.
Eigen::Vector3d anchor(const Eigen::Vector3d& position) {
  constexpr double kSize = perception::BlockIndex::kSize;
  return (position / kSize).array().round() * kSize;
}

}  // namespace

MapPart::MapPart(MapParams params, Executor& strand, Log log, MapService& service)
    : Component("map", strand, std::move(log), {.beat = 100ms}), params_(params), service_(service) {}

Result<void> MapPart::on_start() {
  offer(service_, [this](const auto& job, const auto& reply) { insert(job, reply); });
  return {};
}

bool MapPart::is_full(const MapJob& job) const {
  if (!open_ || open_->odom_epoch != job.odom_epoch || open_->jumps != job.scan->jumps) return true;
  const double length = open_->length + (job.scan->located.position - open_->last).norm();
  const double height = std::abs(job.scan->located.position.z() - open_->height);
  return length > params_.submap_length || height > params_.submap_height ||
         (job.made - open_->began > params_.submap_time && length > params_.submap_min_length);
}

void MapPart::insert(const std::shared_ptr<const MapJob>& job, const Reply<MapStep>& reply) {
  if (is_full(*job))
    open_ = Open{.index = job->next_submap,
                 .T_odom_submap = {anchor(job->scan->located.position), Eigen::Quaterniond::Identity()},
                 .odom_epoch = job->odom_epoch,
                 .jumps = job->scan->jumps,
                 .began = job->made,
                 .last = job->scan->located.position,
                 .height = job->scan->located.position.z(),
                 .grid = std::make_shared<perception::SubmapGrid>()};
  open_->length += (job->scan->located.position - open_->last).norm();
  open_->last = job->scan->located.position;
  MapStep step{
      .submap = open_->index, .T_odom_submap = open_->T_odom_submap, .odom_epoch = open_->odom_epoch};
  compute(
      {.name = "map insertion", .modelled = params_.modelled, .lane = "map"},
      [job, step = std::move(step), grid = open_->grid, range = params_.range] {
        return inserted(*job, step, *grid, range);
      },
      [reply](Result<MapStep> done) { reply(std::move(done)); });
}

}  // namespace adit::agent
