#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/component/component.hpp"
#include "nav/control/controller.hpp"
#include "nav/monitor/collision_monitor.hpp"
#include "nav/monitor/held_watch.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/motion/motion.hpp"
#include "robot_agent/motion/planner.hpp"
#include "robot_agent/motion/router.hpp"

namespace adit::agent {

struct NavigationParams {
  Platform platform{};
  Duration period{50ms};        ///< of step(): the driver's rate, [20 ms, 50 ms]
  Duration plan_age{500ms};     ///< an older plan moves nothing
  Duration step_age{2s};        ///< after an older step of the route the goal itself is headed for
  Duration scan_age{500ms};     ///< older points: the terrain is not known
  Duration held_after{1500ms};  ///< a robot that its collision monitor keeps on the spot this long is blocked
  Duration warned_for{2s};      ///< a warning is told anew when its cause was away for longer
};

/// Why the operator of a manual mode is warned.
enum class Warning { obstacle_near, lidar_silent };

/// Turns what the mux passes into velocities within the platform's limits: as they are, or along the local
/// planner's paths. Has the planner plan once per scan, on another strand, and follows on its own. To a goal
/// it is led by the router, which sees every scan, too; while there is none (`router` null, or away) the goal
/// is headed for as it is. The collision monitor has the last word on each velocity: in autonomous modes and
/// smart joystick it stops the robot, in manual mode it slows it down and has the operator warned.
class Navigation : public Component, public NavigationInput {
 public:
  struct Outputs {
    std::function<void(const Twist2&)> velocity{};    ///< to the driver
    std::function<void(const Progress&)> progress{};  ///< of the goal asked for last
    std::function<void(Warning)> warn{};              ///< once, as long as it lasts; may be empty
  };

  Navigation(NavigationParams params, Executor& strand, Log log, const Frames& frames,
             const PlanService& planner, const RouteServices* router, Outputs outputs);

  /// Velocities and zero go to the driver within the call.
  void accept(MuxKey, const Motion& motion, Time now) override;
  /// The velocity for the next period, every period.
  void step(Time now);
  void add_scan(std::shared_ptr<Scan> scan, Time received, Time now);
  /// Forgets what was seen and planned in the odometry frame: it is another one now. Until the next scan the
  /// terrain is not fresh.
  void clear();

  bool terrain_fresh(Time now) const { return scanned_ && now - *scanned_ < params_.scan_age; }
  /// Whether the body would stand there without touching a known obstacle (map frame, m).
  bool goal_free(const Eigen::Vector2d& place) const;

 private:
  /// Whether `goal` (odometry frame, m) is still where the goal asked for last lies: a correction of the map
  /// moves it.
  bool is_goal(const Eigen::Vector2d& goal) const;
  nav::Target target() const;
  /// Where the route leads next; nothing while there is none.
  const nav::RouteStep* step_on(Time now) const;
  void ask_route(const std::shared_ptr<Scan>& scan, Time now);
  void routed(const RouteJob& job, const Result<nav::RouteStep>& step);
  Twist2 along_plan(Time now);
  void watch_warning(nav::CollisionMonitor::Cause cause, Time now);
  /// Of what flies to a goal with a height: the velocity upwards, m/s, and whether it is there.
  double climb() const;
  bool at_height() const;
  Twist2 limited(const Twist2& wanted) const;
  void send(const Twist2& velocity);
  void pass_on(const Velocity& wanted);
  nav::CollisionMonitor::Verdict guarded(const Twist2& wanted, nav::CollisionMonitor::Policy policy) const;
  void plan(std::shared_ptr<Scan> scan, Time now);
  void planned(const PlanJob& job, const Result<std::shared_ptr<const PlanAnswer>>& answer);
  void take(const PlanJob& job, const PlanAnswer& answer);

  NavigationParams params_;
  const Frames& frames_;
  const PlanService& planner_;
  const RouteServices* router_;  // null: there is none
  Outputs outputs_;
  std::unique_ptr<nav::Controller> controller_;
  nav::CollisionMonitor monitor_;

  Motion motion_{Stand{}};
  std::uint64_t goal_generation_{};  // rises with every other goal, so that late plans report no progress
  bool has_plan_{};
  Time plan_made_{};
  std::array<std::optional<Time>, 2> warned_{};  // by Warning: when its cause was there last
  nav::HeldWatch held_{};
  double sent_speed_{0};  // that it may have by the velocities it was told, m/s
  Time sent_at_{};
  bool planning_{};                       // a call to the planner is under way
  std::shared_ptr<Scan> waiting_{};       // the newest scan that came while planning
  bool routing_{};                        // and one to the router
  std::optional<nav::RouteStep> step_{};  // of the goal asked for last
  Eigen::Vector2d step_goal_{0, 0};       // where that goal was then, odometry frame
  Time step_made_{};
  bool blocked_{};  // the last plan towards the goal was
  std::optional<Time> scanned_{};
  std::shared_ptr<const std::vector<Eigen::Vector2f>> obstacles_{};  // odometry frame
};

}  // namespace adit::agent
