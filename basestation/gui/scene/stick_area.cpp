// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/stick_area.hpp"

#include <QMouseEvent>
#include <QTouchEvent>
#include <algorithm>
#include <cmath>

namespace adit::gui {

StickArea::StickArea(QQuickItem* parent) : QQuickItem(parent) {
  setAcceptedMouseButtons(Qt::LeftButton);
  setAcceptTouchEvents(true);
}

void StickArea::move(const QPointF& at) {
  const double radius = std::max(1.0, std::min(width(), height()) / 2);
  const double right = (at.x() - width() / 2) / radius, down = (at.y() - height() / 2) / radius;
  const double away = std::max(1.0, std::hypot(right, down));  // Beyond the edge: as at the edge.
  held_ = true;
  forward_ = -down / away;
  left_ = -right / away;
  emit moved();
}

void StickArea::let_go() {
  if (!held_) return;
  held_ = false;
  forward_ = left_ = 0.0;
  emit moved();
  emit released();
}

void StickArea::mousePressEvent(QMouseEvent* event) { move(event->position()); }
void StickArea::mouseMoveEvent(QMouseEvent* event) { move(event->position()); }
void StickArea::mouseReleaseEvent(QMouseEvent*) { let_go(); }

void StickArea::touchEvent(QTouchEvent* event) {
  event->accept();
  if (event->type() == QEvent::TouchCancel || event->points().empty()) return let_go();
  const QEventPoint& finger = event->points().front();
  if (event->points().size() > 1 || finger.state() == QEventPoint::Released)
    return let_go();  // Two are a palm.
  move(finger.position());
}

void StickArea::itemChange(ItemChange change, const ItemChangeData& data) {
  if (change == ItemVisibleHasChanged && !data.boolValue) let_go();
  QQuickItem::itemChange(change, data);
}

}  // namespace adit::gui
