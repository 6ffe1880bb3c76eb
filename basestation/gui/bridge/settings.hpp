// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <QString>

#include "basestation/gui/bridge/settings_file.hpp"

namespace adit::gui {

/// The operator's settings of the window: stores those of the Theme in a file at each change.
class WindowSettings : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("a part of the tabs")
  Q_PROPERTY(double scale READ scale WRITE set_scale NOTIFY changed)
  Q_PROPERTY(bool isDefault READ is_default NOTIFY changed)
  Q_PROPERTY(QString file READ file NOTIFY changed)

 public:
  explicit WindowSettings(QObject* parent);

  /// Reads the file, and stores changes in it from now on. Before, nothing is stored. `light`: the light
  /// theme whatever the file says, until it is changed.
  void open(const QString& file, bool light = false);
  /// $XDG_CONFIG_HOME/adit/gui.yaml, or ~/.config/adit/gui.yaml.
  static QString default_file();

  double scale() const;
  void set_scale(double scale);
  bool is_default() const { return values() == SettingsValues{}; }
  /// The buttons of the game controller, as the file was opened.
  const station::input::PadMapping& pad() const { return pad_; }
  const QString& file() const { return file_; }
  Q_INVOKABLE void restoreDefaults();

 signals:
  void changed();
  void remark(const QString& text);  ///< For the log.

 private:
  static SettingsValues values();
  static void apply(const SettingsValues& values);
  SettingsRead read();
  /// Writes what changed here since the file was read or written, or all: another window may have stored the
  /// rest.
  void store(bool all = false);

  QString file_{};
  station::input::PadMapping pad_{};
  SettingsValues known_{};  ///< As they were when the file was read or written.
  bool applying_{false};
};

}  // namespace adit::gui
