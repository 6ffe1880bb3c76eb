// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/log_view.hpp"

#include <QRegularExpression>
#include <algorithm>

#include "basestation/gui/bridge/control.hpp"

namespace adit::gui {
namespace {

enum Column { kRow, kTime, kKind, kWho, kLine };

}  // namespace

LogView::LogView(RowModel& all, QObject* parent)
    : QObject(parent), all_(all), shown_({"row", "time", "kind", "who", "line"}, this) {
  connect(&all_, &RowModel::rowsInserted, this, &LogView::added);
}

bool LogView::passes(const QVariantList& row) const {
  const QString kind = row[kKind].toString();
  if (warnings_ && kind != "warn" && kind != "bad") return false;
  const QString who = row[kWho].toString(), line = row[kLine].toString();
  if (selected_) {
    const QStringList words = line.split(QRegularExpression("[^A-Za-z0-9_-]+"), Qt::SkipEmptyParts);
    const bool named = std::any_of(selection_.begin(), selection_.end(), [&](const QString& robot) {
      return robot == who || words.contains(robot);
    });
    if (!named) return false;
  }
  return text_.isEmpty() || line.contains(text_, Qt::CaseInsensitive) ||
         who.contains(text_, Qt::CaseInsensitive);
}

void LogView::added() {
  const QVariantList& row = all_.rows().front();
  if (!passes(row)) return;
  if (paused_) {
    ++waiting_;
    emit changed();
  } else {
    shown_.prepend(row, Control::kMaxLog);
  }
}

void LogView::show() {
  waiting_ = 0;
  std::vector<QVariantList> rows;
  for (const QVariantList& row : all_.rows())
    if (passes(row)) rows.push_back(row);
  shown_.show(std::move(rows));
  emit changed();
}

void LogView::set_text(const QString& text) {
  if (assign(text_, text)) show();
}

void LogView::set_warnings(bool only) {
  if (assign(warnings_, only)) show();
}

void LogView::set_selected(bool only) {
  if (assign(selected_, only)) show();
}

void LogView::set_paused(bool paused) {
  if (!assign(paused_, paused)) return;
  if (!paused && waiting_ > 0) return show();
  emit changed();
}

void LogView::set_selection(const std::vector<std::string>& selection) {
  QStringList names;
  for (const std::string& name : selection) names << text_of(name);
  if (assign(selection_, names) && selected_) show();
}

QString LogView::as_text() const {
  QString out;
  for (auto row = all_.rows().rbegin(); row != all_.rows().rend(); ++row)
    if (passes(*row))
      out += QString("%1  %2  %3  %4\n")
                 .arg((*row)[kTime].toString(), (*row)[kKind].toString(), (*row)[kWho].toString(),
                      (*row)[kLine].toString().simplified());
  return out;
}

}  // namespace adit::gui
