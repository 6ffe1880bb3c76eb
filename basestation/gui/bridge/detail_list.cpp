// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/detail_list.hpp"

#include "basestation/gui/bridge/control.hpp"

namespace adit::gui {

DetailList::DetailList(Control& control)
    : QObject(&control),
      control_(control),
      rows_({"label", "value", "differs", "actionLabel", "actionLine", "actionHold"}, this) {}

void DetailList::refresh() {
  if (!open_) return;
  details_ = details_of(control_.world(), control_.selection(), control_.silent_for());
  std::vector<QVariantList> rows;
  for (const Detail& detail : details_) {
    const bool offered = !detail.action.line.empty() && !control_.silent();
    rows.push_back({text_of(detail.label), Control::one_line(detail.value), detail.differs,
                    offered ? text_of(detail.action.label) : QString(), text_of(detail.action.line),
                    detail.action.hold});
  }
  rows_.show(std::move(rows));
  refresh_cameras();
}

void DetailList::refresh_cameras() {
  const auto& selection = control_.selection();
  const station::Robot* robot = selection.size() == 1 ? control_.world().robot(selection.front()) : nullptr;
  QStringList names;
  QString text;
  if (robot != nullptr)
    for (const station::CameraStatus& camera : robot->cameras) names << text_of(camera.name);
  const QString chosen = names.contains(camera_) ? camera_ : names.value(0);
  if (robot != nullptr)
    for (const station::CameraStatus& camera : robot->cameras)
      if (text_of(camera.name) == chosen && camera.width > 0)
        text = QString("%1 x %2, %3 a second, %4 kbit/s")
                   .arg(camera.width)
                   .arg(camera.height)
                   .arg(static_cast<double>(camera.rate), 0, 'f', 1)
                   .arg(static_cast<double>(camera.bytes) * 8e-3, 0, 'f', 0);
  const QString name = names.isEmpty() ? QString() : text_of(robot->name);
  const bool changed =
      static_cast<int>(assign(camera_robot_, name)) + static_cast<int>(assign(cameras_, names)) +
          static_cast<int>(assign(camera_, chosen)) + static_cast<int>(assign(camera_text_, text)) >
      0;
  if (changed) emit cameras_changed();
}

void DetailList::set_camera_on(bool on) {
  if (assign(camera_on_, on)) emit cameras_changed();
}

void DetailList::next_camera() {
  const auto at = cameras_.indexOf(camera_);
  if (cameras_.size() < 2) return;
  camera_ = cameras_[(at + 1) % cameras_.size()];
  emit cameras_changed();
}

void DetailList::act(int row, bool held) {
  if (row < 0 || row >= static_cast<int>(details_.size())) return;
  const DetailAction action = details_[static_cast<std::size_t>(row)].action;
  if (action.line.empty() || (action.hold && !held)) return;
  control_.order(action.line);
}

void DetailList::set_open(bool open) {
  if (!assign(open_, open)) return;
  refresh();
  emit open_changed();
}

}  // namespace adit::gui
