// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "robot_agent/behaviour/mode_module.hpp"

namespace adit::agent {

/// The mode `manual`: the holder's stick is the velocity.
class ManualMode : public ModeModule {
 public:
  explicit ManualMode(const ModeContext& context) : output_(context.output) {}
  static std::unique_ptr<ModeModule> make(const ModeContext& context) {
    return std::make_unique<ManualMode>(context);
  }

  void tick(bool, Time) override {}  // Every sample passes at once, and none is repeated.
  void steer(const Twist2& twist, Time now) override { output_.write(Velocity{twist}, now); }

 private:
  Mux::Output output_;
};

/// The mode `smart_joystick`: the stick gives the direction, and the local planner finds a path.
class SmartJoystickMode : public ModeModule {
 public:
  explicit SmartJoystickMode(const ModeContext& context) : output_(context.output) {}
  static std::unique_ptr<ModeModule> make(const ModeContext& context) {
    return std::make_unique<SmartJoystickMode>(context);
  }

  void tick(bool, Time) override {}
  void steer(const Twist2& twist, Time now) override { output_.write(Guidance{twist}, now); }

 private:
  Mux::Output output_;
};

}  // namespace adit::agent
