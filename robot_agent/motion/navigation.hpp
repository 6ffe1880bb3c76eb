// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/component/component.hpp"
#include "nav/control/controller.hpp"
#include "nav/monitor/collision_monitor.hpp"
#include "nav/monitor/held_watch.hpp"
#include "nav/recovery/recovery.hpp"
#include "robot_agent/motion/fence.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/motion/motion.hpp"
#include "robot_agent/motion/planner.hpp"
#include "robot_agent/motion/router.hpp"

namespace adit::agent {

struct NavigationParams {
  Platform platform{};
  Duration period{50ms};        ///< Of step(), as the driver's period, [20 ms, 50 ms].
  Duration plan_age{500ms};     ///< An older plan is not followed.
  Duration step_age{2s};        ///< With an older step of the route, the robot waits for the next one.
  Duration scan_age{500ms};     ///< With older points the terrain is unknown.
  Duration passed_age{500ms};   ///< A robot heads for the place before its goal, see GoTo, for so long.
  Duration held_after{1500ms};  ///< A robot that its collision monitor stops for this long is blocked.
  Duration warned_for{2s};      ///< A warning is repeated if its cause was absent for longer.
  Duration detection{0};        ///< Duration of the detection of a scan's obstacles in rehearsal.
};

/// Why the operator of a manual mode is warned.
enum class Warning { obstacle_near, lidar_silent, tilted, outside_area };

/// Converts the motions that the mux passes into velocities within the platform's limits: directly, or along
/// the local planner's paths.
///
/// The planner plans once per scan on another strand, and this class follows the plan on its own. The router,
/// which also receives every scan, gives the steps of the route to a goal; the robot waits while there
/// is none. Where the platform has no router (`router` null) it heads for the goal directly. The collision
/// monitor limits each velocity: in autonomous modes and smart joystick it stops the robot, in manual mode it
/// slows the robot down and the operator is warned. The obstacles of a scan are detected by `compute`, one
/// scan at a time, and arrive as a value: this strand does no work in proportion to the points.
class Navigation : public Component, public NavigationInput {
 public:
  struct Outputs {
    std::function<void(const Twist2&)> velocity{};    ///< To the driver.
    std::function<void(const Progress&)> progress{};  ///< Of the goal requested last.
    std::function<void(Warning)> warn{};              ///< Called once while the warning lasts; may be empty.
  };

  Navigation(NavigationParams params, Executor& strand, Log log, const Frames& frames,
             const PlanService& planner, const RouteServices* router, Outputs outputs);

  /// Accepts a motion; velocities and zero are sent to the driver within the call.
  void accept(MuxKey, const Motion& motion, Time now) override;
  /// Sends the velocity for the next period; call it every period.
  void step(Time now);
  /// Limits the speed along the planner's paths, m/s; infinite: the platform's limit alone.
  void limit_speed(double limit) { speed_limit_ = limit; }
  /// Sets the areas, map frame, that bind autonomous modes. `sigma`: standard deviation of the robot's place
  /// in that frame, m.
  void set_areas(const nav::AreaSet& areas, double sigma = 0.0) {
    areas_ = areas;
    place_sigma_ = sigma;
  }
  /// The areas in the odometry frame, for the router.
  RouteAreas route_areas() const { return {fence_.all(), fence_.routable()}; }
  /// Sets the known staircases, odometry frame. The planners get those that are nearest to the robot and to
  /// its goal.
  void set_stairs(std::vector<Staircase> stairs) { stairs_ = std::move(stairs); }
  /// Whether the body is so far on forbidden ground that it does not come back by itself.
  bool is_far_out() const { return fence_.is_far_out(); }
  /// `team`: the other robots, for the route map.
  void add_scan(std::shared_ptr<Scan> scan, Time received, Time now, std::vector<TeamRobot> team = {});
  /// The step along the route to the goal, odometry frame; null: no route is followed.
  const nav::RouteStep* followed_route(Time now) const;
  /// Discards points and plans, because the odometry frame has changed. Until the next scan the terrain is
  /// not fresh.
  void clear();

  /// What moves, as discs that hold it now; see Scan::movers.
  std::vector<Eigen::Vector3f> movers(Time now) const;

  bool terrain_fresh(Time now) const { return scanned_ && now - *scanned_ < params_.scan_age; }
  /// Whether the router answered a scan that is not older than `step_age`.
  bool map_fresh(Time now) const { return mapped_ && now - *mapped_ < params_.step_age; }
  /// Whether the body at that place (map frame, m) would touch no known obstacle.
  bool goal_free(const Eigen::Vector2d& place) const;

 private:
  /// Distance from `pose` to the goal requested last, m; that goal moves with a correction of the map.
  double distance_to_goal(const Pose2& pose) const;
  /// Place where the robot comes to rest at the earliest if it brakes now, odometry frame, m.
  Pose2 resting_place() const;
  /// Whether `step_` leads to the goal requested last, or to the one before that it continues.
  bool is_current(std::uint64_t generation, Time now) const;
  nav::Target target() const;
  /// The next step of the route; null if there is none.
  const nav::RouteStep* step_on(Time now) const;
  void ask_route(const std::shared_ptr<const Scan>& scan, Time now, std::vector<TeamRobot> team);
  /// The local map if the map of the routes may take it in with a scan; else null.
  std::shared_ptr<const nav::LocalMap> near_map(const Scan& scan, Time now) const;
  void routed(const RouteJob& job, const Result<nav::RouteStep>& step);
  Twist2 along_plan(Time now);
  void watch_warning(nav::CollisionMonitor::Cause cause, Time now);
  void warn(Warning warning, Time now);
  /// Whether areas bind the present motion.
  bool is_bound() const;
  void update_fence(Time now);
  /// For a flying robot with a goal that has a height: how much higher that is, m.
  std::optional<double> height_left() const;
  /// The upward velocity to it, m/s.
  double climb() const;
  Twist2 limited(const Twist2& wanted) const;
  void send(const Twist2& velocity);
  void pass_on(const Velocity& wanted);
  nav::CollisionMonitor::Verdict guarded(const Twist2& wanted, nav::CollisionMonitor::Policy policy) const;
  /// Has the obstacles of a scan detected for the collision monitor.
  void detect(std::shared_ptr<const Scan> scan, Time now);
  void plan(std::shared_ptr<Scan> scan, Time now);
  void planned(const PlanJob& job, const Result<std::shared_ptr<const PlanAnswer>>& answer);
  void take(const PlanJob& job, const std::shared_ptr<const PlanAnswer>& answer);
  /// Follows a plan towards the goal, or what the recovery asks for instead, and reports.
  void go_on(const PlanJob& job, const nav::Plan& plan);
  void recover(const PlanJob& job, const nav::Plan& plan, bool held);
  void follow(const nav::Plan& plan, Time made);

  NavigationParams params_;
  const Frames& frames_;
  const PlanService& planner_;
  const RouteServices* router_;  // Null: there is none.
  Outputs outputs_;
  std::unique_ptr<nav::Controller> controller_;
  nav::CollisionMonitor monitor_;
  struct Detection;
  std::shared_ptr<Detection> detection_;  // Used by one job at a time.
  std::uint32_t scan_epoch_{};            // Rises when the scans before are discarded.
  nav::AreaSet areas_{};                  // Map frame.
  std::vector<Staircase> stairs_{};       // Odometry frame.
  double place_sigma_{};
  Fence fence_;

  Motion motion_{Stand{}};
  std::uint64_t goal_generation_{};  // Rises with every new goal, so that late plans report no progress.
  bool has_plan_{};
  Time plan_made_{};
  std::array<std::optional<Time>, 4> warned_{};  // Indexed by Warning: last time of its cause.
  nav::HeldWatch held_{};
  double speed_limit_{std::numeric_limits<double>::infinity()};
  double sent_speed_{0};  // Maximum speed of the robot according to the velocities sent, m/s.
  Time sent_at_{};
  bool planning_{};                       // A call to the planner is pending.
  std::shared_ptr<Scan> waiting_{};       // The newest scan that arrived while planning.
  bool routing_{};                        // A call to the router is pending.
  std::optional<nav::RouteStep> step_{};  // Of the goal of `step_generation_`.
  std::uint64_t step_generation_{};
  Time step_made_{};
  Time continued_{};  // When the goal that continues that one was requested.
  nav::Recovery recovery_{};
  nav::RouteAsk ask_{};                   // To be sent to the router with the next scan.
  std::vector<Eigen::Vector3f> peers_{};  // Centres and radii of the other robots, odometry frame, m.
  std::optional<Time> scanned_{};
  std::optional<Time> mapped_{};  // When the scan was received that the router answered last.
  std::shared_ptr<const nav::LocalMap> local_map_{};
};

}  // namespace adit::agent
