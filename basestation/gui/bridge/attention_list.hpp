// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <vector>

#include "basestation/gui/bridge/attention.hpp"
#include "basestation/gui/bridge/row_model.hpp"

namespace adit::gui {

class Control;

/// The list of what needs the operator, for QML: its rows, and the actions of each.
class AttentionList : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("part of Control")
  Q_PROPERTY(QAbstractItemModel* rows READ rows CONSTANT)
  /// The first rows, for a place that is never scrolled.
  Q_PROPERTY(QAbstractItemModel* top READ top CONSTANT)
  Q_PROPERTY(int count READ count NOTIFY changed)
  Q_PROPERTY(QString quiet READ quiet NOTIFY changed)
  Q_PROPERTY(bool open READ is_open WRITE set_open NOTIFY open_changed)

 public:
  static constexpr std::size_t kTop = 4;

  explicit AttentionList(Control& control);

  /// Returns its priority.
  station::Priority add(const station::Notice& notice);
  void refresh();
  const std::vector<Need>& needs() const { return needs_; }

  /// Selects the robots of a row and brings them into the middle of the map.
  Q_INVOKABLE void show(const QString& id);
  /// The operator has seen it, and knows it from now on.
  Q_INVOKABLE void see(const QString& id);
  /// Hides it for five minutes.
  Q_INVOKABLE void later(const QString& id);
  /// Hands the robot to the operator who asked; `held`: by press and hold.
  Q_INVOKABLE void grant(const QString& id, bool held);
  /// Shows the next row after the one that was shown last.
  void show_next();

  QAbstractItemModel* rows() { return &rows_; }
  QAbstractItemModel* top() { return &top_; }
  int count() const { return static_cast<int>(needs_.size()); }
  /// What to say if nothing needs the operator.
  QString quiet() const;
  bool is_open() const { return open_ && !needs_.empty(); }
  void set_open(bool open);

 signals:
  void changed();
  void open_changed();

 private:
  const Need* find(const QString& id) const;

  Control& control_;
  station::AlertQueue queue_{};
  std::vector<Need> needs_{};
  RowModel rows_, top_;
  QString last_shown_{};
  bool open_{false};
};

}  // namespace adit::gui
