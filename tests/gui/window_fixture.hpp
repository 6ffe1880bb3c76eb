// SPDX-License-Identifier: Apache-2.0
// The whole window on Qt's software renderer, without a screen: fingers and keys come from QTest, commands
// end in a fake.
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
#include "basestation/gui/scene/map_view.hpp"
#include "basestation/gui/scene/press_area.hpp"
#include "basestation/gui/scene/theme.hpp"
#include "basestation/gui/window.hpp"
#include "tests/gui/fixture.hpp"

namespace adit::gui {

inline std::vector<std::string> warnings;  // NOLINT: Qt's handler takes no context.

inline void collect(QtMsgType type, const QMessageLogContext&, const QString& text) {
  if (type != QtDebugMsg && type != QtInfoMsg) warnings.push_back(text.toStdString());
}

class FakeSink : public CommandSink {
 public:
  void execute(const std::string& line, Done done) override {
    lines.push_back(line);
    pending.push_back(std::move(done));
  }
  void query(const std::string& line, Done done) override {
    queries.push_back(line);
    asked.push_back(std::move(done));
  }
  void stop(const std::vector<std::string>& robots, Done done) override {
    std::string line = "STOP";
    for (const std::string& robot : robots) line += " " + robot;
    execute(line, std::move(done));
  }
  void start_station() override { ++starts; }

  std::vector<std::string> lines{};
  std::vector<Done> pending{};
  std::vector<std::string> queries{};
  std::vector<Done> asked{};
  int starts{};
};

class Window : public testing::Test {
 protected:
  Window() {
    warnings.clear();
    Theme::instance().set_light(false);
    show(ten_robots());
    control.show_map(std::make_shared<station::TileMap>(corridors()));
    operator_window = std::make_unique<OperatorWindow>(control);
    if (window()) {
      window()->resize(1280, 720);
      window()->show();
      EXPECT_TRUE(QTest::qWaitForWindowExposed(window()));
    }
    settle();
  }
  ~Window() override { EXPECT_THAT(warnings, testing::IsEmpty()) << "warnings of Qt and QML"; }

  QQuickWindow* window() { return operator_window->window(); }
  void show(const station::World& world) {
    control.show(std::make_shared<station::World>(world), now += 0.2);
  }
  void settle() { QTest::qWait(20); }
  void settle_layout() { QTest::qWait(PressArea::kSettle + 50); }

  QQuickItem* item(const QString& name) {
    auto* found = window()->contentItem()->findChild<QQuickItem*>(name);
    // Delegates have no parent object but a parent item.
    if (!found) found = below(window()->contentItem(), name);
    EXPECT_NE(found, nullptr) << name.toStdString();
    return found;
  }
  static QQuickItem* below(QQuickItem* top, const QString& name) {
    for (QQuickItem* child : top->childItems()) {
      if (child->objectName() == name) return child;
      if (QQuickItem* found = below(child, name)) return found;
    }
    return nullptr;
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
  void press_slot(const QString& slot) {
    settle_layout();
    touch(middle("button_" + slot));
  }
  void picture(const QString& name) {
    const QByteArray folder = qgetenv("ADIT_GUI_PICTURES");
    if (folder.isEmpty()) return;
    settle();
    EXPECT_TRUE(window()->grabWindow().save(QString::fromUtf8(folder) + "/" + name + ".png"));
  }

  QPointingDevice* finger{QTest::createTouchDevice()};
  FakeSink sink{};
  Control control{sink};
  double now{100.0};
  std::unique_ptr<OperatorWindow> operator_window{};
};

}  // namespace adit::gui
