// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/row_model.hpp"

#include <algorithm>

namespace adit::gui {

void RowModel::remove(std::size_t row) {
  beginRemoveRows({}, static_cast<int>(row), static_cast<int>(row));
  rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(row));
  endRemoveRows();
}

void RowModel::show(std::vector<QVariantList> rows) {
  const auto holds = [](const std::vector<QVariantList>& list, std::size_t from, const QVariant& id) {
    return std::any_of(list.begin() + static_cast<std::ptrdiff_t>(from), list.end(),
                       [&](const QVariantList& row) { return row[0] == id; });
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    while (i < rows_.size() && rows_[i][0] != rows[i][0] && !holds(rows, i, rows_[i][0])) remove(i);
    const int at = static_cast<int>(i);
    if (i < rows_.size() && rows_[i][0] == rows[i][0]) {
      if (rows_[i] == rows[i]) continue;
      rows_[i] = std::move(rows[i]);
      emit dataChanged(index(at), index(at));
      continue;
    }
    for (std::size_t later = i; later < rows_.size(); ++later)
      if (rows_[later][0] == rows[i][0]) {
        remove(later);  // It moved up.
        break;
      }
    beginInsertRows({}, at, at);
    rows_.insert(rows_.begin() + at, std::move(rows[i]));
    endInsertRows();
  }
  while (rows_.size() > rows.size()) remove(rows_.size() - 1);
}

void RowModel::prepend(QVariantList row, std::size_t limit) {
  beginInsertRows({}, 0, 0);
  rows_.insert(rows_.begin(), std::move(row));
  endInsertRows();
  while (rows_.size() > limit) remove(rows_.size() - 1);
}

int RowModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

QVariant RowModel::data(const QModelIndex& index, int role) const {
  const int column = role - Qt::UserRole;
  if (index.row() < 0 || index.row() >= rowCount() || column < 0 || column >= roles_.size()) return {};
  return rows_[static_cast<std::size_t>(index.row())].value(column);
}

QHash<int, QByteArray> RowModel::roleNames() const {
  QHash<int, QByteArray> names;
  for (int i = 0; i < roles_.size(); ++i) names.insert(Qt::UserRole + i, roles_[i]);
  return names;
}

}  // namespace adit::gui
