#pragma once
#include <optional>

#include "robot_agent/behaviour/mode_module.hpp"

namespace adit::agent {

/// The mode `external`: a program on the robot domain steers, one that speaks only ROS 2 types. What it
/// writes to /external/cmd_vel passes within the platform's limits and behind the collision monitor, as every
/// source does.
class ExternalMode : public ModeModule {
 public:
  static constexpr Duration kFresh{500ms};  ///< rule 6: a planner

  explicit ExternalMode(const ModeContext& context) : output_(context.output) {}
  static std::unique_ptr<ModeModule> make(const ModeContext& context) {
    return std::make_unique<ExternalMode>(context);
  }

  void note(Facts& facts, Time now) const override { facts.program_fresh = fresh(now); }
  void tick(bool, Time) override {}
  /// A velocity that is not finite counts as silence.
  void program(const Twist2& velocity, Time now) override;
  bool fresh(Time now) const { return last_ && now - *last_ <= kFresh; }

 private:
  Mux::Output output_;
  std::optional<Time> last_{};
};

}  // namespace adit::agent
