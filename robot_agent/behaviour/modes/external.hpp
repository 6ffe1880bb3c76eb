// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <optional>

#include "robot_agent/behaviour/mode_module.hpp"

namespace adit::agent {

/// The mode `external`: a program on the robot domain, which uses only ROS 2 types, steers the robot. Its
/// velocities on /external/cmd_vel pass the platform's limits and the collision monitor, as those of every
/// source.
class ExternalMode : public ModeModule {
 public:
  static constexpr Duration kFresh{500ms};  ///< Rule 6, as for a planner.

  explicit ExternalMode(const ModeContext& context) : output_(context.output) {}
  static std::unique_ptr<ModeModule> make(const ModeContext& context) {
    return std::make_unique<ExternalMode>(context);
  }

  void note(Facts& facts, Time now) const override { facts.program_fresh = fresh(now); }
  void tick(bool, Time) override {}
  /// Receives a velocity; one that is not finite is ignored.
  void steer(const Twist2& velocity, Time now) override {
    if (!std::isfinite(velocity.vx) || !std::isfinite(velocity.vy) || !std::isfinite(velocity.wz)) return;
    last_ = now;
    output_.write(Velocity{velocity, true}, now);
  }
  bool fresh(Time now) const { return last_ && now - *last_ <= kFresh; }

 private:
  Mux::Output output_;
  std::optional<Time> last_{};
};

}  // namespace adit::agent
