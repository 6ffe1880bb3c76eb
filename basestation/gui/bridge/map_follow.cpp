// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/map_follow.hpp"

#include <cmath>
#include <utility>

#include "basestation/gui/bridge/control.hpp"

namespace adit::gui {

void MapFollow::toggle() {
  if (!robot_.isEmpty()) return end();
  if (is_driving())
    robot_ = driven_;
  else if (!control_.selection().empty())
    robot_ = text_of(control_.selection().front());
  else
    return control_.say("Follow: select a robot", "refused");
  emit changed();
}

void MapFollow::toggleHeading() {
  if (!heading_up_ && robot_.isEmpty()) toggle();
  if (!heading_up_ && robot_.isEmpty()) return;  // There is no robot to follow.
  heading_up_ = !heading_up_;
  if (is_driving()) heading_up_driving_ = heading_up_;
  emit changed();
}

void MapFollow::end() {
  if (robot_.isEmpty()) return;
  robot_.clear();
  emit changed();
}

void MapFollow::end_heading() {
  if (std::exchange(heading_up_, false)) emit changed();
}

void MapFollow::refresh_drive() {
  const QString driven = control_.drive()->robot();
  if (driven == driven_) return;
  if (driven_.isEmpty()) before_ = robot_;
  followed_to_the_end_ = robot_ == driven_;
  driven_ = driven;
  robot_ = is_driving() ? driven_ : before_;
  heading_up_ = is_driving() && heading_up_driving_;
  emit drive_changed(is_driving());
  emit changed();
}

const station::Robot* MapFollow::target() const {
  const station::Robot* robot = control_.world().robot(robot_.toStdString());
  const bool known = robot && robot->located && drawable(robot->x, robot->y) && std::abs(robot->z) < 1e5F &&
                     std::isfinite(robot->yaw);
  return known ? robot : nullptr;
}

}  // namespace adit::gui
