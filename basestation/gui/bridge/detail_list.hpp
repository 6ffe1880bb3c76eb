// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <vector>

#include "basestation/gui/bridge/details.hpp"
#include "basestation/gui/bridge/row_model.hpp"

namespace adit::gui {

class Control;

/// The details of the selected robots, for QML.
class DetailList : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("part of Control")
  Q_PROPERTY(QAbstractItemModel* rows READ rows CONSTANT)
  Q_PROPERTY(bool open READ is_open WRITE set_open NOTIFY open_changed)

 public:
  explicit DetailList(Control& control);

  /// Reads them again, if they are open.
  void refresh();
  const std::vector<Detail>& details() const { return details_; }
  /// Runs the order of a row; `held`: by press and hold.
  Q_INVOKABLE void act(int row, bool held);

  QAbstractItemModel* rows() { return &rows_; }
  bool is_open() const { return open_; }
  void set_open(bool open);

 signals:
  void open_changed();

 private:
  Control& control_;
  std::vector<Detail> details_{};
  RowModel rows_;
  bool open_{false};
};

}  // namespace adit::gui
