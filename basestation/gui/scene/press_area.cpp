// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/press_area.hpp"

#include <QMouseEvent>
#include <QTimerEvent>
#include <QTouchEvent>
#include <algorithm>

namespace adit::gui {

PressArea::PressArea(QQuickItem* parent) : QQuickItem(parent) {
  setAcceptedMouseButtons(Qt::LeftButton);
  setAcceptTouchEvents(true);
}

void PressArea::set_meaning(const QString& meaning) {
  if (meaning == meaning_) return;
  meaning_ = meaning;
  changed_.start();
  cancel();
  emit settings_changed();
}

void PressArea::set_hold_time(int milliseconds) {
  if (milliseconds == hold_time_) return;
  hold_time_ = milliseconds;
  cancel();  // What a finger that is down would mean is no longer what it meant.
  emit settings_changed();
}

void PressArea::press() {
  if (pressed_) return;
  emit down();
  if (changed_.isValid() && changed_.elapsed() < kSettle) return;
  pressed_ = true;
  emit pressed_changed();
  since_.start();
  if (hold_time_ > 0) timer_.start(16, this);
}

void PressArea::move(const QPointF& at) {
  if (pressed_ && !contains(at)) cancel();
}

void PressArea::release(const QPointF& at, bool add) {
  const bool counts = pressed_ && (hold_time_ == 0 || taps_too_) && contains(at);
  cancel();
  if (counts) emit tapped(add);
}

void PressArea::cancel() {
  timer_.stop();
  set_progress(0.0);
  if (!pressed_) return;
  pressed_ = false;
  emit pressed_changed();
}

void PressArea::set_progress(double progress) {
  if (progress == progress_) return;
  progress_ = progress;
  emit progress_changed();
}

void PressArea::timerEvent(QTimerEvent* event) {
  if (event->timerId() != timer_.timerId()) return;
  set_progress(std::min(1.0, static_cast<double>(since_.elapsed()) / hold_time_));
  if (progress_ < 1.0) return;
  cancel();
  emit held();
}

void PressArea::mousePressEvent(QMouseEvent* event) {
  event->accept();
  press();
}
void PressArea::mouseMoveEvent(QMouseEvent* event) { move(event->position()); }
void PressArea::mouseReleaseEvent(QMouseEvent* event) {
  release(event->position(), event->modifiers().testFlag(Qt::ShiftModifier));
}

void PressArea::touchEvent(QTouchEvent* event) {
  if (event->type() == QEvent::TouchCancel) return cancel();
  if (event->points().empty()) return;
  event->accept();
  const QEventPoint& point = event->points().front();
  if (event->points().size() > 1) {  // Two fingers tap nothing, but they are down.
    const auto new_finger = [](const QEventPoint& finger) { return finger.state() == QEventPoint::Pressed; };
    if (!pressed_ && std::any_of(event->points().begin(), event->points().end(), new_finger)) emit down();
    return cancel();
  }
  if (point.state() == QEventPoint::Pressed)
    press();
  else if (point.state() == QEventPoint::Updated)
    move(point.position());
  else if (point.state() == QEventPoint::Released)
    release(point.position(), event->modifiers().testFlag(Qt::ShiftModifier));
}

}  // namespace adit::gui
