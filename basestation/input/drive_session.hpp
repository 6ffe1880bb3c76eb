// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>

#include "basestation/input/gamepad.hpp"
#include "basestation/model/robot.hpp"
#include "basestation/model/stick_velocity.hpp"

namespace adit::station::input {

/// The state of the operator's hands. Axes: forward, left, turn left; shares of the robot's limits, [-1, 1].
struct Hands {
  bool touching{};  ///< A finger is on the stick of the screen: its own dead man's switch.
  std::array<double, 3> touched{};
  std::array<double, 3> keys{};  ///< Zero when no key is down.
  Gamepad::State pad{};
};

/// The state of the driven robot and of the window.
struct DriveView {
  const Robot* robot{};  ///< Null: it is not known any more.
  double silent{};       ///< Time since the station's last snapshot, s.
  double since_beat{};   ///< Time since the window's own thread gave a sign of life, s.
  bool focused{true};    ///< The window has the keyboard.
};

/// Drives one robot by hand. It is bound to that robot: what is selected does not matter. The velocity is
/// zero whenever something is not as it should be, and what cannot become right again ends it.
class DriveSession {
 public:
  static constexpr double kPeriod = 0.05;       ///< Between two samples, s.
  static constexpr double kFrozen = 0.25;       ///< A window without a sign of life for longer lets go, s.
  static constexpr double kOldState = 0.6;      ///< The robot refuses sticks that answer an older state, s.
  static constexpr double kEnterLimit = 5.0;    ///< The robot must be in a mode by hand after that, s.
  static constexpr double kJump = 0.2;          ///< A larger change is sent at once; share of the limit.
  static constexpr double kUnknownLimit = 0.5;  ///< Until the robot describes itself, m/s and rad/s.

  /// `now`: any steady time, s.
  DriveSession(std::string robot, double now) : robot_(std::move(robot)), begun_(now) {}
  const std::string& robot() const { return robot_; }

  struct Step {
    StickVelocity velocity{};
    bool send{};        ///< It is time to send it.
    bool ends{};        ///< Nothing more is to be sent: `why` says why.
    std::string why{};  ///< Why the velocity is zero, or that no hand drives; empty: the hands' velocity.
  };
  Step step(const Hands& hands, const DriveView& view, double now);

 private:
  std::string robot_;
  double begun_;
  bool entered_{false}, had_pad_{false};
  bool rest_first_{false};  ///< It was halted: the hands must let go before they drive again.
  double sent_at_{-1.0};
  StickVelocity sent_{};
};

}  // namespace adit::station::input
