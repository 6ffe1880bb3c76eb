// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "basestation/flow/flow.hpp"

namespace adit::station {

struct SteerParams {
  enum class Purpose : std::uint8_t {
    enter,   ///< Requests a manual mode, then streams a centred stick while the robot is in it.
    drive,   ///< One velocity for a period.
    teleop,  ///< A live stick until cancelled.
  };
  Purpose purpose{Purpose::drive};
  std::string mode{"manual"};        ///< `manual` or `smart_joystick`.
  std::array<double, 3> velocity{};  ///< For `drive`; m/s, m/s, rad/s.
  Duration duration{std::chrono::seconds(1)};
};

/// The flow of all commands with a joystick: streams zero, requests the mode with the stick centred, streams
/// the value, then zero for 300 ms, then ends the stream. A robot in smart_joystick stays in it, with the
/// stick centred.
class Steer final : public Flow {
 public:
  Steer(FlowDependencies dependencies, std::string robot, SteerParams params, Done done);
  void start() override;
  void cancel(Reason reason, const std::string& text) override;
  void hand_over() override;
  void stream_refused(Reason reason, const std::string& text) override;
  bool over() const override { return phase_ == Phase::over; }
  /// Sets the stick's new position, for `teleop`.
  void set_velocity(const std::array<double, 3>& velocity);
  /// True while `enter` only keeps the stick centred; its end was reported.
  bool keeping() const { return phase_ == Phase::keeping; }

 private:
  enum class Phase : std::uint8_t { waiting, centring, asking, moving, settling, keeping, over };
  void enter_phase(Phase phase);
  void poll();
  void begin();
  void ask();
  void answered(const Answer& answer);
  void move();
  void end(Reason reason, const std::string& text);
  void settled();
  /// Describes the parts of the requested velocity that exceed the robot's limits; empty: none.
  std::string clipped() const;
  bool left_mode(Reason& reason, std::string& text);
  void stream(const std::array<double, 3>& velocity, Stick::Source source = Stick::Source::held);

  SteerParams params_;
  Phase phase_{Phase::waiting};
  Time phase_since_{};
  Time first_asked_{};
  Time stick_at_{};
  Timer timer_{};
  bool asked_{false};
  bool seen_in_mode_{false};
  bool keep_after_{false};
  std::uint64_t behaviour_before_{};
  Answer outcome_{};
};

}  // namespace adit::station
