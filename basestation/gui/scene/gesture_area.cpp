// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/gesture_area.hpp"

#include <QMouseEvent>
#include <QTimerEvent>
#include <QTouchEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "basestation/gui/scene/theme.hpp"

namespace adit::gui {

namespace {
double length(const QPointF& v) { return std::hypot(v.x(), v.y()); }
}  // namespace

GestureArea::GestureArea(QQuickItem* parent) : QQuickItem(parent) {
  setAcceptedMouseButtons(Qt::LeftButton | Qt::RightButton | Qt::MiddleButton);
  setAcceptTouchEvents(true);
}

void GestureArea::press(const QPointF& at, bool aim) {
  start_ = last_ = at;
  since_.start();
  if (drawing()) {
    state_ = State::drawing;
    return;
  }
  if (aim || aiming()) return take_aim();
  state_ = State::pressed;
  timer_.start(Theme::instance().glove() ? kGlovePress : kLongPress, this);
}

void GestureArea::take_aim() {
  constexpr int kRingPeriod = 33;  // ms
  state_ = State::aimed;
  show_aim(start_);
  if (needs_hold() && held_share() < 1.0) timer_.start(kRingPeriod, this);
}

void GestureArea::leave_press() {
  timer_.stop();
  if (state_ == State::aimed) drop_aim();
  if (state_ == State::drawing) drop_drawing();
}

void GestureArea::move(const QPointF& at) {
  if ((state_ == State::pressed || state_ == State::aimed) && length(at - start_) > slop()) {
    leave_press();
    state_ = State::panning;
  }
  if (state_ == State::panning) pan(at - last_);
  if (state_ == State::drawing) draw(start_, at, false);
  last_ = at;
}

void GestureArea::release(const QPointF& at, bool add) {
  move(at);  // The last move may come with the release alone.
  const State was = state_;
  if (was == State::drawing) {
    state_ = State::idle;
    return draw(start_, at, true);
  }
  leave_press();
  state_ = State::idle;
  if (was == State::pressed) tap(start_, add);
  if (was == State::aimed) send_aim(start_, held_share() >= 1.0);
}

void GestureArea::drop_press() {
  leave_press();
  if (state_ != State::idle) state_ = State::ignored;
}

void GestureArea::cancel() {
  leave_press();
  state_ = State::idle;
}

void GestureArea::timerEvent(QTimerEvent* event) {
  if (event->timerId() != timer_.timerId()) return;
  timer_.stop();
  if (state_ == State::pressed || state_ == State::aimed) take_aim();
}

void GestureArea::mousePressEvent(QMouseEvent* event) {
  event->accept();
  if (state_ != State::idle) return cancel();  // A second button takes back.
  const bool right = event->button() == Qt::RightButton;
  if (event->button() == Qt::MiddleButton) {  // It moves the map and means no place.
    sliding_ = true;
    state_ = State::panning;
    last_ = event->position();
    return;
  }
  sliding_ = right || event->modifiers().testFlag(Qt::ShiftModifier);
  press(event->position(), right);
}
void GestureArea::mouseMoveEvent(QMouseEvent* event) { move(event->position()); }
void GestureArea::mouseReleaseEvent(QMouseEvent* event) {
  release(event->position(), event->modifiers().testFlag(Qt::ShiftModifier));
}

void GestureArea::wheelEvent(QWheelEvent* event) {
  event->accept();
  zoom(std::pow(1.2, std::clamp(event->angleDelta().y() / 120.0, -5.0, 5.0)), event->position());
}

void GestureArea::pinch(const QPointF& first, const QPointF& second) {
  const QPointF middle = (first + second) / 2;
  const double spread = std::max(length(first - second), 1.0);
  if (state_ != State::pinching) {
    leave_press();
    state_ = State::pinching;
    pinched_ = middle;
  } else {
    if (!holds_place() || length(middle - pinched_) > slop()) pan(middle - last_);
    zoom(std::clamp(spread / spread_, 0.2, 5.0), middle);
  }
  last_ = middle;
  spread_ = spread;
}

void GestureArea::touchEvent(QTouchEvent* event) {
  if (event->type() == QEvent::TouchCancel) return cancel();
  event->accept();
  QList<QPointF> down;
  for (const QEventPoint& point : event->points())
    if (point.state() != QEventPoint::Released) down.push_back(point.position());
  if (down.empty()) {
    if (state_ == State::pinching || state_ == State::ignored || event->points().empty())
      cancel();
    else
      release(event->points().front().position(), event->modifiers().testFlag(Qt::ShiftModifier));
    return;
  }
  if (down.size() > 2) {
    leave_press();
    state_ = State::ignored;
  }
  if (state_ == State::ignored) return;
  if (down.size() == 2) return pinch(down[0], down[1]);
  if (state_ == State::pinching) {  // One finger stays: it goes on to pan.
    state_ = State::panning;
    last_ = down[0];
  } else if (state_ == State::idle) {
    sliding_ = false;
    press(down[0], false);
  } else {
    move(down[0]);
  }
}

}  // namespace adit::gui
