// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/scan_points.hpp"
#include "nav/explore/coverage_map.hpp"
#include "nav/explore/frontiers.hpp"
#include "nav/explore/route_ground.hpp"

namespace adit::nav {

/// Progress of an exploration.
enum class ExploreState : std::uint8_t {
  starting,      ///< No plan was made yet.
  exploring,     ///< On the way to `goal`.
  no_viewpoint,  ///< There was never a place from which something unseen could be seen.
  done,          ///< Everything that can be reached was seen.
};

/// Present goal and progress of an exploration.
struct ExploreStep {
  ExploreState state{ExploreState::starting};
  std::optional<Eigen::Vector3d> goal{};  ///< Where to drive, on the ground, m. It may change before arrival.
  std::size_t frontiers{0};               ///< Those that a route leads to.
  std::size_t unreachable{0};             ///< Those that no known route leads to.
  double volume{0};                       ///< Volume that was seen, m3.
  double open{0};     ///< Volume that is expected behind the frontiers that a route leads to, m3.
  double dropped{0};  ///< Volume behind frontiers that were left out, m3.
};

/// Explores by driving to the frontier whose nearest viewpoint costs least: the route to it from where the
/// robot could be at rest. Goes on as soon as that frontier was seen. The goal is a place beside
/// the frontier, beyond most viewpoints, so that the robot does not brake at each of them. Has no thread and
/// no clock: the same scans and steps give the same goals. Frame: that of the poses, z up, m.
class Explorer {
 public:
  explicit Explorer(const Platform& platform);

  /// Takes a scan. `body`: base_link, on the ground. Without an exploration, one a metre of the way is
  /// kept, which shows about as much: an exploration that begins after a drive knows what the drive has
  /// shown.
  void add_scan(const ScanPoints& scan, const Pose3& body);
  /// Begins an exploration: what was seen stays seen, and places that were blocked may be tried again.
  void begin();
  /// To be called after scans, about once a second and when a goal is blocked. `place`: the robot on the
  /// ground; `stamp_s`: s, not decreasing; `blocked`: no way to the goal of the last step was found.
  ExploreStep step(RouteGround& ground, const Eigen::Vector3d& place, double stamp_s, bool blocked);
  const CoverageMap& coverage() const { return map_; }
  /// Forgets everything, as after a jump of the poses.
  void clear();

 private:
  struct Goal {
    Eigen::Vector3d place;
    Frontier frontier;
    bool shows;  ///< As in Viewpoint.
    bool arrived{false};
  };
  /// A place that was found blocked: it is no goal until a time that doubles with each block.
  struct Deferred {
    Eigen::Vector3d place;
    double until, pause;
  };
  struct Viewpoint {
    Eigen::Vector3d place;
    std::size_t frontier;
    bool beside;  ///< The one nearest to its frontier, to drive to; others are only driven past.
    bool shows;   ///< It shows the frontier; else no known place does, and this is the nearest one.
  };

  /// Whether a scan from here shows enough to be kept without an exploration.
  bool worth_keeping(const Pose3& body) const;
  bool in_view(const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& target) const;
  bool satisfied(const Goal& goal) const;
  void defer(const Eigen::Vector3d& place, double stamp_s);
  bool is_deferred(const Eigen::Vector3d& place, double stamp_s) const;
  void give_up_unseen(const Goal& goal);
  bool shows(const Eigen::Vector3d& viewpoint, const Frontier& frontier) const;
  std::vector<Eigen::Vector3d> places_around(RouteGround& ground, const Frontier& frontier,
                                             const Eigen::Vector3d& place, double stamp_s) const;
  std::vector<Viewpoint> viewpoints(RouteGround& ground, const Frontiers& frontiers,
                                    const Eigen::Vector3d& place, double stamp_s) const;
  /// The place where the robot can be at rest at the earliest, if it is free; else the robot's own.
  Eigen::Vector3d stopping_place(RouteGround& ground, const Eigen::Vector3d& place, double stamp_s);
  /// Ends the goal if the robot arrived and looked, or is blocked.
  void end_goal(const Eigen::Vector3d& place, double stamp_s, bool blocked);
  /// Whether a frontier is about where that of the goal is.
  bool continues(const Frontier& frontier) const;
  /// Drops the small frontiers if all of them together are not worth a way.
  void leave_small(std::vector<Frontier>& frontiers) const;
  /// Chooses the goal. Returns which frontiers can be reached.
  std::vector<bool> choose(RouteGround& ground, const Frontiers& frontiers, const Eigen::Vector3d& place,
                           double stamp_s);

  Eigen::Vector3d sensor_;  ///< The lidar in base_link, m.
  double steepest_;         ///< Tangent of the highest elevation that the lidar sees.
  double lowest_;           ///< Tangent of the lowest one.
  double braking_;          ///< m/s2
  CoverageMap map_{};
  std::optional<Goal> goal_{};
  std::vector<Deferred> deferred_{};
  std::optional<Pose3> kept_{};  ///< Where the newest scan that the map has was taken.
  int skipped_{0};               ///< Scans since then.
  int idle_{0};                  ///< Scans since the last step; counts up to kIdle.
  int scans_{0};                 ///< Since the robot arrived at the goal, or since nothing was left.
  bool ever_{false};             ///< A plan had a goal.
  std::optional<double> nothing_since_{};
  std::optional<Eigen::Vector3d> before_{};  ///< The robot's place at the last step.
  double before_s_{0};
};

}  // namespace adit::nav
