// SPDX-License-Identifier: Apache-2.0
// No sequence of keys, touches and focus changes leaves a key dead or a robot driving.
#include <QTouchEvent>
#include <array>
#include <set>

#include "core/time/random.hpp"
#include "tests/gui/fake_drive.hpp"
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;

/// A key as X11 and Wayland report it: its place, and the characters that it has without and with Shift.
struct KeyPlace {
  int scan{};
  int plain{};
  int shifted{};
};
constexpr int kShiftScan = 50, kAltGrScan = 108;
constexpr std::array kPlaces{
    KeyPlace{10, Qt::Key_1, Qt::Key_Exclam},      KeyPlace{11, Qt::Key_2, Qt::Key_At},
    KeyPlace{12, Qt::Key_3, Qt::Key_NumberSign},  KeyPlace{24, Qt::Key_Q, Qt::Key_Q},
    KeyPlace{25, Qt::Key_W, Qt::Key_W},           KeyPlace{26, Qt::Key_E, Qt::Key_E},
    KeyPlace{28, Qt::Key_T, Qt::Key_T},           KeyPlace{31, Qt::Key_I, Qt::Key_I},
    KeyPlace{38, Qt::Key_A, Qt::Key_A},           KeyPlace{39, Qt::Key_S, Qt::Key_S},
    KeyPlace{40, Qt::Key_D, Qt::Key_D},           KeyPlace{42, Qt::Key_G, Qt::Key_G},
    KeyPlace{43, Qt::Key_H, Qt::Key_H},           KeyPlace{47, Qt::Key_Semicolon, Qt::Key_Colon},
    KeyPlace{53, Qt::Key_X, Qt::Key_X},           KeyPlace{55, Qt::Key_V, Qt::Key_V},
    KeyPlace{58, Qt::Key_M, Qt::Key_M},           KeyPlace{9, Qt::Key_Escape, Qt::Key_Escape},
    KeyPlace{36, Qt::Key_Return, Qt::Key_Return}, KeyPlace{65, Qt::Key_Space, Qt::Key_Space},
    KeyPlace{111, Qt::Key_Up, Qt::Key_Up},        KeyPlace{116, Qt::Key_Down, Qt::Key_Down},
    KeyPlace{113, Qt::Key_Left, Qt::Key_Left},    KeyPlace{112, Qt::Key_PageUp, Qt::Key_PageUp},
    KeyPlace{69, Qt::Key_F3, Qt::Key_F3}};

const KeyPlace& place_of(int key) {
  return *std::find_if(kPlaces.begin(), kPlaces.end(), [key](const KeyPlace& at) { return at.plain == key; });
}

/// The window with a keyboard, a finger and another window that takes the focus.
class KeysWindow : public Window {
 protected:
  KeysWindow() {
    station::World world = ten_robots();
    for (station::Robot& robot : world.robots)
      if (robot.mine) robot.mode = "smart_joystick", robot.goal_state = contract::GoalState::none;
    world.robots[1].stopped = false;
    world.robots[1].stops.clear();
    drive_sink.show(world);
    control.drive()->use(drive_sink, [] { return [] { return station::input::Gamepad::State{}; }; });
    elsewhere.resize(100, 100);
  }
  ~KeysWindow() override {
    control.drive()->stop_using();
    operator_window.reset();
  }

  bool moves() const {
    const station::StickVelocity stick = drive_sink.last();
    return stick.vx != 0.0 || stick.vy != 0.0 || stick.wz != 0.0;
  }
  static bool soon(const std::function<bool()>& holds) { return QTest::qWaitFor(holds, 30'000); }

  Qt::KeyboardModifiers modifiers() const {
    return (down.contains(kShiftScan) ? Qt::ShiftModifier : Qt::NoModifier) |
           (down.contains(kAltGrScan) ? Qt::GroupSwitchModifier : Qt::NoModifier);
  }
  /// A key at another level than its first is another character, also when it is released.
  int key_at(int scan) const {
    if (scan == kShiftScan) return Qt::Key_Shift;
    if (scan == kAltGrScan) return Qt::Key_AltGr;
    const KeyPlace& found = *std::find_if(kPlaces.begin(), kPlaces.end(),
                                          [scan](const KeyPlace& place) { return place.scan == scan; });
    if (down.contains(kAltGrScan) && found.plain < Qt::Key_Escape) return 0x100 + scan;
    return down.contains(kShiftScan) ? found.shifted : found.plain;
  }
  void send(QEvent::Type type, int scan, bool repeated) {
    if (!focused) return;  // It goes to the other window.
    const int key = key_at(scan);
    const QString text = key > 0x20 && key < 0x80 ? QString(QChar(key)).toLower() : QString();
    QKeyEvent event(type, key, modifiers(), static_cast<quint32>(scan_codes ? scan : 0), 0, 0, text,
                    repeated);
    QCoreApplication::sendEvent(window(), &event);
  }
  void press(int scan) {
    send(QEvent::KeyPress, scan, false);
    down.insert(scan);
    last = scan;
  }
  void release(int scan) {
    down.erase(scan);
    send(QEvent::KeyRelease, scan, false);
  }
  void repeat() {
    if (!down.contains(last)) return;
    send(QEvent::KeyRelease, last, true);
    send(QEvent::KeyPress, last, true);
  }
  void tap(int key) {
    press(place_of(key).scan);
    release(place_of(key).scan);
  }

  void leave() {
    elsewhere.show();
    elsewhere.requestActivate();
    ASSERT_TRUE(soon([&] { return !window()->isActive(); }));
    focused = false;
    EXPECT_TRUE(soon([&] { return !moves(); })) << "the window has no focus";
  }
  void come_back() {
    EXPECT_FALSE(moves()) << "the window has no focus";
    window()->requestActivate();
    ASSERT_TRUE(soon([&] { return window()->isActive(); }));
    elsewhere.hide();
    focused = true;
  }

  void finger_event(Random& random) {
    const int kind = static_cast<int>(random.uniform() * 4);
    if (!touching) {
      const std::array<const char*, 4> items{"map", "card_r1", "commandToggle", "button_take"};
      const bool stick = control.drive()->driving() && kind > 0;
      finger_at =
          stick ? middle("touchStick") - QPoint(0, 40) : middle(items[static_cast<std::size_t>(kind)]);
      finger_down(finger_at);
      touching = true;
    } else if (kind == 0) {
      QTouchEvent cancelled(QEvent::TouchCancel, finger);
      QCoreApplication::sendEvent(window(), &cancelled);
      lift();
    } else if (kind == 1) {
      QTest::touchEvent(window(), finger).move(0, finger_at += QPoint(9, 3), window());
    } else {
      lift();
    }
  }
  void lift() {
    if (touching) finger_up(finger_at);
    touching = false;
  }

  void step(Random& random) {
    const double what = random.uniform();
    if (what < 0.1) return focused ? leave() : come_back();
    if (what < 0.2) return finger_event(random);
    if (what < 0.3) return repeat();
    if (what < 0.35) return control.command_line()->set_open(!control.command_line()->is_open());
    if (what < 0.6 && !down.empty()) {
      const auto which = static_cast<std::ptrdiff_t>(random.uniform() * static_cast<double>(down.size()));
      return release(*std::next(down.begin(), which));
    }
    const auto which = static_cast<std::size_t>(random.uniform() * (kPlaces.size() + 4));
    const int scan = which < kPlaces.size()        ? kPlaces[which].scan
                     : which == kPlaces.size() + 3 ? kAltGrScan
                                                   : kShiftScan;
    if (!down.contains(scan)) press(scan);
  }

  /// Everything is released, the window has the focus, and what was opened is closed.
  void let_go_of_all() {
    while (!down.empty()) release(*down.begin());
    lift();
    if (!focused) come_back();
    EXPECT_TRUE(soon([&] { return !moves(); })) << "all is released";
    control.command_line()->set_open(false);
    control.drive()->letGo();
    ASSERT_TRUE(soon([&] { return !control.drive()->driving(); }));
    control.tabs()->close();
    control.set_aiming(false);
    control.area()->set_active(false);
    settle();
  }

  void expect_every_key_works() {
    control.select("r1", false);
    tap(Qt::Key_2);
    EXPECT_THAT(control.selection(), ElementsAre("r2"));
    tap(Qt::Key_Up);
    EXPECT_THAT(control.selection(), ElementsAre("r1"));
    const bool solid = control.solid(), details = control.details()->is_open();
    tap(Qt::Key_V);
    EXPECT_NE(control.solid(), solid);
    tap(Qt::Key_V);
    tap(Qt::Key_I);
    EXPECT_NE(control.details()->is_open(), details);
    tap(Qt::Key_G);
    EXPECT_TRUE(control.aiming());
    tap(Qt::Key_Escape);
    EXPECT_FALSE(control.aiming());
    sink.lines.clear();
    tap(Qt::Key_H);
    tap(Qt::Key_W);
    EXPECT_THAT(sink.lines, ElementsAre("mode r1 hold", "mode r1 waypoint"));
    tap(Qt::Key_M);
    EXPECT_TRUE(soon([&] { return control.drive()->driving(); }));
    press(place_of(Qt::Key_W).scan);
    EXPECT_TRUE(soon([&] { return moves(); }));
    release(place_of(Qt::Key_W).scan);
    EXPECT_TRUE(soon([&] { return !moves(); }));
    tap(Qt::Key_Escape);
    EXPECT_TRUE(soon([&] { return !control.drive()->driving(); }));
    press(kShiftScan);
    tap(Qt::Key_Semicolon);
    release(kShiftScan);
    EXPECT_TRUE(control.command_line()->is_open());
    tap(Qt::Key_Escape);
    EXPECT_FALSE(control.command_line()->is_open());
  }

  std::set<int> down{};
  int last{};
  bool focused{true}, touching{false};
  bool scan_codes{true};  ///< Whether the platform has them; VNC has none.
  QPoint finger_at{};
  QWindow elsewhere{};
  FakeDrive drive_sink{};
};

TEST_F(KeysWindow, EveryKeyWorks) { expect_every_key_works(); }

TEST_F(KeysWindow, AColonAndEscapeLeaveNoKeyDead) {
  press(kShiftScan);
  press(place_of(Qt::Key_Semicolon).scan);
  release(kShiftScan);  // The colon is released as a semicolon, while the line has the keys.
  release(place_of(Qt::Key_Semicolon).scan);
  tap(Qt::Key_Escape);
  let_go_of_all();
  expect_every_key_works();
}

TEST_F(KeysWindow, AShiftThatIsReleasedBeforeItsDigitLeavesNoKeyDead) {
  press(kShiftScan);
  press(place_of(Qt::Key_2).scan);
  release(kShiftScan);
  release(place_of(Qt::Key_2).scan);
  EXPECT_THAT(control.selection(), ElementsAre("r2")) << "Shift and the place of 2 add r2";
  expect_every_key_works();
}

TEST_F(KeysWindow, AKeyThatIsReleasedAsAnotherCharacterDrivesNoFurther) {
  control.select("r1", false);
  tap(Qt::Key_M);
  ASSERT_TRUE(soon([&] { return control.drive()->driving(); }));
  press(place_of(Qt::Key_Q).scan);
  press(place_of(Qt::Key_W).scan);
  ASSERT_TRUE(soon([&] { return moves(); }));
  press(kAltGrScan);
  release(place_of(Qt::Key_Q).scan);
  release(place_of(Qt::Key_W).scan);
  EXPECT_TRUE(soon([&] { return !moves(); }));
}

TEST_F(KeysWindow, AKeyThatIsReleasedAsAnotherCharacterDrivesNoFurtherWithoutScanCodes) {
  scan_codes = false;
  control.select("r1", false);
  tap(Qt::Key_M);
  ASSERT_TRUE(soon([&] { return control.drive()->driving(); }));
  press(place_of(Qt::Key_W).scan);
  ASSERT_TRUE(soon([&] { return moves(); }));
  press(kShiftScan);
  release(kShiftScan);
  EXPECT_TRUE(moves()) << "Shift alone lets go of no key";
  press(kAltGrScan);
  release(place_of(Qt::Key_W).scan);
  EXPECT_TRUE(soon([&] { return !moves(); }));
}

TEST_F(KeysWindow, ALineThatIsOpenedWhileAKeyDrivesIsZero) {
  control.select("r1", false);
  tap(Qt::Key_M);
  ASSERT_TRUE(soon([&] { return control.drive()->driving(); }));
  press(place_of(Qt::Key_W).scan);
  ASSERT_TRUE(soon([&] { return moves(); }));
  control.command_line()->set_open(true);
  EXPECT_TRUE(soon([&] { return !moves(); })) << "the line has the keys now";
}

TEST_F(KeysWindow, AFingerOnTheStickDrivesNoFurtherWithoutTheFocus) {
  control.select("r1", false);
  tap(Qt::Key_M);
  ASSERT_TRUE(soon([&] { return control.drive()->driving(); }));
  finger_down(middle("touchStick") - QPoint(0, 40));
  ASSERT_TRUE(soon([&] { return moves(); }));
  leave();
  come_back();
  EXPECT_FALSE(QTest::qWaitFor([&] { return moves(); }, 100)) << "let go once, then drive on";
  finger_up(middle("touchStick"));
}

TEST_F(KeysWindow, NoSequenceLeavesAKeyDeadOrARobotDriving) {
  for (std::uint64_t seed = 1; seed <= 80 && !HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    scan_codes = seed <= 40;
    Random random(seed);
    control.select("r1", false);
    if (seed % 2 == 0) tap(Qt::Key_M);
    for (int i = 0; i < 40; ++i) step(random);
    let_go_of_all();
    expect_every_key_works();
  }
}

}  // namespace
}  // namespace adit::gui
