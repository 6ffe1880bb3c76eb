// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <string>
#include <vector>

#include "basestation/gui/bridge/row_model.hpp"

namespace adit::gui {

/// The lines of the log that the operator wants to see. While he has scrolled away from the newest line, new
/// ones are counted and wait, so that nothing moves under his eyes.
class LogView : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("a part of the tabs")
  Q_PROPERTY(QAbstractItemModel* lines READ lines CONSTANT)
  Q_PROPERTY(QString text READ text WRITE set_text NOTIFY changed)
  Q_PROPERTY(bool warnings READ warnings WRITE set_warnings NOTIFY changed)
  Q_PROPERTY(bool selected READ selected WRITE set_selected NOTIFY changed)
  Q_PROPERTY(bool paused READ paused WRITE set_paused NOTIFY changed)
  Q_PROPERTY(int waiting READ waiting NOTIFY changed)

 public:
  /// `all`: every line, with the roles row, time, kind, who and line; the newest first.
  explicit LogView(RowModel& all, QObject* parent);

  QAbstractItemModel* lines() { return &shown_; }
  const QString& text() const { return text_; }
  void set_text(const QString& text);
  bool warnings() const { return warnings_; }
  void set_warnings(bool only);
  bool selected() const { return selected_; }
  void set_selected(bool only);
  bool paused() const { return paused_; }
  void set_paused(bool paused);
  int waiting() const { return waiting_; }
  /// The robots that `selected` shows.
  void set_selection(const std::vector<std::string>& selection);
  /// All lines that the filters let through, the oldest first, for a file.
  QString as_text() const;

 signals:
  void changed();

 private:
  bool passes(const QVariantList& row) const;
  void added();
  void show();

  RowModel& all_;
  RowModel shown_;
  QString text_{};
  QStringList selection_{};
  bool warnings_{false}, selected_{false}, paused_{false};
  int waiting_{0};
};

}  // namespace adit::gui
