// SPDX-License-Identifier: Apache-2.0
// What a test does with the window: find items, touch, click, take pictures.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QGuiApplication>
#include <QPointingDevice>
#include <QQuickItem>
#include <QQuickWindow>
#include <QtTest/QTest>
#include <memory>
#include <string>
#include <vector>

#include "basestation/gui/bridge/control.hpp"
#include "basestation/gui/items.hpp"
#include "basestation/gui/scene/map_view.hpp"
#include "basestation/gui/scene/press_area.hpp"
#include "basestation/gui/scene/theme.hpp"
#include "basestation/gui/window.hpp"

namespace adit::gui {

inline std::vector<std::string> warnings;  // NOLINT: Qt's handler takes no context.

inline void collect(QtMsgType type, const QMessageLogContext&, const QString& text) {
  if (type != QtDebugMsg && type != QtInfoMsg) warnings.push_back(text.toStdString());
}

/// A window without a screen, and a finger. Every warning of Qt or QML is a failure.
class Fingers : public testing::Test {
 protected:
  Fingers() {
    warnings.clear();
    Theme::instance().set_light(false);
  }
  ~Fingers() override { EXPECT_THAT(warnings, testing::IsEmpty()) << "warnings of Qt and QML"; }

  /// Shows the window of that control.
  void open(Control& control, WindowKind kind = WindowKind::main) {
    operator_window = std::make_unique<OperatorWindow>(control, kind);
    if (window()) {
      window()->resize(1280, 720);
      window()->show();
      EXPECT_TRUE(QTest::qWaitForWindowExposed(window()));
    }
    settle();
  }
  QQuickWindow* window() { return operator_window->window(); }
  void settle() { QTest::qWait(20); }
  void settle_layout() { QTest::qWait(PressArea::kSettle + 50); }

  QQuickItem* item(const QString& name) {
    QQuickItem* found = nullptr;
    const auto find = [&] { return (found = find_item(window(), name)) != nullptr; };
    (void)QTest::qWaitFor(find, 30'000);  // Lists make their items when they are laid out.
    EXPECT_NE(found, nullptr) << name.toStdString();
    return found;
  }
  QPoint middle(const QString& name) {
    QQuickItem* found = item(name);
    return found ? found->mapToScene({found->width() / 2, found->height() / 2}).toPoint() : QPoint();
  }
  QString text(const QString& name) { return item(name)->property("text").toString(); }
  MapView& map() { return *static_cast<MapView*>(item("map")); }
  QPoint on_map(double x, double y) {
    const Point at = map().camera().to_screen(x, y);
    return map().mapToScene({at.x, at.y}).toPoint();
  }
  void click(const QPoint& at, Qt::KeyboardModifiers modifiers = {}) {
    QTest::mouseClick(window(), Qt::LeftButton, modifiers, at);
    settle();
  }
  void finger_down(const QPoint& at) { QTest::touchEvent(window(), finger).press(0, at, window()); }
  void finger_up(const QPoint& at) { QTest::touchEvent(window(), finger).release(0, at, window()); }
  void touch(const QPoint& at) {
    finger_down(at);
    finger_up(at);
    settle();
  }
  void drag(const QPoint& from, const QPoint& to) {
    finger_down(from);
    for (int i = 1; i <= 4; ++i)
      QTest::touchEvent(window(), finger).move(0, from + (to - from) * i / 4, window());
    finger_up(to);
    settle();
  }
  void press_slot(const QString& slot) {
    settle_layout();
    touch(middle("button_" + slot));
  }
  /// Saves the window if the tests run to make pictures (tools/screenshots.sh); those of docs/gui have its
  /// names. `grey`: without colours.
  void picture(const QString& name, bool grey = false) {
    const QByteArray folder = qgetenv("ADIT_GUI_PICTURES");
    if (folder.isEmpty()) return;
    settle();
    QImage image = window()->grabWindow();
    if (grey) image = image.convertToFormat(QImage::Format_Grayscale8);
    EXPECT_TRUE(image.save(QString::fromUtf8(folder) + "/" + name + ".png"));
  }

  QPointingDevice* finger{QTest::createTouchDevice()};
  std::unique_ptr<OperatorWindow> operator_window{};
};

}  // namespace adit::gui
