// SPDX-License-Identifier: Apache-2.0
// The tab of all cameras: what is asked of the station, and how each state looks.
#include "tests/gui/camera_fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// The window with its tab of cameras open: so many of the ten robots have a camera.
class CamerasTab : public CameraWindow {
 protected:
  void open_tab(int cameras = 4, const station::NetworkReport& net = {}) {
    world = ten_robots();
    if (!net.sender) world.link.clear();
    for (int i = 0; i < cameras; ++i) at(i).cameras = {{.name = "front"}};
    show(world);
    open("cameras");
    answer(answer_of(net), "net");
    settle_layout();
  }
  station::Robot& at(int robot) { return world.robots[static_cast<std::size_t>(robot)]; }
  static station::NetworkReport net_of(const std::string& link, double bandwidth) {
    station::NetworkReport net = network_of_ten();
    net.sender = station::SenderReport{.link = link, .bandwidth = bandwidth};
    for (station::LinkReport& report : net.links) {
      report.sender = net.sender;
      report.age = 0.1;
    }
    for (station::AgentTraffic& agent : net.agents) agent.total_out = 600.0F, agent.classes_out.clear();
    return net;
  }
  /// The newest request for pictures of each robot.
  std::map<std::string, station::CameraRequest> wanted() {
    settle();
    std::map<std::string, station::CameraRequest> out;
    for (const FakeSink::AskedCamera& asked : sink.cameras) out[asked.request.robot] = asked.request;
    return out;
  }
  bool is_asked(const std::string& robot) {
    return QTest::qWaitFor([&] { return wanted().contains(robot); }, 10'000);
  }
  /// Answers the request of that robot with a picture.
  void picture_of(const std::string& robot, std::uint64_t number, double age = 0.2) {
    ASSERT_TRUE(is_asked(robot)) << robot;
    const auto found = std::ranges::find_if(
        sink.cameras, [&](const FakeSink::AskedCamera& asked) { return asked.request.robot == robot; });
    const auto done = std::move(found->done);
    sink.cameras.erase(found);
    const auto hue = static_cast<std::uint8_t>(60 + 17 * robot.back() % 120);
    done(outcome_of(corridor(hue, 120), number, age, {}, robot));
    settle();
  }
  QString word(const QString& tile) { return text("cameraWord_" + tile); }
  QString note(const QString& tile) { return text("cameraNote_" + tile); }

  station::World world{};
};

TEST_F(CamerasTab, OneIsSharpAndTheOthersAreThumbnails) {
  open_tab();
  ASSERT_TRUE(is_asked("r4"));
  auto all = wanted();
  ASSERT_EQ(all.size(), 4U);
  EXPECT_GT(all["r1"].width, 300) << "its full size";
  EXPECT_FLOAT_EQ(all["r1"].rate, 15.0F);
  for (const char* robot : {"r2", "r3", "r4"}) {
    EXPECT_LE(all[robot].width, 160) << robot;
    EXPECT_LE(all[robot].rate, 2.0F) << robot;
  }
  EXPECT_EQ(text("cameraSummary"), "3 thumbnails, 2 pictures/s each");
  EXPECT_EQ(text("camerasWithout"), "no camera: r5 r6 r7 r8 r9 rx");
}

TEST_F(CamerasTab, ATapOrAnArrowKeyOrTheSelectionMakesACameraTheSharpOne) {
  open_tab();
  touch(middle("cameraChoose_r3_front"));
  sink.cameras.clear();
  ASSERT_TRUE(QTest::qWaitFor([&] { return control.cameras()->sharp().first == "r3"; }));
  EXPECT_THAT(control.selection(), IsEmpty()) << "commands go to the same robots as before";
  QTest::keyClick(window(), Qt::Key_Right);
  EXPECT_EQ(control.cameras()->sharp().first, "r4");
  QTest::keyClick(window(), Qt::Key_Right);
  EXPECT_EQ(control.cameras()->sharp().first, "r1") << "the first after the last";
  QTest::keyClick(window(), Qt::Key_Left);
  EXPECT_EQ(control.cameras()->sharp().first, "r4");
  QTest::keyClick(window(), Qt::Key_2);
  EXPECT_EQ(control.cameras()->sharp().first, "r2");
  QTest::keyClick(window(), Qt::Key_9);
  EXPECT_EQ(control.cameras()->sharp().first, "r2") << "r9 has no camera";
}

TEST_F(CamerasTab, AClosedTabAsksForNothing) {
  open_tab();
  ASSERT_TRUE(is_asked("r4"));
  open("log");
  const auto late = std::exchange(sink.cameras, {});
  const auto queries = sink.queries.size();
  for (const FakeSink::AskedCamera& asked : late) asked.done(outcome_of(corridor(170, 30), 9));
  QTest::qWait(1300);
  EXPECT_THAT(sink.cameras, IsEmpty());
  EXPECT_EQ(sink.queries.size(), queries) << "nor for the network";
}

TEST_F(CamerasTab, ThumbnailsOutOfSightAskForNothing) {
  open_tab(1);
  at(4).lost = false;
  for (int i = 1; i < 10; ++i) at(i).cameras = {{.name = "front"}, {.name = "rear"}, {.name = "left"}};
  show(world);
  settle_layout();
  const auto why = [&](std::size_t place) { return control.cameras()->plan().cameras.at(place).why; };
  ASSERT_TRUE(is_asked("r2"));
  EXPECT_EQ(why(27), "out of sight");
  item("cameraTiles")->setProperty("contentY", 1e4);
  ASSERT_TRUE(QMetaObject::invokeMethod(item("cameraTiles"), "returnToBounds"));
  EXPECT_TRUE(QTest::qWaitFor([&] { return why(27) != "out of sight"; }, 10'000));
  EXPECT_EQ(why(1), "out of sight");
  EXPECT_EQ(why(0), "") << "the large one";
  QTest::keyClick(window(), Qt::Key_Right);
  EXPECT_TRUE(QTest::qWaitFor([&] { return why(0) == "out of sight"; }, 10'000));
}

TEST_F(CamerasTab, EachStateHasItsWord) {
  station::NetworkReport net = net_of("mesh_500k", 5e5);
  net.agents[4].total_out = 80'000.0F;  // r4 has no room.
  open_tab(7, net);
  at(0).cameras[0].on = at(1).cameras[0].on = true;
  at(0).cameras[0].bytes = 9'800.0F;
  at(1).cameras[0].bytes = 420.0F;
  show(world);
  picture_of("r1", 5);
  picture_of("r2", 6);
  picture_of("r3", 7, 42.0);
  settle_layout();
  touch(middle("cameraOff_r6_front"));
  settle();
  EXPECT_THAT(sink.lines, ElementsAre("camera r6 off front"));
  ASSERT_TRUE(QTest::qWaitFor([&] { return word("r3_front") == "OLD"; }, 10'000));
  EXPECT_EQ(word("sharp"), "live");
  EXPECT_EQ(word("r1_front"), "large");
  EXPECT_EQ(word("r2_front"), "live");
  EXPECT_EQ(word("r4_front"), "refused");
  EXPECT_EQ(note("r4_front"), "link of r4: mesh_500k leaves 0 kbit/s");
  EXPECT_EQ(word("r5_front"), "lost");
  EXPECT_EQ(word("r6_front"), "off");
  EXPECT_EQ(word("r7_front"), "waiting");
  EXPECT_EQ(note("r7_front"), "waits for a picture");
  EXPECT_EQ(text("cameraLoad_sharp"), "78.4 kbit/s");
  EXPECT_EQ(text("cameraLoad_r2_front"), "3.4 kbit/s");
  EXPECT_TRUE(text("cameraAge_sharp").endsWith("s old")) << text("cameraAge_sharp").toStdString();
  for (FakeSink::AskedCamera& asked : std::exchange(sink.cameras, {})) asked.done({});
  const auto all = wanted();
  for (const char* robot : {"r4", "r5", "r6"}) EXPECT_FALSE(all.contains(robot)) << robot;
  picture("cameras");
  Theme::instance().set_light(true);
  picture("cameras_light");
  Theme::instance().set_light(false);
  window()->resize(1920, 1080);
  settle_layout();
  picture("cameras_1080");
}

TEST_F(CamerasTab, OnAndOffAreTheCommandOfTheStation) {
  open_tab();
  touch(middle("cameraOff_r2_front"));
  settle_layout();
  touch(middle("cameraOn_r2_front"));
  EXPECT_THAT(sink.lines, ElementsAre("camera r2 off front"));
  EXPECT_EQ(word("r2_front"), "waiting");
  control.add_command({.id = 1, .ended = true, .line = "camera r3 off"});
  settle();
  EXPECT_EQ(word("r3_front"), "off") << "another front end did it";
  control.add_command({.id = 2, .ended = true, .line = "camera r4 off front", .exit_code = 1});
  settle();
  EXPECT_EQ(word("r4_front"), "waiting") << "it was refused";
  touch(middle("cameraOff_r4_front"));
  control.add_command({.id = 3, .ended = true, .line = "camera r4 off front", .exit_code = 5});
  settle();
  EXPECT_EQ(word("r4_front"), "waiting") << "it still sends";
  at(1).cameras[0].kept_on = true;
  show(world);
  EXPECT_EQ(text("count_cameras"), "1") << "what is on costs the link, also while the tab is closed";
}

TEST_F(CamerasTab, TenCamerasOnAThinLinkLeaveItToTheSharpOne) {
  open_tab(9, net_of("mesh_100k", 100e3));
  at(9).cameras = {{.name = "front"}};
  at(4).lost = false;
  show(world);
  ASSERT_TRUE(is_asked("rx"));
  for (FakeSink::AskedCamera& asked : std::exchange(sink.cameras, {})) asked.done({});
  ASSERT_TRUE(QTest::qWaitFor([&] { return wanted().size() == 10U; }, 10'000));
  const auto all = wanted();
  EXPECT_EQ(all.size(), 10U) << "one request for each camera at a time";
  EXPECT_EQ(sink.cameras.size(), 10U);
  double bits = 0.0;
  for (const auto& [robot, request] : all) {
    if (robot == "r1") continue;
    EXPECT_LE(request.width, 80) << robot;
    bits += request.rate * 8000.0;
  }
  EXPECT_LE(bits, 0.25 * 29e3 + 1.0);
  EXPECT_EQ(text("cameraSummary"),
            "mesh_100k leaves 29 kbit/s for pictures, 7 kbit/s of it for thumbnails: 9 thumbnails, each "
            "every 10 s");
  picture("cameras_thin");
}

TEST_F(CamerasTab, WhatWaitsKeepsItsPictureAndSaysWhy) {
  open_tab(8, net_of("radio", 30e3));
  ASSERT_TRUE(is_asked("r2"));
  picture_of("r2", 6);
  EXPECT_EQ(note("r8_front"), "waits for its turn: radio leaves 2 kbit/s");
  EXPECT_FALSE(wanted().contains("r8"));
  station::NetworkReport less = net_of("radio", 12e3);
  ASSERT_TRUE(is_asked("r3"));
  picture_of("r3", 7);
  answer(answer_of(less), "net");
  EXPECT_EQ(word("r3_front"), "queued");
  QTest::qWait(50);
  EXPECT_FALSE(qobject_cast<CameraItem*>(item("camera_r3_front"))->is_empty());
  picture("cameras_turns");
}

TEST_F(CamerasTab, WithoutACameraItSaysWhereTheyAreNamed) {
  open_tab(0);
  EXPECT_TRUE(text("noCameras").startsWith("no camera: no robot has one")) << text("noCameras").toStdString();
  EXPECT_THAT(sink.cameras, IsEmpty());
  QTest::keyClick(window(), Qt::Key_Right);
  picture("cameras_none");
}

TEST_F(CamerasTab, TheWordsOfTheStationAreShown) {
  open_tab();
  ASSERT_TRUE(is_asked("r2"));
  for (FakeSink::AskedCamera& asked : std::exchange(sink.cameras, {}))
    asked.done({.exit_code = 1, .error = "more than 16 cameras at once\n"});
  EXPECT_TRUE(QTest::qWaitFor([&] { return note("r2_front") == "more than 16 cameras at once"; }, 10'000));
}

}  // namespace
}  // namespace adit::gui
