// SPDX-License-Identifier: Apache-2.0
#include "basestation/flow/steer.hpp"

#include <cmath>
#include <utility>

#include "basestation/report/table.hpp"
#include "core/command/words.hpp"

namespace adit::station {

using namespace std::chrono_literals;

namespace {
constexpr std::array<double, 3> kCentred{0.0, 0.0, 0.0};
constexpr Duration kLead = 150ms;  // Zeros before the request, so that one of them arrives.
constexpr Duration kInsist = 3s;   // A robot that did not receive the stick yet is asked again for this long.
constexpr Duration kSettle = 300ms;      // Zeros before the end of the stream.
constexpr Duration kStickLapse = 250ms;  // A live stick that is not renewed counts as released.
constexpr Duration kAppear = 2s;         // By then the behaviour state has the mode.
}  // namespace

Steer::Steer(FlowDependencies dependencies, std::string robot, SteerParams params, Done done)
    : Flow(dependencies, std::move(robot), std::move(done)), params_(std::move(params)) {}

void Steer::start() {
  enter_phase(Phase::waiting);
  timer_ = dependencies_.strand.every(Stick::kPeriod, [weak = weak_from_this()] {
    if (auto self = weak.lock()) static_cast<Steer&>(*self).poll();
  });
  poll();
}

void Steer::enter_phase(Phase phase) {
  phase_ = phase;
  phase_since_ = dependencies_.strand.now();
}

void Steer::stream(const std::array<double, 3>& velocity, Stick::Source source) {
  if (auto streamed = dependencies_.stick.stream(robot(), velocity, source); !streamed)
    end(streamed.error().reason, streamed.error().text);
}

void Steer::poll() {
  const Duration since = dependencies_.strand.now() - phase_since_;
  Reason reason{};
  std::string text;
  switch (phase_) {
    case Phase::waiting:
      if (dependencies_.sender.idle(robot())) begin();
      break;
    case Phase::centring:
      if (since >= kLead) ask();
      break;
    case Phase::asking:
      break;
    case Phase::moving:
      if (left_mode(reason, text)) return end(reason, text);
      if (params_.purpose == SteerParams::Purpose::teleop) {
        if (dependencies_.strand.now() - stick_at_ > kStickLapse) stream(kCentred);
      } else if (since >= params_.duration) {
        const bool lost = view() && view()->lost;
        end(lost ? Reason::no_answer : Reason::none, lost ? "the robot was lost while it drove" : "");
      }
      break;
    case Phase::settling:
      if (since >= kSettle) settled();
      break;
    case Phase::keeping:
      if (left_mode(reason, text)) {
        dependencies_.stick.end(robot());
        timer_.cancel();
        enter_phase(Phase::over);
      }
      break;
    case Phase::over:
      break;
  }
}

void Steer::begin() {
  const RobotView* robot_now = view();
  const bool mine = robot_now && dependencies_.fleet.held_by_me(*robot_now);
  if (mine && params_.purpose != SteerParams::Purpose::enter && robot_now->mode == "smart_joystick") {
    params_.mode = "smart_joystick";
    keep_after_ = seen_in_mode_ = true;
    return move();
  }
  if (!mine) return ask();  // The robot's answer has the reason; a refused stream would report nothing.
  enter_phase(Phase::centring);
  stream(kCentred);
}

void Steer::ask() {
  enter_phase(Phase::asking);
  if (!asked_) first_asked_ = dependencies_.strand.now();
  asked_ = true;
  behaviour_before_ = view() ? view()->behaviour_count : 0;
  RobotCommand robot_command{.robot = robot(), .request = command::Request(command::verb("mode"))};
  robot_command.request.values.push_back({"MODE", {params_.mode}, {}});
  dependencies_.sender.send(std::move(robot_command), [weak = weak_from_this()](const Answer& answer) {
    if (auto self = weak.lock()) static_cast<Steer&>(*self).answered(answer);
  });
}

void Steer::answered(const Answer& answer) {
  if (phase_ != Phase::asking) return;
  const bool no_stick = answer.reason == Reason::joystick_stale || answer.reason == Reason::stick_not_centred;
  if (no_stick && dependencies_.stick.streaming(robot()) &&
      dependencies_.strand.now() - first_asked_ < kInsist)
    return enter_phase(Phase::centring);
  outcome_ = answer;
  if (!answer.accepted) {
    dependencies_.stick.end(robot());
    timer_.cancel();
    enter_phase(Phase::over);
    return notify(answer);
  }
  if (params_.purpose != SteerParams::Purpose::enter) return move();
  enter_phase(Phase::keeping);
  notify(answer);
}

void Steer::move() {
  enter_phase(Phase::moving);
  outcome_.accepted = outcome_.answered = true;
  if (params_.purpose == SteerParams::Purpose::drive) stream(params_.velocity);
}

void Steer::set_velocity(const std::array<double, 3>& velocity) {
  if (phase_ != Phase::moving) return;
  stick_at_ = dependencies_.strand.now();
  stream(velocity, Stick::Source::live);
}

bool Steer::left_mode(Reason& reason, std::string& text) {
  const RobotView* robot_now = view();
  if (!robot_now || robot_now->behaviour_count == behaviour_before_) return false;
  if (!dependencies_.fleet.held_by_me(*robot_now)) {
    reason = robot_now->holder.empty() ? Reason::nobody_holds : Reason::not_holder;
    text = robot_now->holder.empty() ? "" : robot_now->holder + " holds the robot now";
    return true;
  }
  if (robot_now->mode == params_.mode && !robot_now->stopped) {
    seen_in_mode_ = true;
    return false;
  }
  if (!seen_in_mode_ && dependencies_.strand.now() - phase_since_ < kAppear) return false;
  reason = robot_now->stopped ? Reason::stopped : Reason::wrong_mode;
  text = robot_now->stopped ? "" : "the robot left " + params_.mode + " for " + robot_now->mode;
  return true;
}

void Steer::stream_refused(Reason reason, const std::string& text) {
  // A stale echo is temporary; these reasons are not.
  const bool lasting = reason == Reason::not_holder || reason == Reason::nobody_holds ||
                       reason == Reason::stopped || reason == Reason::stale_epoch ||
                       reason == Reason::wrong_mode || reason == Reason::identity_mismatch ||
                       reason == Reason::name_in_use;
  if (phase_ == Phase::moving && lasting && dependencies_.strand.now() - phase_since_ > kSettle)
    end(reason, text);
}

void Steer::cancel(Reason reason, const std::string& text) { end(reason, text); }

void Steer::hand_over() {
  if (dependencies_.stick.streaming(robot())) (void)dependencies_.stick.stream(robot(), kCentred);
  timer_.cancel();
  enter_phase(Phase::over);
  notify({.command = {}, .reason = Reason::cancelled, .text = "another command took its place"});
}

void Steer::end(Reason reason, const std::string& text) {
  if (phase_ == Phase::settling || phase_ == Phase::over) return;
  outcome_.accepted = reason == Reason::none;
  outcome_.reason = reason;
  outcome_.text = reason == Reason::none ? clipped() : text;
  if (const RobotView* robot_now = view()) outcome_.holder = robot_now->holder;
  if (reason != Reason::none) keep_after_ = keep_after_ && reason == Reason::cancelled;
  const bool streaming = dependencies_.stick.streaming(robot());
  enter_phase(Phase::settling);
  if (!streaming || !dependencies_.stick.stream(robot(), kCentred)) settled();
}

std::string Steer::clipped() const {
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

void Steer::settled() {
  if (keep_after_) {
    enter_phase(Phase::keeping);
  } else {
    dependencies_.stick.end(robot());
    timer_.cancel();
    enter_phase(Phase::over);
  }
  notify(outcome_);
}

}  // namespace adit::station
