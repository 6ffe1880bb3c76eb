// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/mark_tool.hpp"

#include "basestation/client/connection.hpp"
#include "basestation/gui/bridge/control.hpp"
#include "basestation/model/text.hpp"
#include "core/command/vocabulary.hpp"

namespace adit::gui {

MarkTool::MarkTool(Control& control) : QObject(&control), control_(control) {}

void MarkTool::set_active(bool active) {
  if (active == active_ && !ready()) return;
  active_ = active;
  place_.reset();
  if (active_) control_.say("Tap the place of the mark on the map; Esc takes it back.", "sent");
  emit changed();
}

QString MarkTool::place_text() const {
  return place_ ? QString("mark at %1 %2").arg(place_->x, 0, 'f', 1).arg(place_->y, 0, 'f', 1) : QString();
}

QStringList MarkTool::kinds() const {
  QStringList out;
  for (const std::string& kind : command::choices(command::info(command::verb("finding add")).arguments[1]))
    out << text_of(kind);
  return out;
}

void MarkTool::choose(const Point& place, std::optional<double> z) {
  if (!drawable(place.x, place.y)) return;
  active_ = false;
  place_ = place;
  z_ = z;
  emit changed();
}

void MarkTool::drop() {
  active_ = false;
  place_.reset();
  emit changed();
}

void MarkTool::apply(const QString& kind, const QString& text) {
  if (!ready()) return;
  if (control_.silent()) return control_.say("Not marked, as the station is silent", "refused");
  const QString words = text.simplified();
  bool is_number = false;
  words.toDouble(&is_number);
  if (is_number && !z_) z_ = 0.0;  // A text that is a number would be read as the height.
  std::vector<std::string> line{"finding", "add", kind.toStdString(), station::fixed(place_->x, 2),
                                station::fixed(place_->y, 2)};
  if (z_) line.push_back(station::fixed(*z_, 2));
  if (!words.isEmpty()) line.push_back(words.toStdString());
  drop();
  control_.order(station::client::quoted(line));
}

}  // namespace adit::gui
