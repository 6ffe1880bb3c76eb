// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <QQmlEngine>
#include <QQuickWindow>
#include <cstdint>
#include <memory>

namespace adit::gui {

class Control;

/// Which window the program shows.
enum class WindowKind : std::uint8_t {
  main,
  map,  ///< The map and the cameras, for a second screen; its control gives no orders.
};

/// The operator's window: the files of qml/ with a control, which outlives it.
class OperatorWindow {
 public:
  explicit OperatorWindow(Control& control, WindowKind kind = WindowKind::main);
  /// Null if the files could not be loaded; the reasons are in the log of QML.
  QQuickWindow* window() const { return window_.get(); }

 private:
  QQmlEngine engine_{};
  std::unique_ptr<QQuickWindow> window_{};
};

}  // namespace adit::gui
