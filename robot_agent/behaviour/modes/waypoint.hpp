// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <optional>

#include "robot_agent/behaviour/mode_module.hpp"

namespace adit::agent {

/// The mode `waypoint`: navigation drives to the goal and stops there.
class WaypointMode : public ModeModule {
 public:
  explicit WaypointMode(ModeContext context) : context_(std::move(context)) {}
  static std::unique_ptr<ModeModule> make(const ModeContext& context) {
    return std::make_unique<WaypointMode>(context);
  }

  void note(Facts& facts, Time now) const override;
  void enter(Time now) override;
  void leave(Time now) override;
  void clear() override;
  void tick(bool passes, Time now) override;
  Result<void> check_goal(const Eigen::Vector3d& goal, Facts& facts) const override;
  void set_goal(const Eigen::Vector3d& goal) override;
  void limit_unknown(double metres) override;
  void navigated(const Progress& progress) override { navigated_ = progress; }
  ModeProgress progress(bool passes) const override;
  void store(StoredBehaviour& stored) const override;
  void restore(const StoredBehaviour& stored) override;

 private:
  void watch(GoalState state);
  /// Counts the metres towards a goal that was not seen.
  void count(bool passes);
  /// Returns the reason why the goal cannot be reached.
  Reason unreachable_because() const {
    return navigated_.refusal == Reason::none ? Reason::goal_unreachable : navigated_.refusal;
  }
  Reason why_blocked() const;

  struct Goal {
    bool known{};
    bool reached{};
    std::uint32_t id{};
    Eigen::Vector3d place{Eigen::Vector3d::Zero()};
    bool on_floor{};  ///< The goal has no z of its own.
  };

  ModeContext context_;
  Goal goal_{};
  Progress navigated_{};
  bool unreachable_reported_{};
  Reason reported_{Reason::none};  ///< Why the robot makes no progress, as its holder was notified last.
  double budget_{std::numeric_limits<double>::infinity()};  ///< Metres while the goal is unseen.
  double driven_{};                        ///< Metres of the budget since it was given or renewed.
  std::optional<Eigen::Vector2d> last_{};  ///< Where metres were counted last, map frame, m.
  bool used_up_{};                         ///< The mode waits until it is requested again.
};

}  // namespace adit::agent
