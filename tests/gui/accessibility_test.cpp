// SPDX-License-Identifier: Apache-2.0
// Whatever can be touched or typed into has a name and a role for assistive programs and is large enough for
// a finger, and no text is cut off at 1280x720, in every state of the window.
#include <QAccessible>
#include <algorithm>
#include <set>

#include "basestation/gui/scene/stick_area.hpp"
#include "tests/gui/fake_drive.hpp"
#include "tests/gui/tabs_fixture.hpp"

namespace adit::gui {
namespace {

constexpr double kTargetMm = 12.0;  // For a finger without a glove.
constexpr double kLowTargetMm = 7.5;
constexpr double kRounding = 0.5;  // Pixels.

/// Targets in panels and rows, which are opened on purpose and where a miss does no harm, may be lower: by
/// the names of their items, or the part before `_`.
const std::set<QString> kLow{
    "show",         "moreNeeds",    "commandToggle", "detailsToggle", "notNow",          "commandRun",
    "commandClose", "commandField", "proposal",      "cure",          "closeDetails",    "fitAll",
    "solidToggle",  "cutToggle",    "followToggle",  "areaToggle",    "zoomIn",          "zoomOut",
    "logWarnings",  "logSelected",  "logExport",     "logTextInput",  "receptionToggle", "hearingToggle",
    "see",          "later",        "markToggle",    "headingToggle", "cameraOn",        "cameraOff"};
/// Texts that may be cut off: they are whole in another place, which is beside them.
const std::map<QString, QString> kCut{{"budget", "the command net, with all that was not sent"}};

QString group_of(const QString& name) { return name.section('_', 0, 0); }

class Accessibility : public TabsTest {
 protected:
  static bool shown(const QQuickItem* item) {
    for (; item; item = item->parentItem())
      if (!item->isVisible() || item->opacity() <= 0.0) return false;
    return true;
  }
  static bool touchable(const QQuickItem* item) {
    return item->isEnabled() &&
           (qobject_cast<const PressArea*>(item) || qobject_cast<const StickArea*>(item) ||
            qobject_cast<const GestureArea*>(item) || item->inherits("QQuickTextInput"));
  }
  static QString name_of(const QQuickItem* item) {
    for (; item; item = item->parentItem())
      if (!item->objectName().isEmpty()) return item->objectName();
    return "?";
  }
  void walk(QQuickItem* item, const char* state) {
    if (!shown(item) || item->width() <= 0.0 || item->height() <= 0.0) {
      if (!item->isVisible()) return;
    } else if (touchable(item)) {
      check_target(item, state);
    } else if (item->property("truncated").toBool() && item->inherits("QQuickText")) {
      check_text(item, state);
    }
    for (QQuickItem* child : item->childItems()) walk(child, state);
  }
  void check_target(QQuickItem* item, const char* state) {
    const QString name = name_of(item);
    if (!seen.insert({state, name}).second) return;
    QAccessibleInterface* access = QAccessible::queryAccessibleInterface(item);
    ASSERT_NE(access, nullptr) << state << ": " << name.toStdString();
    EXPECT_FALSE(access->text(QAccessible::Name).trimmed().isEmpty())
        << state << ": " << name.toStdString() << " has no name";
    EXPECT_TRUE(access->role() != QAccessible::NoRole && access->role() != QAccessible::Client)
        << state << ": " << name.toStdString() << " has no role";
    const bool low = kLow.contains(group_of(name));
    const double least = (low ? kLowTargetMm : kTargetMm) * Theme::instance().mm() - kRounding;
    // A text field is touched with the frame around it.
    const QQuickItem* target = item->inherits("QQuickTextInput") ? item->parentItem() : item;
    EXPECT_GE(target->height(), least) << state << ": " << name.toStdString() << " is low";
    EXPECT_GE(target->width(), least) << state << ": " << name.toStdString() << " is narrow";
    if (low && target->height() < kTargetMm * Theme::instance().mm() - kRounding) used.insert(group_of(name));
  }
  void check_text(QQuickItem* item, const char* state) {
    const QString name = name_of(item);
    EXPECT_TRUE(kCut.contains(name)) << state << ": the text '"
                                     << item->property("text").toString().toStdString() << "' of "
                                     << name.toStdString() << " is cut off";
  }
  void walk(const char* state) {
    settle_layout();
    walk(window()->contentItem(), state);
    picture(QString("access_") + state);
  }

  std::set<std::pair<QString, QString>> seen{};
  std::set<QString> used{};
};

TEST_F(Accessibility, EveryTargetHasANameAndARoleAndIsLargeEnoughAndNoTextIsCutOff) {
  FakeDrive drive_sink;
  station::World driven = ten_robots();
  driven.robots[0].mode = "smart_joystick";
  drive_sink.show(driven);
  control.drive()->use(drive_sink, [] { return [] { return station::input::Gamepad::State{}; }; });
  walk("nothing selected");
  control.select("r1", false);
  walk("one selected");
  control.select("r3", true);
  control.set_reasons_open(true);
  walk("reasons");
  control.set_reasons_open(false);
  control.attention()->set_open(true);
  walk("attention");
  control.attention()->set_open(false);
  control.details()->set_open(true);
  walk("details of two");
  control.select("r8", false);
  walk("details of one");
  control.details()->set_open(false);
  control.command_line()->set_open(true);
  walk("command line");
  control.command_line()->set_open(false);
  control.mark()->choose({6, 1}, std::nullopt);
  walk("mark");
  control.mark()->drop();
  control.set_solid(true);
  walk("three dimensions");
  control.set_solid(false);
  for (const char* tab : {"health", "network", "findings", "stairs", "cameras", "settings", "log"}) {
    TabsTest::open(tab);
    if (std::string(tab) == "health") {
      control.tabs()->choose("r4", "planner");
      answer(answer_of(health_of_ten()));
    }
    if (std::string(tab) == "network") answer(answer_of(network_of_ten()));
    if (std::string(tab) == "findings") answer(answer_of(some_findings()));
    if (std::string(tab) == "stairs") answer(answer_of(some_stairs()));
    if (std::string(tab) == "cameras") {
      show(robots_with_cameras());
      control.cameras()->switchOn("r2", "front", false);
      answer(answer_of(network_of_ten()), "net");
    }
    walk(tab);
  }
  station::FoundReport found = some_findings();
  found.findings[0].photo =
      station::FoundPhoto{station::PhotoHere::thumbnail, 40, 90'000, "00000000000000a2"};
  TabsTest::open("findings");
  answer(answer_of(found));
  control.tabs()->photos()->show(2);
  walk("photo");
  control.tabs()->photos()->close();
  control.tabs()->close();
  control.select("r1", false);
  control.drive()->begin("r1");
  ASSERT_TRUE(QTest::qWaitFor([&] { return control.drive()->driving(); }));
  walk("driving");
  control.drive()->stop_using();
  EXPECT_GT(seen.size(), 150U);
  for (const QString& name : kLow)
    EXPECT_TRUE(used.contains(name)) << name.toStdString() << " needs no exception any more";
}

}  // namespace
}  // namespace adit::gui
