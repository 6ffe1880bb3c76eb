// SPDX-License-Identifier: Apache-2.0
// The film of the demo (./run demo --gui --film): an operator's window, worked by a finger that the film
// shows. The other operator's lines are played beside it (config/scenarios/film.yaml).
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "basestation/client/station.hpp"
// Qt's keywords are macros, so its headers come after those of others.
#include <QGuiApplication>
#include <QPointingDevice>
#include <QtTest/QTest>

#include "basestation/gui/bridge/control.hpp"
#include "basestation/gui/bridge/qt_station.hpp"
#include "basestation/gui/film/camera_man.hpp"
#include "basestation/gui/items.hpp"
#include "basestation/gui/scene/map_view.hpp"
#include "basestation/gui/scene/press_area.hpp"
#include "basestation/gui/window.hpp"

namespace adit::gui::film {
namespace {

/// Plays the operator of the film.
class Actor {
 public:
  Actor(Control& control, QQuickWindow& window, CameraMan& camera)
      : control_(control), window_(window), camera_(camera) {}

  void say(const QString& caption, int ms = 0) {
    caption_ = caption;
    camera_.set_caption(caption);
    QTest::qWait(ms);
  }
  void touch(const QString& name, int ms = 150) { press(place_of(name), ms); }
  /// Presses where the map shows that place, m, until the goal is shown.
  void send(double x, double y) {
    auto* map = static_cast<MapView*>(find_item(&window_, "map"));
    const Point at = map->camera().to_screen(x, y);
    press(map->mapToScene({at.x, at.y}).toPoint(), 900);
  }
  void button(const char* slot, int ms = 150) { touch(QString("button_") + slot, ms); }
  void key(Qt::Key key) { QTest::keyClick(&window_, key); }
  const station::Robot* robot(const char* name) const { return control_.world().robot(name); }
  /// Holds a finger beside the middle of an item.
  void hold(const QString& name, const QPoint& beside, int ms) {
    if (const QPoint at = place_of(name); !at.isNull()) press(at + beside, ms);
  }
  /// Waits until it is true. If it does not come true, the film goes on, and is a failure.
  void until(const std::function<bool()>& holds, int ms = 15'000) {
    if (QTest::qWaitFor(holds, ms)) return;
    failed_ = true;
    std::fprintf(stderr, "film: what is expected after \"%s\" did not come\n", qPrintable(caption_));
  }
  bool failed() const { return failed_; }

 private:
  QPoint place_of(const QString& name) {
    QQuickItem* item = nullptr;
    (void)QTest::qWaitFor([&] { return (item = find_item(&window_, name)) != nullptr; }, 3000);
    if (!item) {
      failed_ = true;
      std::fprintf(stderr, "film: the window has no %s\n", qPrintable(name));
    }
    return item ? item->mapToScene({item->width() / 2, item->height() / 2}).toPoint() : QPoint();
  }
  void press(const QPoint& at, int ms) {
    if (at.isNull()) return;
    QTest::qWait(PressArea::kSettle + 50);
    camera_.set_finger(at);
    QTest::qWait(250);
    QTest::touchEvent(&window_, finger_).press(0, at, &window_);
    QTest::qWait(ms);
    QTest::touchEvent(&window_, finger_).release(0, at, &window_);
    QTest::qWait(250);
    camera_.set_finger(std::nullopt);
  }

  Control& control_;
  QQuickWindow& window_;
  CameraMan& camera_;
  QString caption_{};
  bool failed_{false};
  QPointingDevice* finger_{QTest::createTouchDevice()};
};

/// The operator's part, about 80 s.
void play(Actor& actor) {
  const auto robot = [&](const char* name) {
    return actor.robot(name) ? *actor.robot(name) : station::Robot{};
  };
  actor.say("The window of operator op1. Two robots are free; op2 drives r3.", 2500);
  actor.say("Tap a robot, take it: from now on r1 obeys op1.");
  actor.touch("card_r1");
  actor.button("take");
  actor.until([&] { return robot("r1").mine; });
  actor.say("Press on the map: r1 finds its way there by itself.");
  actor.send(2.4, -0.3);
  actor.say("The same with r2, which op1 also locks.");
  actor.touch("card_r2");
  actor.button("take");
  actor.until([&] { return robot("r2").mine; });
  actor.button("lock");
  actor.send(10.2, -0.4);
  actor.say("The robots map what they see. The same map in three dimensions:");
  actor.touch("solidToggle");
  QTest::qWait(4500);
  actor.touch("solidToggle");
  actor.say("r3 is locked by op2: what is not possible now says why.");
  actor.touch("card_r3");
  actor.touch("notNow");
  QTest::qWait(3500);
  actor.touch("notNow");
  actor.say("op2 stops r1, as every operator may. The line at the top says so.");
  actor.until([&] { return robot("r1").stopped; }, 30'000);
  QTest::qWait(2000);
  actor.say("A tap there shows r1. Its holder clears the stop by holding Reset;");
  actor.key(Qt::Key_Tab);
  actor.button("reset", 1000);
  actor.until([&] { return !robot("r1").stopped; });
  actor.say("that moves nothing. Waypoint: r1 goes on to its goal.");
  actor.button("mode_waypoint");
  QTest::qWait(2500);
  actor.say("A goal inside a wall is refused, with the reason.");
  actor.send(-2.5, 1.5);
  QTest::qWait(3500);
  actor.say("Driving by hand: r1 moves only while a finger holds the stick.");
  actor.button("drive");
  actor.hold("touchStick", {0, -45}, 3500);
  QTest::qWait(800);
  actor.key(Qt::Key_Escape);
  actor.send(-3.0, -0.1);
  QTest::qWait(1500);
  actor.say("SOFTWARE STOP ALL acts as soon as the finger is down, on every robot.");
  actor.touch("stopAll");
  QTest::qWait(4000);
}

int fail(const std::string& text) {
  std::fprintf(stderr, "film: %s\n", text.c_str());
  return 1;
}

int shoot(const station::client::StationOptions& options, const QString& file) {
  auto opened = station::client::Station::open(options, "adit_gui");
  if (!opened) return fail(opened.error().text);
  QtStation qt_station(std::move(*opened));
  Control control(qt_station);
  qt_station.show_in(control);
  control.drive()->use(qt_station, [] { return [] { return station::input::Gamepad::State{}; }; });
  const OperatorWindow operator_window(control);
  QQuickWindow* window = operator_window.window();
  if (!window) return fail("the window's files could not be loaded, see above");
  window->resize(1280, 720);
  window->show();
  if (!QTest::qWaitFor([&] { return control.robot_count() >= 3; }, 20'000))
    return fail("not all robots are heard");
  CameraMan camera(*window, file);
  if (!camera.failure().isEmpty()) return fail(camera.failure().toStdString());
  Actor actor(control, *window, camera);
  play(actor);
  if (!camera.finish()) return fail("ffmpeg could not write " + file.toStdString());
  std::printf("film: %.0f s\n", static_cast<double>(camera.frames()) / CameraMan::kFramesPerSecond);
  return actor.failed() ? 1 : 0;
}

}  // namespace
}  // namespace adit::gui::film

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: gui_film OPERATOR DOMAIN FILE.mp4\n");
    return 2;
  }
  if (qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM")) qputenv("QT_QPA_PLATFORM", "offscreen");
  qputenv("QT_QUICK_BACKEND", "software");
  const QGuiApplication app(argc, argv);
  adit::station::client::StationOptions options;
  options.name = argv[1];
  options.domain = static_cast<unsigned>(std::atoi(argv[2]));
  return adit::gui::film::shoot(options, argv[3]);
}
