// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "basestation/flow/flow.hpp"

namespace adit::station {

/// The purpose of a Steer flow, and its values.
struct SteerParams {
  enum class Purpose : std::uint8_t {
    enter,   ///< Requests a manual mode, then streams a centred stick while the robot is in it.
    drive,   ///< Streams one velocity for a period.
    teleop,  ///< Streams a live stick until cancelled.
  };
  Purpose purpose{Purpose::drive};
  std::string mode{"manual"};  ///< `manual` or `smart_joystick`.
  StickVelocity velocity{};    ///< For `drive`.
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
  bool is_drive() const override { return true; }
  void set_velocity(const StickVelocity& velocity) override;

 private:
  enum class Phase : std::uint8_t {
    waiting_for_sender,  ///< Earlier commands to the robot are not answered yet.
    centring,            ///< Streams zero before the mode is requested.
    requesting,          ///< The request of the mode is not answered yet.
    driving,             ///< Streams the requested velocity or the live stick.
    stopping,            ///< Streams zero before the stream ends.
    holding_centred,     ///< The result was reported; streams zero while the robot stays in the mode.
    over,
  };
  void enter_phase(Phase phase);
  void poll();
  void poll_driving(Duration in_phase);
  void on_sender_idle();
  void request_mode();
  void on_mode_reply(const Answer& answer);
  void start_driving();
  /// Streams zero, then ends the flow with this result; `none`: success.
  void finish(Reason reason, const std::string& text);
  void on_stopped();
  void end_stream();
  /// Describes the parts of the requested velocity that exceed the robot's limits; empty if none does.
  std::string exceeded_limits_text() const;
  /// The reason why the robot can no longer be driven; unset while it is in the mode, or may still enter it.
  std::optional<Error> drive_loss() const;
  /// Records that the robot was seen in the requested mode.
  void update_mode_seen();
  bool is_in_mode(const RobotView& robot) const { return robot.mode == params_.mode && !robot.stopped; }
  /// Whether the view is older than the request of the mode, so that it does not show its effect.
  bool is_outdated(const RobotView& robot) const {
    return robot.behaviour_count == behaviour_count_at_request_;
  }
  void stream(const StickVelocity& velocity, Stick::Source source = Stick::Source::held);

  SteerParams params_;
  Phase phase_{Phase::waiting_for_sender};
  Time phase_since_{};
  std::optional<Time> first_request_at_{};
  Time stick_renewed_at_{};
  Timer timer_{};
  bool mode_seen_{false};           ///< The robot was seen in the requested mode.
  bool hold_centred_after_{false};  ///< At the end the robot stays in its mode, with the stick centred.
  std::uint64_t behaviour_count_at_request_{};
  Answer result_{};
};

}  // namespace adit::station
