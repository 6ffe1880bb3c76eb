// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/input_thread.hpp"

#include <chrono>

namespace adit::gui {
namespace {

using station::input::DriveSession;
using station::input::Gamepad;

constexpr std::chrono::milliseconds kReadPeriod{10};   // While a robot is driven or a controller is there.
constexpr std::chrono::milliseconds kIdlePeriod{200};  // Otherwise: looks for a controller.

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

InputThread::InputThread(DriveSink& sink, std::function<Pad()> make_pad)
    : sink_(sink), make_pad_(std::move(make_pad)), beat_(steady_seconds()) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

InputThread::~InputThread() {
  thread_.request_stop();
  wake_.notify_all();
  thread_.join();
  const std::lock_guard guard(mutex_);
  end_drive({});
}

void InputThread::beat() {
  const std::lock_guard guard(mutex_);
  beat_ = steady_seconds();
}

void InputThread::drive(const std::string& robot) {
  const std::lock_guard guard(mutex_);
  end_drive({});
  hands_.touching = false;
  hands_.keys = {};
  session_.emplace(robot, steady_seconds());
  status_.robot = robot;
  status_.ended.clear();
  status_.why.clear();
  status_.asked = {};
  request_ = sink_.drive(robot, [this, drive = ++drives_](const station::CommandOutcome& outcome) {
    const std::lock_guard again(mutex_);
    if (!session_ || drive != drives_) return;
    std::string why = outcome.error.empty() ? outcome.text : outcome.error;
    while (!why.empty() && why.back() == '\n') why.pop_back();
    session_.reset();  // The station ended it, so there is nothing to cancel.
    status_.robot.clear();
    status_.asked = {};
    status_.ended = why.empty() ? "it ended" : why;
  });
  wake_.notify_all();
}

void InputThread::let_go() {
  const std::lock_guard guard(mutex_);
  end_drive({});
}

/// With the mutex held.
void InputThread::end_drive(const std::string& why) {
  if (!session_) return;
  sink_.stick(request_, {});
  sink_.cancel(request_);
  session_.reset();
  status_.robot.clear();
  status_.asked = {};
  status_.why.clear();
  status_.ended = why;
}

void InputThread::touch(bool touching, const std::array<double, 3>& axes) {
  const std::lock_guard guard(mutex_);
  hands_.touching = touching;
  hands_.touched = axes;
  wake_.notify_all();
}

void InputThread::keys(const std::array<double, 3>& axes) {
  const std::lock_guard guard(mutex_);
  hands_.keys = axes;
  wake_.notify_all();
}

void InputThread::focus(bool focused) {
  const std::lock_guard guard(mutex_);
  focused_ = focused;
  wake_.notify_all();
}

void InputThread::rumble(double strength, std::chrono::milliseconds duration) {
  const std::lock_guard guard(mutex_);
  rumble_ = {strength, duration};
  wake_.notify_all();
}

InputThread::Status InputThread::status() const {
  const std::lock_guard guard(mutex_);
  return status_;
}

void InputThread::run(const std::stop_token& stop) {
  const Pad pad = make_pad_();
  while (!stop.stop_requested()) {
    const Gamepad::State state = pad.read();
    std::unique_lock guard(mutex_);
    if (const auto wanted = std::exchange(rumble_, std::nullopt); wanted && pad.rumble) {
      guard.unlock();
      pad.rumble(wanted->first, wanted->second);
      guard.lock();
    }
    step(state, steady_seconds());
    const bool busy = session_ || state.present;
    // By the system's clock: the thread sanitizer does not know the wait by the steady one.
    wake_.wait_until(guard, stop, std::chrono::system_clock::now() + (busy ? kReadPeriod : kIdlePeriod),
                     [] { return false; });
  }
}

/// With the mutex held.
void InputThread::step(const Gamepad::State& pad, double now) {
  const auto pressed = [&](bool Gamepad::State::*button) { return pad.*button && !(last_pad_.*button); };
  // What is held at the moment when a controller comes is no press, except for a stop.
  const bool known = last_pad_.present;
  const auto held = [&](bool Gamepad::State::*button, double& since, double limit) {
    if (known && pressed(button)) since = now;
    if (!(pad.*button)) since = 0.0;
    if (since == 0.0 || now - since < limit) return false;
    since = 0.0;
    return true;
  };
  // Stops do not depend on anything else.
  if (pressed(&Gamepad::State::stop_all)) sink_.halt({});
  if (pressed(&Gamepad::State::stop) && session_) sink_.halt({session_->robot()});
  if (pressed(&Gamepad::State::quit)) end_drive("let go");
  // A hold means the robot that was selected when it began.
  if (pressed(&Gamepad::State::next) || pressed(&Gamepad::State::previous)) take_since_ = start_since_ = 0.0;
  status_.takes += known && pressed(&Gamepad::State::take);
  status_.takes_held += held(&Gamepad::State::take, take_since_, kTakeHeld);
  status_.starts += held(&Gamepad::State::start, start_since_, kStartHeld);
  if (!session_ && known)
    status_.steps += pressed(&Gamepad::State::next) - pressed(&Gamepad::State::previous);
  status_.pad = pad.present;
  status_.dead_man = pad.shoulder || hands_.touching || hands_.keys != std::array<double, 3>{};
  last_pad_ = pad;
  hands_.pad = pad;
  if (!session_) return;
  const auto world = sink_.world();
  const DriveSession::Step next = session_->step(
      hands_, {world->robot(session_->robot()), sink_.silent_for(), now - beat_, focused_}, now);
  if (next.ends) return end_drive(next.why);
  status_.asked = next.velocity;
  status_.why = next.why;
  if (next.send) sink_.stick(request_, next.velocity);
}

}  // namespace adit::gui
