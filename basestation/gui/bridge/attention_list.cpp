// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/attention_list.hpp"

#include <algorithm>

#include "basestation/gui/bridge/control.hpp"

namespace adit::gui {
namespace {

QList<QByteArray> roles() {
  return {"need",      "urgent", "who",    "shortWho", "line",
          "shortLine", "since",  "canSee", "canWait",  "grantLabel"};
}

}  // namespace

AttentionList::AttentionList(Control& control)
    : QObject(&control), control_(control), rows_(roles(), this), top_(roles(), this) {}

station::Priority AttentionList::add(const station::Notice& notice) {
  return queue_.add(notice, control_.world(), control_.now());
}

void AttentionList::refresh() {
  queue_.update(control_.world(), control_.now());
  const bool was_open = is_open();
  needs_ = needs_of(queue_, control_.world(), control_.now());
  std::vector<QVariantList> rows;
  for (const Need& need : needs_) {
    rows.push_back({text_of(need.id), need.urgent, text_of(need.who), text_of(need.short_who),
                    Control::one_line(need.text), Control::one_line(need.short_text), text_of(need.since),
                    need.can_see, need.can_wait, text_of(need.grant_label)});
  }
  top_.show({rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(std::min(rows.size(), kTop))});
  rows_.show(std::move(rows));
  emit changed();
  if (was_open != is_open()) emit open_changed();
}

const Need* AttentionList::find(const QString& id) const {
  const auto found =
      std::find_if(needs_.begin(), needs_.end(), [&](const Need& need) { return text_of(need.id) == id; });
  return found == needs_.end() ? nullptr : &*found;
}

void AttentionList::show(const QString& id) {
  const Need* need = find(id);
  if (!need) return;
  last_shown_ = id;
  control_.select_and_show(need->robots);
}

void AttentionList::see(const QString& id) {
  const Need* need = find(id);
  if (!need) return;
  queue_.see(need->alert);
  refresh();
}

void AttentionList::later(const QString& id) {
  const Need* need = find(id);
  if (!need) return;
  queue_.later(need->alert, control_.now());
  refresh();
}

void AttentionList::grant(const QString& id, bool held) {
  const Need* need = find(id);
  if (!need || need->grant_line.empty() || !held) return;
  control_.order(need->grant_line);
}

void AttentionList::show_next() {
  if (needs_.empty()) return;
  std::size_t next = 0;
  for (std::size_t i = 0; i < needs_.size(); ++i)
    if (text_of(needs_[i].id) == last_shown_) next = (i + 1) % needs_.size();
  show(text_of(needs_[next].id));
}

QString AttentionList::quiet() const {
  return control_.robot_count() == 0 ? "no robot heard yet" : "no robot needs you";
}

void AttentionList::set_open(bool open) {
  if (assign(open_, open)) emit open_changed();
}

}  // namespace adit::gui
