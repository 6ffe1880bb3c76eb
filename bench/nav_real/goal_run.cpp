// SPDX-License-Identifier: Apache-2.0
#include "bench/nav_real/goal_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "sim/rehearsal/scenario_file.hpp"

namespace adit::bench {
namespace {

/// The planners' tolerance, and the 2 cm that a scan's noise is, m.
constexpr double kArrived = 0.27;
constexpr Duration kSent = 4s;     // When the goto is typed
constexpr Duration kStands = 1s;   // at the goal before a run ends
constexpr Duration kSettles = 3s;  // after a report
constexpr double kStill = 0.02;    // m/s and rad/s

/// Notifications that end a goal; others, as of a blocked path, do not.
bool ends_goal(const std::string& code) {
  static const std::set<std::string> codes{"unreachable",     "unknown_budget",    "stuck",
                                           "goal_occupied",   "goal_no_floor",     "goal_too_steep",
                                           "goal_too_narrow", "goal_not_connected"};
  return codes.contains(code);
}

/// Watches a run, and says when it is over.
class Watch {
 public:
  Watch(const GoalRun& run, GoalResult& result) : run_(run), result_(result) {}

  bool over(const sim::RunState& state) {
    const sim::Truth& truth = state.simulation.truth(0);
    const bool stands =
        std::hypot(truth.twist.vx, truth.twist.vy) < kStill && std::abs(truth.twist.wz) < kStill;
    // The robot has nothing but its odometry to know where it is.
    const Eigen::Vector2d believed = (run_.start * state.simulation.odometry(0).pose()).position();
    const double off = (believed - run_.goal).norm();
    if (state.now < kSent) return false;
    if (!run_.impossible && stands && off < kArrived) {
      result_.off = (truth.pose.position.head<2>() - run_.goal).norm();
      if (!there_) there_ = state.now;
      if (state.now - *there_ >= kStands) {
        result_.arrived = true;
        result_.seconds = seconds(*there_ - kSent);
        return true;
      }
    } else {
      there_.reset();
    }
    if (!reported_) look_for_report(state);
    // A report without a stop is none: the robot may go on for a while, and then this is over at the limit.
    if (reported_ && stands && state.now - *reported_ >= kSettles) {
      result_.ends = true;
      return true;
    }
    return false;
  }

 private:
  void look_for_report(const sim::RunState& state) {
    const sim::CommandResult& commands = state.witness.commands();
    if (commands.refused > 0) {
      result_.refused = true;
      for (const auto& [reason, count] : commands.reasons) result_.reason = reason;
      reported_ = state.now;
    }
    for (const sim::TimedEvent& report : state.witness.notifications())
      if (!reported_ && report.at >= kSent && ends_goal(report.text)) {
        result_.reason = report.text;
        reported_ = report.at;
      }
    if (reported_) result_.seconds = seconds(*reported_ - kSent);
  }

  const GoalRun& run_;
  GoalResult& result_;
  std::optional<Duration> there_{}, reported_{};
};

}  // namespace

std::string scenario_text(const GoalRun& run) {
  return fmt::format(
      "world: {{map: {}}}\nduration: {:.0f}\nlink: mesh_500k\nlidar: full\n"
      "robots:\n  - {{id: r1, platform: {}, pose: [{:.3f}, {:.3f}, {:.4f}]}}\n"
      "basestations:\n  - {{id: op1, pose: [{:.1f}, {:.1f}]}}\n"
      "script:\n  - {{at: 3, by: op1, do: take r1}}\n  - {{at: 4, by: op1, do: goto r1 {:.2f} {:.2f}{}{}}}\n",
      run.map, std::ceil(seconds(kSent) + run.limit), run.platform, run.start.x, run.start.y, run.start.yaw,
      run.start.x, run.start.y, run.goal.x(), run.goal.y(), run.options.empty() ? "" : " ", run.options);
}

GoalResult drive(const GoalRun& run, std::shared_ptr<const sim::World> world,
                 const sim::AgentFactory& agents) {
  GoalResult result;
  const auto scenario = sim::parse_scenario(scenario_text(run), "nav_real.yaml");
  if (!scenario) return result.error = scenario.error().text, result;
  Watch watch(run, result);
  sim::RunParams params{};
  params.seed = run.seed;
  params.workers = 1;
  params.make_agent = agents;
  params.ended = [&watch](const sim::RunState& state) { return watch.over(state); };
  auto done = sim::rehearse(*scenario, std::move(world), params);
  if (!done) return result.error = done.error().text, result;
  const sim::RobotResult& robot = done->report.robots.at("r1");
  if (!result.arrived && result.reason.empty()) result.seconds = done->report.virtual_s - seconds(kSent);
  result.metres = robot.distance;
  result.clearance = robot.min_clearance;
  result.contacts = robot.collisions;
  result.trail = std::move(done->trails.at("r1").poses);
  return result;
}

}  // namespace adit::bench
