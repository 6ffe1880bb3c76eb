// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "core/component/call.hpp"
#include "core/component/component.hpp"
#include "core/geometry/scan_points.hpp"
#include "core/geometry/staircase.hpp"
#include "nav/local_navigation.hpp"
#include "nav/recovery/recovery.hpp"
#include "robot_agent/motion/map_watch.hpp"

namespace adit::agent {

/// A scan: points in the frame of base_link, m, and the poses of base_link at their instant, odometry frame.
struct Scan {
  PointCloud points{};
  Pose3 body{};  ///< By the pose that controls the body: what follows or avoids uses it.
  /// Where the robot's own odometry saw it, or `body` without one: what lasts, as maps, uses it. See
  /// PoseCorrection.
  Pose3 located{};
  std::uint32_t jumps{};  ///< How often `located` jumped before.
  bool planar{false};     ///< See perception::Scan::planar.
  /// One for each point, not 0: without a neighbour, as dust, see perception::Scan. Empty: none.
  std::vector<std::uint8_t> isolated{};
  std::vector<ScanPart> parts{};  ///< Of the points, by lidar. Empty: the first one measured all.

  /// What moves: x, y and radius of discs in the frame of `body`, m.
  std::vector<Eigen::Vector3f> movers{};

  ScanPoints measured() const { return {points, parts}; }
  /// One for each point, not 0: it is dust, or on what moves, and no part of a map. Empty: none is.
  std::vector<std::uint8_t> passing() const;
  /// The others, base_link, m.
  PointCloud lasting() const;
};

/// The input of one planning cycle.
struct PlanJob {
  std::shared_ptr<Scan> scan{};
  nav::RecoveryState state{};  ///< Of the recovery, for the caller.
  nav::Target target{};        ///< Kind none: the scan enters the map, and nothing is planned.
  Pose2 pose{};                ///< Odometry frame.
  /// Points along the border of forbidden ground, odometry frame, m.
  std::vector<Eigen::Vector2f> border{};
  std::vector<Eigen::Vector3f> peers{};  ///< Centres and radii of the other robots, odometry frame, m.
  std::vector<Staircase> stairs{};       ///< Those that the robot knows, odometry frame.
  std::uint32_t odom_epoch{};            ///< Epoch of that frame; maps of another epoch are discarded.
  std::uint64_t generation{};            ///< Generation of the goal to which `target` leads, for the caller.
  Time made{};
};
/// The result of one planning cycle.
struct PlanAnswer {
  nav::Plan plan{};
  std::shared_ptr<const nav::LocalMap> map{};  ///< With the scan of the job.
};
using PlanService = Service<std::shared_ptr<const PlanJob>, std::shared_ptr<const PlanAnswer>>;

struct PlannerParams {
  Platform platform{};
  Duration planning{20ms};  ///< Duration of a cycle in rehearsal.
  /// Makes the local planner; empty: the platform's.
  nav::PlannerFactory local_planner{};
  MapWatch watch{};
};

/// The component of terrain map and local planner, on a strand of its own, offered as a service. After a
/// restart its map is empty; the next scans fill it.
class Planner : public Component {
 public:
  /// `library`: from the previous planner, so that it need not be computed again; null: it is computed here.
  Planner(PlannerParams params, Executor& strand, Log log, PlanService& service,
          std::shared_ptr<const nav::PlannerLibrary> library = nullptr);

 protected:
  Result<void> on_start() override;

 private:
  void plan(const std::shared_ptr<const PlanJob>& job, const Reply<std::shared_ptr<const PlanAnswer>>& reply);

  PlannerParams params_;
  PlanService& service_;
  struct Maps;
  std::shared_ptr<Maps> maps_;
};

}  // namespace adit::agent
