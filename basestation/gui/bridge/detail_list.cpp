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
