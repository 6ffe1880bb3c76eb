// SPDX-License-Identifier: Apache-2.0
// The program adit_gui and a real station, without robots and without a screen.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QGuiApplication>
#include <QImage>
#include <QtTest/QTest>
#include <cstdlib>

#include "basestation/gui/bridge/control.hpp"
#include "basestation/gui/bridge/qt_station.hpp"
#include "tests/folders/folders.hpp"
#include "tests/live/process.hpp"

namespace adit::gui {
namespace {

using live::Finished;
using live::Seconds;
using testing::HasSubstr;

class Program : public testing::Test {
 protected:
  ~Program() override {
    live::run({"basestation", "--name", "op1", "--domain", domain(), "down", "--leave"},
              folder_.environment());
  }
  static std::string domain() { return std::to_string(live::domain()); }
  Finished run(std::vector<std::string> words,
               std::map<std::string, std::string> more = {{"QT_QPA_PLATFORM", "offscreen"},
                                                          {"QT_QUICK_BACKEND", "software"}}) {
    std::map<std::string, std::string> environment = folder_.environment();
    environment.insert(more.begin(), more.end());
    words.insert(words.begin(), {"adit_gui", "--domain", domain()});
    return live::run(words, environment, Seconds(30));
  }
  /// Whether it comes true while the window runs.
  static bool soon(const std::function<bool()>& holds) {
    return QTest::qWaitFor(holds, static_cast<int>(15'000 * live::patience()));
  }
  std::string file(const std::string& name) const {
    return folder_.environment().at("XDG_RUNTIME_DIR") + "/" + name;
  }

  live::Folder folder_{};
};

TEST_F(Program, HelpHasExamples) {
  const Finished help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("--screenshot"));
  EXPECT_THAT(help.out, HasSubstr("adit_gui --name op2"));
}

TEST_F(Program, ASecondWindowShowsTheMapOfTheSameStation) {
  EXPECT_EQ(run({"--screenshot", file("main.png"), "--after", "0.5"}).exit_code, 0);
  const Finished ended =
      run({"--window", "map", "--screenshot", file("map.png"), "--after", "0.5", "--size", "1000x600"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(QImage(QString::fromStdString(file("map.png"))).size(), QSize(1000, 600));
}

TEST_F(Program, WrongOptionsSayWhatIsRightAndExitTwo) {
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"--nonsense"},
                                             {"--size", "big"},
                                             {"--size", "10x10"},
                                             {"--window", "log"},
                                             {"--name", "a b"},
                                             {"--domain", "900"},
                                             {"--link", "no_such_link", "--screenshot", file("a.png")}}) {
    const Finished ended = run(wrong);
    EXPECT_EQ(ended.exit_code, 2) << wrong[0] << ": " << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("adit_gui: "));
  }
}

TEST_F(Program, WithoutAScreenItSaysWhatToDo) {
  const Finished ended = run({}, {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}, {"QT_QPA_PLATFORM", ""}});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.err, HasSubstr("QT_QPA_PLATFORM=offscreen"));
}

TEST_F(Program, StartsItsStationAndWritesAPicture) {
  const Finished ended = run({"--screenshot", file("window.png"), "--after", "0.5", "--size", "1000x600"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(QImage(QString::fromStdString(file("window.png"))).size(), QSize(1000, 600));
  const Finished list = live::run({"basestation", "--domain", domain(), "list"}, folder_.environment());
  EXPECT_EQ(list.exit_code, 0) << "the station stays: " << list.err;
  EXPECT_EQ(run({"--screenshot", file("no/such/folder.png"), "--after", "0.1"}).exit_code, 1);
}

TEST_F(Program, CommandsGoToTheStationAndTheirOutcomesCome) {
  for (const auto& [name, value] : folder_.environment()) ::setenv(name.c_str(), value.c_str(), 1);
  station::client::StationOptions options;
  options.domain = static_cast<std::uint32_t>(live::domain());
  options.program = program_folder() + "/basestation";
  auto opened = station::client::Station::open(options, "adit_gui");
  ASSERT_TRUE(opened) << opened.error().text;
  QtStation qt_station(std::move(*opened));
  Control control(qt_station);
  qt_station.show_in(control);
  ASSERT_TRUE(soon([&] { return control.operator_name() == "op1"; }));
  std::string text;
  qt_station.execute("take r9", [&](const station::CommandOutcome& outcome) { text = outcome.error; });
  ASSERT_TRUE(soon([&] { return !text.empty(); }));
  EXPECT_THAT(text, HasSubstr("r9"));
  control.stopAll();
  ASSERT_TRUE(soon([&] { return control.outcome_kind() != "sent"; })) << control.outcome().toStdString();
  // When the station ends, the window says so and can start it again.
  live::run({"basestation", "--domain", domain(), "down", "--leave"}, folder_.environment());
  ASSERT_TRUE(soon([&] { return control.ended(); }));
  EXPECT_TRUE(control.silent_text().startsWith("NO STATION"));
  control.restartStation();
  ASSERT_TRUE(soon([&] { return !control.ended() && !control.silent(); }))
      << control.silent_text().toStdString();
}

}  // namespace
}  // namespace adit::gui
