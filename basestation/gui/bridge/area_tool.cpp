// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/area_tool.hpp"

#include <algorithm>
#include <cmath>

#include "basestation/gui/bridge/control.hpp"
#include "basestation/model/text.hpp"

namespace adit::gui {

std::string free_area_name(const station::World& world) {
  for (int number = 1;; ++number) {
    const std::string name = "a" + std::to_string(number);
    const bool used = std::any_of(world.robots.begin(), world.robots.end(), [&](const station::Robot& robot) {
      return std::any_of(robot.areas.begin(), robot.areas.end(),
                         [&](const Area& area) { return area.name == name; });
    });
    if (!used) return name;
  }
}

AreaTool::AreaTool(Control& control) : QObject(&control), control_(control) {}

std::vector<std::string> AreaTool::robots() const {
  std::vector<std::string> names;
  for (const std::string& name : control_.selection())
    if (const station::Robot* robot = control_.world().robot(name); robot && robot->mine)
      names.push_back(name);
  return names;
}

void AreaTool::set_active(bool active) {
  if (active && robots().empty()) {
    control_.say("Area: select robots of yours first", "refused");
    return;
  }
  if (active == active_ && !ready_) return;
  active_ = active;
  ready_ = false;
  if (active_) control_.say("Drag over the map from corner to corner; Esc takes it back.", "sent");
  emit changed();
}

void AreaTool::draw(const Point& from, const Point& to, bool done) {
  if (!active_) return;
  from_ = from;
  to_ = to;
  const bool large = std::abs(to.x - from.x) >= kLeastSide && std::abs(to.y - from.y) >= kLeastSide;
  ready_ = large && done;
  if (!done || ready_) {
    emit changed();
    return;
  }
  drop();
}

void AreaTool::refresh() {
  if (ready_) emit changed();
}

void AreaTool::drop() {
  from_ = to_ = {};
  ready_ = false;
  emit changed();
}

std::vector<Point> AreaTool::sketch() const {
  if (!active_ || from_ == to_) return {};
  return {from_, {to_.x, from_.y}, to_, {from_.x, to_.y}};
}

QString AreaTool::text() const {
  QStringList names;
  for (const std::string& name : robots()) names << text_of(name);
  return QString("%1 x %2 m for %3")
      .arg(std::abs(to_.x - from_.x), 0, 'f', 1)
      .arg(std::abs(to_.y - from_.y), 0, 'f', 1)
      .arg(names.join(" "));
}

bool AreaTool::is_held() const { return needs_hold("area", robots().size()); }

void AreaTool::apply(const QString& kind, bool held) {
  const std::vector<std::string> names = robots();
  if (!ready_ || control_.silent() || (is_held() && !held)) return;
  if (names.empty()) {
    control_.say("Area: no robot of yours is selected any more", "refused");
    return;
  }
  std::string line = "area";
  for (const std::string& name : names) line += " " + name;
  line += " add " + free_area_name(control_.world()) + " " + kind.toStdString();
  for (const double value : {from_.x, from_.y, to_.x, to_.y}) line += " " + station::fixed(value, 2);
  active_ = false;
  drop();
  control_.order(line);
}

}  // namespace adit::gui
