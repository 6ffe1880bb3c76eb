// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QAbstractListModel>
#include <QVariantList>
#include <string>
#include <vector>

namespace adit::gui {

inline QString text_of(const std::string& text) { return QString::fromStdString(text); }

/// Sets a member of an item; returns whether its value changed, so that QML is to be notified.
template <class T>
bool assign(T& member, const T& value) {
  if (member == value) return false;
  member = value;
  return true;
}

/// A list of rows for QML. Each row has one value per role, in their order; the first role identifies the
/// row. Rows that stay keep their items, so that a finger on one of them is not lost.
class RowModel : public QAbstractListModel {
  Q_OBJECT

 public:
  RowModel(QList<QByteArray> roles, QObject* parent) : QAbstractListModel(parent), roles_(std::move(roles)) {}

  /// Replaces the rows, changing as little as possible.
  void show(std::vector<QVariantList> rows);
  /// Puts a row first and drops the last ones beyond `limit`.
  void prepend(QVariantList row, std::size_t limit);
  const std::vector<QVariantList>& rows() const { return rows_; }

  int rowCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QHash<int, QByteArray> roleNames() const override;

 private:
  void remove(std::size_t row);

  QList<QByteArray> roles_{};
  std::vector<QVariantList> rows_{};
};

}  // namespace adit::gui
