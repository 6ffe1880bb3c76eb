// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/drive_control.hpp"

#include <algorithm>
#include <cmath>

#include "basestation/gui/break.hpp"
#include "basestation/gui/bridge/card.hpp"
#include "basestation/gui/bridge/control.hpp"
#include "basestation/model/text.hpp"

namespace adit::gui {
namespace {

QString speed_text(double forward, double sideways, double turn) {
  return text_of(station::fixed(forward, 2) + " m/s, " + station::fixed(turn, 2) + " rad/s" +
                 (sideways == 0.0 ? "" : ", sideways " + station::fixed(sideways, 2) + " m/s"));
}

}  // namespace

DriveControl::DriveControl(Control& control) : QObject(&control), control_(control) {
  connect(&timer_, &QTimer::timeout, this, &DriveControl::look);
}

void DriveControl::use(DriveSink& sink, std::function<InputThread::Pad()> make_pad) {
  thread_ = std::make_unique<InputThread>(sink, std::move(make_pad));
  thread_->focus(focused_);
  timer_.start(kBeatMs);
}

void DriveControl::stop_using() {
  timer_.stop();
  thread_.reset();
  status_ = {};
}

void DriveControl::begin(const std::string& robot) {
  if (!thread_) return control_.say("Drive: there is no way to the station", "refused");
  down_.clear();
  thread_->beat();
  thread_->drive(robot);
  control_.say("Driving " + text_of(robot) + "; Esc lets go.", "sent");
  look();
}

void DriveControl::letGo() {
  if (!thread_ || !driving()) return;
  thread_->let_go();
  control_.say("Let go of " + robot() + ".", "done");
  look();
}

void DriveControl::touch(double forward, double turn) {
  if (thread_) thread_->touch(true, {forward, 0.0, turn});
}

void DriveControl::release() {
  if (thread_) thread_->touch(false, {});
}

void DriveControl::setMode(const QString& mode) {
  if (driving()) control_.order("mode " + status_.robot + " " + mode.toStdString());
}

void DriveControl::stopRobot() {
  if (driving()) control_.stop({status_.robot});
}

QString DriveControl::camera() const {
  const station::Robot* robot = driving() ? control_.world().robot(status_.robot) : nullptr;
  return robot != nullptr && !robot->cameras.empty() ? text_of(robot->cameras.front().name) : QString();
}

bool DriveControl::press(int key, int place) {
  constexpr std::array<int, 10> kDriving{Qt::Key_Up, Qt::Key_Down, Qt::Key_Left, Qt::Key_Right, Qt::Key_W,
                                         Qt::Key_A,  Qt::Key_S,    Qt::Key_D,    Qt::Key_Q,     Qt::Key_E};
  const bool drives = std::ranges::find(kDriving, key) != kDriving.end();
  if (!driving()) return false;
  if (key == Qt::Key_Escape || key == Qt::Key_B) {
    letGo();
  } else if (key == Qt::Key_X) {
    stopRobot();
  } else if (drives) {
    down_[place] = key;
    send_keys();
  } else if (key == Qt::Key_Space) {
    forget_keys();
  } else {
    return false;
  }
  return true;
}

void DriveControl::release_key(int place) {
  if (down_.erase(place) > 0) send_keys();
}

void DriveControl::forget_keys() {
  down_.clear();
  send_keys();
}

void DriveControl::set_focused(bool focused) {
  focused_ = focused;
  if (thread_) thread_->focus(focused);
}

void DriveControl::send_keys() {
  const auto down = [&](int key) {
    return std::ranges::any_of(down_, [key](const auto& at) { return at.second == key; });
  };
  const auto axis = [&](int more, int also_more, int less, int also_less) {
    return static_cast<double>((down(more) || down(also_more)) - (down(less) || down(also_less)));
  };
  if (thread_)
    thread_->keys({axis(Qt::Key_Up, Qt::Key_W, Qt::Key_Down, Qt::Key_S),
                   axis(Qt::Key_Q, Qt::Key_Q, Qt::Key_E, Qt::Key_E),
                   axis(Qt::Key_Left, Qt::Key_A, Qt::Key_Right, Qt::Key_D)});
}

void DriveControl::look() {
  if (!thread_) return;
  thread_->beat();
  if constexpr (kBreakBoundStick)
    if (driving() && !control_.selection().empty() && control_.selection().front() != status_.robot)
      thread_->drive(control_.selection().front());
  const InputThread::Status before = std::exchange(status_, thread_->status());
  if (before.robot != status_.robot) down_.clear();
  if (!before.robot.empty() && status_.robot.empty() && !status_.ended.empty())
    control_.say("Driving " + text_of(before.robot) + " ended: " + Control::one_line(status_.ended),
                 "refused");
  if (status_.starts != before.starts && !driving()) control_.drive_selected();
  if (status_.takes != before.takes) control_.take_selected(false);
  if (status_.takes_held != before.takes_held) control_.take_selected(true);
  if (status_.steps != before.steps && !driving()) control_.move_selection(status_.steps - before.steps);
  if (status_ != before || driving()) emit changed();
}

void DriveControl::warn_hand(bool strongly) {
  using namespace std::chrono_literals;
  if (thread_) thread_->rumble(strongly ? 1.0 : 0.5, strongly ? 600ms : 200ms);
}

QString DriveControl::mode() const {
  const station::Robot* robot = control_.world().robot(status_.robot);
  return robot ? text_of(robot->mode) : QString();
}

QString DriveControl::asked() const {
  return speed_text(status_.asked.vx, status_.asked.vy, status_.asked.wz);
}

QString DriveControl::measured() const {
  const station::Robot* robot = control_.world().robot(status_.robot);
  return robot ? speed_text(robot->vx, robot->vy, robot->wz) : QString();
}

QString DriveControl::age() const {
  const station::Robot* robot = control_.world().robot(status_.robot);
  return robot ? text_of(age_text(robot->age + control_.silent_for())) : QString();
}

bool DriveControl::good() const {
  const station::Robot* robot = control_.world().robot(status_.robot);
  return robot && robot->age + control_.silent_for() <= station::input::DriveSession::kOldState &&
         !robot->stopped && robot->stops.empty();
}

}  // namespace adit::gui
