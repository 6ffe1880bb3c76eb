// SPDX-License-Identifier: Apache-2.0
#include "basestation/flow/steer.hpp"

#include <cmath>
#include <utility>

#include "basestation/report/table.hpp"
#include "core/command/words.hpp"

namespace adit::station {

using namespace std::chrono_literals;

namespace {
constexpr StickVelocity kCentred{};
/// Period of zeros before the mode is requested: three samples, of which one arrives even on a lossy link.
constexpr Duration kCentredBeforeRequest = 150ms;
/// The request is repeated for this long while the robot answers that it has received no centred stick.
constexpr Duration kRequestRetryPeriod = 3s;
/// Period of zeros before the stream ends: six samples, so that the robot stops even if some are lost.
constexpr Duration kCentredBeforeEnd = 300ms;
/// A live stick that is not renewed for this long counts as released.
constexpr Duration kStickTimeout = 250ms;
/// Maximum time from the robot's reply until its published state shows the mode.
constexpr Duration kModeEntryTimeout = 2s;

/// Whether the robot's refusal of a stick sample means that it will refuse the next ones, too. A stale echo,
/// for example, ends with the next state that arrives from the robot.
bool is_permanent(Reason refusal) {
  switch (refusal) {
    case Reason::not_holder:
    case Reason::nobody_holds:
    case Reason::stopped:
    case Reason::stale_epoch:
    case Reason::wrong_mode:
    case Reason::identity_mismatch:
    case Reason::name_in_use:
      return true;
    default:
      return false;
  }
}
}  // namespace

Steer::Steer(FlowDependencies dependencies, std::string robot, SteerParams params, Done done)
    : Flow(dependencies, std::move(robot), std::move(done)), params_(std::move(params)) {}

void Steer::start() {
  enter_phase(Phase::waiting_for_sender);
  timer_ = dependencies_.strand.every(Stick::kPeriod, [weak = weak_from_this()] {
    if (auto self = weak.lock()) static_cast<Steer&>(*self).poll();
  });
  poll();
}

void Steer::enter_phase(Phase phase) {
  phase_ = phase;
  phase_since_ = dependencies_.strand.now();
}

void Steer::stream(const StickVelocity& velocity, Stick::Source source) {
  if (auto streamed = dependencies_.stick.stream(robot(), velocity, source); !streamed)
    finish(streamed.error().reason, streamed.error().text);
}

void Steer::end_stream() {
  dependencies_.stick.end(robot());
  timer_.cancel();
  enter_phase(Phase::over);
}

void Steer::poll() {
  const Duration in_phase = dependencies_.strand.now() - phase_since_;
  update_mode_seen();
  switch (phase_) {
    case Phase::waiting_for_sender:
      if (dependencies_.sender.idle(robot())) on_sender_idle();
      break;
    case Phase::centring:
      if (in_phase >= kCentredBeforeRequest) request_mode();
      break;
    case Phase::requesting:
      break;
    case Phase::driving:
      poll_driving(in_phase);
      break;
    case Phase::stopping:
      if (in_phase >= kCentredBeforeEnd) on_stopped();
      break;
    case Phase::holding_centred:
      if (drive_loss()) end_stream();
      break;
    case Phase::over:
      break;
  }
}

void Steer::poll_driving(Duration in_phase) {
  if (const auto loss = drive_loss()) return finish(loss->reason, loss->text);
  if (params_.purpose == SteerParams::Purpose::teleop) {
    if (dependencies_.strand.now() - stick_renewed_at_ > kStickTimeout) stream(kCentred);
    return;
  }
  if (in_phase < params_.duration) return;
  const bool lost = view() && view()->lost;
  finish(lost ? Reason::no_answer : Reason::none, lost ? "the robot was lost while it drove" : "");
}

void Steer::on_sender_idle() {
  const RobotView* robot_now = view();
  const bool mine = robot_now && robot_now->mine;
  if (mine && params_.purpose != SteerParams::Purpose::enter && robot_now->mode == "smart_joystick") {
    params_.mode = "smart_joystick";
    hold_centred_after_ = mode_seen_ = true;
    return start_driving();
  }
  // The reply to the request has the reason; a refused stream would report nothing.
  if (!mine) return request_mode();
  enter_phase(Phase::centring);
  stream(kCentred);
}

void Steer::request_mode() {
  enter_phase(Phase::requesting);
  if (!first_request_at_) first_request_at_ = dependencies_.strand.now();
  behaviour_count_at_request_ = view() ? view()->behaviour_count : 0;
  RobotCommand robot_command{.robot = robot(), .request = command::Request(command::verb("mode"))};
  robot_command.request.values.push_back({"MODE", {params_.mode}, {}});
  dependencies_.sender.send(std::move(robot_command), [weak = weak_from_this()](const Answer& answer) {
    if (auto self = weak.lock()) static_cast<Steer&>(*self).on_mode_reply(answer);
  });
}

void Steer::on_mode_reply(const Answer& answer) {
  if (phase_ != Phase::requesting) return;
  const bool no_stick = answer.reason == Reason::joystick_stale || answer.reason == Reason::stick_not_centred;
  if (no_stick && dependencies_.stick.streaming(robot()) &&
      dependencies_.strand.now() - *first_request_at_ < kRequestRetryPeriod)
    return enter_phase(Phase::centring);
  result_ = answer;
  if (!answer.accepted) {
    end_stream();
    return notify(answer);
  }
  if (params_.purpose != SteerParams::Purpose::enter) return start_driving();
  enter_phase(Phase::holding_centred);
  notify(answer);
}

void Steer::start_driving() {
  enter_phase(Phase::driving);
  result_.accepted = result_.answered = true;
  if (params_.purpose == SteerParams::Purpose::drive) stream(params_.velocity);
}

void Steer::set_velocity(const StickVelocity& velocity) {
  if (phase_ != Phase::driving) return;
  stick_renewed_at_ = dependencies_.strand.now();
  stream(velocity, Stick::Source::live);
}

void Steer::update_mode_seen() {
  if (phase_ != Phase::driving && phase_ != Phase::holding_centred) return;
  const RobotView* robot_now = view();
  if (robot_now && !is_outdated(*robot_now) && robot_now->mine && is_in_mode(*robot_now)) mode_seen_ = true;
}

std::optional<Error> Steer::drive_loss() const {
  const RobotView* robot_now = view();
  if (!robot_now || is_outdated(*robot_now)) return std::nullopt;
  if (!robot_now->mine) {
    if (robot_now->holder.empty()) return Error{Reason::nobody_holds, ""};
    return Error{Reason::not_holder, robot_now->holder + " holds the robot now"};
  }
  if (is_in_mode(*robot_now)) return std::nullopt;
  if (!mode_seen_ && dependencies_.strand.now() - phase_since_ < kModeEntryTimeout) return std::nullopt;
  if (robot_now->stopped) return Error{Reason::stopped, ""};
  return Error{Reason::wrong_mode, "the robot left " + params_.mode + " for " + robot_now->mode};
}

void Steer::stream_refused(Reason reason, const std::string& text) {
  // Refusals of the samples that were sent before the mode began may still arrive.
  const bool just_began = dependencies_.strand.now() - phase_since_ <= kCentredBeforeEnd;
  if (phase_ == Phase::driving && is_permanent(reason) && !just_began) finish(reason, text);
}

void Steer::cancel(Reason reason, const std::string& text) { finish(reason, text); }

void Steer::hand_over() {
  if (dependencies_.stick.streaming(robot())) (void)dependencies_.stick.stream(robot(), kCentred);
  timer_.cancel();
  enter_phase(Phase::over);
  notify({.command = {}, .reason = Reason::cancelled, .text = "another command took its place"});
}

void Steer::finish(Reason reason, const std::string& text) {
  if (phase_ == Phase::stopping || phase_ == Phase::over) return;
  const bool success = reason == Reason::none;
  result_.accepted = success;
  result_.reason = reason;
  result_.text = success ? exceeded_limits_text() : text;
  if (const RobotView* robot_now = view()) result_.holder = robot_now->holder;
  // After a failure the robot does not stay in its mode; a cancelled drive is none.
  if (!success && reason != Reason::cancelled) hold_centred_after_ = false;
  const bool streaming = dependencies_.stick.streaming(robot());
  enter_phase(Phase::stopping);
  if (!streaming || !dependencies_.stick.stream(robot(), kCentred)) on_stopped();
}

std::string Steer::exceeded_limits_text() const {
  const RobotView* robot_now = view();
  if (params_.purpose != SteerParams::Purpose::drive || !robot_now || !robot_now->described) return {};
  const auto& [vx, vy, wz] = params_.velocity;
  std::vector<std::string> limits;
  const bool sideways = vy != 0.0 && !robot_now->holonomic;
  if (sideways) limits.push_back("it cannot move sideways");
  if (std::hypot(vx, sideways ? 0.0 : vy) > robot_now->max_speed)
    limits.push_back(fixed(robot_now->max_speed, 1) + " m/s");
  if (std::abs(wz) > robot_now->max_turn) limits.push_back(fixed(robot_now->max_turn, 1) + " rad/s");
  return limits.empty() ? "" : "limited to what the robot can do: " + command::joined(limits, "");
}

void Steer::on_stopped() {
  if (hold_centred_after_)
    enter_phase(Phase::holding_centred);
  else
    end_stream();
  notify(result_);
}

}  // namespace adit::station
