// SPDX-License-Identifier: Apache-2.0
// The settings of the window, and every tab in every size.
#include <QDir>
#include <QFile>
#include <QTemporaryDir>

#include "tests/gui/tabs_fixture.hpp"

namespace adit::gui {
namespace {

using testing::IsEmpty;

class SettingsTest : public TabsTest {
 protected:
  ~SettingsTest() override {
    Theme::instance().set_light(false);
    Theme::instance().set_glove(false);
    Theme::instance().set_scale(1.0);
  }
  QString file() const { return folder_.path() + "/adit/gui.yaml"; }
  static QByteArray content(const QString& name) {
    QFile in(name);
    return in.open(QIODevice::ReadOnly) ? in.readAll() : QByteArray();
  }
  void write(const QByteArray& text) {
    QDir().mkpath(folder_.path() + "/adit");
    QFile out(file());
    ASSERT_TRUE(out.open(QIODevice::WriteOnly));
    out.write(text);
  }
  QString log() const {
    QString out;
    const RowModel& rows = *static_cast<RowModel*>(control_.log());
    for (const QVariantList& row : rows.rows()) out += row[4].toString() + "\n";
    return out;
  }

  QTemporaryDir folder_{};
  Control& control_{control};
};

TEST_F(SettingsTest, EachChangeActsAtOnceAndIsStored) {
  control.tabs()->settings()->open(file());
  open("settings");
  settle_layout();
  const double before = item("button_mode_hold")->height();
  touch(middle("theme"));
  EXPECT_TRUE(Theme::instance().light());
  EXPECT_TRUE(content(file()).contains("theme: light"));
  touch(middle("larger"));
  settle();
  EXPECT_EQ(text("scale"), "105 %");
  EXPECT_TRUE(content(file()).contains("scale: 1.05"));
  touch(middle("glove"));
  settle();
  EXPECT_NEAR(item("button_mode_hold")->height(), before * 1.05 * 20 / 13, 0.5);
  EXPECT_TRUE(content(file()).contains("glove_mode: true"));
  control.tabs()->settings()->restoreDefaults();
  EXPECT_EQ(Theme::instance().light(), false);
  EXPECT_NEAR(item("button_mode_hold")->height(), before, 0.01);
  EXPECT_TRUE(content(file()).contains("theme: dark"));
  EXPECT_THAT(sink.lines, IsEmpty());
}

TEST_F(SettingsTest, AWrongFileIsNamedInTheLogAndPreserved) {
  write("theme: light\nscael: 2\n");
  control.tabs()->settings()->open(file());
  EXPECT_TRUE(Theme::instance().light());
  EXPECT_TRUE(log().contains("line 2: unknown setting 'scael', did you mean scale?")) << log().toStdString();
  EXPECT_TRUE(content(file()).contains("scael")) << "reading changes nothing";
  Theme::instance().set_glove(true);
  EXPECT_TRUE(content(file() + ".bad").contains("scael"));
  EXPECT_TRUE(content(file()).contains("theme: light"));
}

TEST_F(SettingsTest, WhatAnotherWindowStoredSurvivesAChange) {
  write("theme: dark\nscale: 1.1\n");
  WindowSettings& settings = *control.tabs()->settings();
  settings.open(file());
  write("theme: dark\nglove_mode: true\nscale: 1.5\npad:\n  dead_man: righttrigger\n");
  Theme::instance().set_light(true);
  const SettingsRead stored = read_settings(content(file()).toStdString());
  EXPECT_EQ(stored.values, (SettingsValues{.light = true, .glove = true, .scale = 1.5}));
  EXPECT_EQ(name_of(stored.pad.of(station::input::PadAction::dead_man)), "righttrigger");
  settings.restoreDefaults();
  EXPECT_EQ(read_settings(content(file()).toStdString()).values, SettingsValues{});
}

TEST_F(SettingsTest, ButtonsOfTheControllerAreReadAndSurviveAChange) {
  using station::input::PadAction;
  write("theme: light\npad:\n  dead_man: righttrigger\n  forward: -lefty\n  fast: none\n");
  WindowSettings& settings = *control.tabs()->settings();
  settings.open(file());
  EXPECT_EQ(log(), "");
  EXPECT_EQ(name_of(settings.pad().of(PadAction::dead_man)), "righttrigger");
  EXPECT_EQ(name_of(settings.pad().of(PadAction::forward)), "-lefty");
  Theme::instance().set_glove(true);
  EXPECT_EQ(read_settings(content(file()).toStdString()).pad, settings.pad());
}

TEST(SettingsFile, WrongButtonsOfTheControllerAreNamedWithTheirLines) {
  using station::input::PadAction;
  const SettingsRead read = read_settings(
      "pad:\n  stop: leftsholder\n  dead_mam: a\n  turn: b\n  stop_all: none\n  take: [1]\n  drive: back\n");
  EXPECT_THAT(read.problems,
              testing::ElementsAre("line 2: no button or axis 'leftsholder', did you mean leftshoulder?",
                                   "line 3: unknown action of the pad 'dead_mam', did you mean dead_man?",
                                   "line 4: turn is an axis, not the button b",
                                   "line 5: stop_all needs a button", "line 6: no button or axis 'a list'",
                                   "line 7: back is stop_all already: drive is none"));
  station::input::PadMapping usual;
  EXPECT_TRUE(usual.set(PadAction::drive, "none"));
  EXPECT_EQ(read.pad, usual) << "the rest is as usual";
  EXPECT_THAT(read_settings("pad: 3\n").problems,
              testing::ElementsAre("line 1: pad has lines 'action: button'"));
  EXPECT_THAT(read_settings("pad:\n").problems, IsEmpty());
}

TEST_F(SettingsTest, AFileThatCannotBeWrittenIsSaid) {
  control.tabs()->settings()->open("/proc/no/such/gui.yaml");
  Theme::instance().set_light(true);
  EXPECT_TRUE(Theme::instance().light());
  EXPECT_TRUE(log().contains("settings are not stored"));
}

TEST_F(SettingsTest, EveryTabFitsInEverySize) {
  struct Look {
    const char* name;
    QSize size;
    double scale;
    bool glove, light;
  };
  for (const Look& look :
       {Look{"dark_720", {1280, 720}, 1.0, false, false}, Look{"light_720", {1280, 720}, 1.0, false, true},
        Look{"dark_1080", {1920, 1080}, 1.0, false, false},
        Look{"light_1080", {1920, 1080}, 1.0, false, true}, Look{"large_720", {1280, 720}, 2.0, false, false},
        Look{"glove_720", {1280, 720}, 1.0, true, false}}) {
    window()->resize(look.size);
    Theme::instance().set_light(look.light);
    Theme::instance().set_scale(look.scale);
    Theme::instance().set_glove(look.glove);
    for (const char* tab : {"health", "network", "findings", "stairs", "cameras", "settings", "log"}) {
      open(tab);
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
      picture(QString("tab_") + tab + "_" + look.name);
      QQuickItem* panel = item("panel");
      EXPECT_GE(panel->mapToScene({0, 0}).y(), 0.0) << tab << look.name;
      EXPECT_LE(panel->mapToScene({0, panel->height()}).y(), item("button_stop")->mapToScene({0, 0}).y());
      EXPECT_LE(item("tab_settings")->mapToScene({0, item("tab_settings")->height()}).y(),
                look.size.height() + 0.5);
      EXPECT_LT(item("stopAll")->mapToScene({0, 0}).y(), 20.0);
    }
  }
}

}  // namespace
}  // namespace adit::gui
