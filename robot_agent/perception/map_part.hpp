// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "core/component/call.hpp"
#include "core/component/component.hpp"
#include "perception/map/submap_grid.hpp"
#include "robot_agent/motion/planner.hpp"
#include "robot_agent/motion/team_robot.hpp"

namespace adit::agent {

/// A scan for the map.
struct MapJob {
  std::shared_ptr<const Scan> scan{};
  Eigen::Vector3d origin{0, 0, 0};  ///< Of the rays of a scan without parts, base_link, m.
  std::vector<TeamRobot> team{};    ///< Robots in view, which are no part of the map.
  std::uint32_t odom_epoch{};       ///< Of the scan's odometry frame.
  std::uint32_t next_submap{};      ///< Index of a submap that is opened now.
  /// What the caller has: the open submap, and the revision up to which it has its blocks.
  std::optional<std::uint32_t> known_submap{};
  std::uint32_t known_revision{};
  Time made{};
};

/// The changes of the map by one scan.
struct MapStep {
  std::uint32_t submap{};  ///< The open one.
  /// Level, at a multiple of a block's edge on each axis; fixed since the submap was opened.
  Pose3 T_odom_submap{};
  std::uint32_t odom_epoch{};
  std::uint32_t revision{};
  std::vector<perception::CoarseBlock> blocks{};  ///< Changed since MapJob::known_revision.
};

/// The service of the map component.
using MapService = Service<std::shared_ptr<const MapJob>, MapStep>;

struct MapParams {
  double range{20.0};             ///< Farther points only free space up to this range, m.
  double submap_length{15.0};     ///< Way in one submap, m, (0, 100].
  double submap_height{1.5};      ///< Change of height in one submap, m.
  Duration submap_time{30s};      ///< With motion beyond `submap_min_length`.
  double submap_min_length{8.0};  ///< m
  Duration modelled{4ms};         ///< Duration of an insertion in rehearsal.
};

/// The component that inserts scans into the open submap of the robot's map, on a strand of its own. A submap
/// is anchored in the odometry frame where it began, and rigid: drift within it is smaller than a voxel.
/// After a restart of the component a new submap begins; the blocks of earlier ones belong to MapKeeper.
class MapPart : public Component {
 public:
  MapPart(MapParams params, Executor& strand, Log log, MapService& service);

 protected:
  Result<void> on_start() override;

 private:
  /// The open submap.
  struct Open {
    std::uint32_t index{};
    Pose3 T_odom_submap{};
    std::uint32_t odom_epoch{};
    std::uint32_t jumps{};  ///< Scan::jumps of all its scans: a pose that jumped would shear it.
    Time began{};
    Eigen::Vector3d last{0, 0, 0};  ///< Position of the body at the last scan, odometry frame.
    double height{};                ///< Of the body when it began, odometry frame, m.
    double length{};                ///< Way since it began, m.
    std::shared_ptr<perception::SubmapGrid> grid{};
  };
  void insert(const std::shared_ptr<const MapJob>& job, const Reply<MapStep>& reply);
  /// Whether the next scan belongs into another submap.
  bool is_full(const MapJob& job) const;

  MapParams params_;
  MapService& service_;
  std::optional<Open> open_{};
};

}  // namespace adit::agent
