// SPDX-License-Identifier: Apache-2.0
// How the pictures of the grid of cameras share a link, without Qt.
#include "basestation/gui/bridge/camera_plan.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace adit::gui {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// So many robots with a camera each on a link of that bandwidth, bit/s; 0: it is not limited.
struct Site {
  explicit Site(int robots, double bandwidth = 0.0, std::string link = "mesh_100k") {
    for (int i = 1; i <= robots; ++i) {
      station::Robot robot;
      robot.name = "r" + std::to_string(i);
      robot.cameras = {{.name = "front"}};
      world.robots.push_back(robot);
      net.links.push_back({.agent = robot.name});
      if (bandwidth > 0.0)
        net.links.back().sender = station::SenderReport{.link = link, .bandwidth = bandwidth};
      net.agents.push_back({.agent = robot.name, .total_out = 500.0F});
    }
    if (bandwidth > 0.0) net.sender = station::SenderReport{.link = link, .bandwidth = bandwidth};
  }
  CameraPlan plan(std::size_t turn = 0) const {
    return camera_plan({.world = &world, .net = &net, .sharp = sharp, .off = off, .turn = turn});
  }
  static std::vector<std::string> robots_of(const CameraPlan& plan, CameraRole role) {
    std::vector<std::string> out;
    for (const PlannedCamera& camera : plan.cameras)
      if (camera.role == role) out.push_back(camera.name.first);
    return out;
  }

  station::World world{};
  station::NetworkReport net{};
  CameraName sharp{"r1", "front"};
  std::set<CameraName> off{};
};

/// What the thumbnails of a plan cost at most, bit/s.
double thumbnail_bits(const CameraPlan& plan) {
  double sum = 0.0;
  for (const PlannedCamera& camera : plan.cameras)
    if (camera.role == CameraRole::thumbnail) sum += camera.rate * (camera.width > 80 ? 8 * 3200 : 8 * 1000);
  return sum;
}

TEST(CameraPlan, ThumbnailsOutOfSightTakeNoTurn) {
  Site site(20, 30e3, "radio");
  const std::multiset<CameraName> in_sight{{"r1", "front"}, {"r18", "front"}, {"r20", "front"}};
  const CameraPlan plan = camera_plan(
      {.world = &site.world, .net = &site.net, .sharp = site.sharp, .off = {}, .in_sight = &in_sight});
  EXPECT_THAT(Site::robots_of(plan, CameraRole::sharp), ElementsAre("r1"));
  EXPECT_THAT(Site::robots_of(plan, CameraRole::thumbnail), ElementsAre("r18", "r20"));
  EXPECT_EQ(plan.cameras[1].role, CameraRole::waits);
  EXPECT_EQ(plan.cameras[1].why, "out of sight");
}

TEST(CameraPlan, OneIsSharpAndTheOthersAreThumbnails) {
  const CameraPlan plan = Site(3).plan();
  ASSERT_EQ(plan.cameras.size(), 3U);
  EXPECT_EQ(plan.cameras[0].role, CameraRole::sharp);
  EXPECT_EQ(plan.cameras[0].width, 0) << "as wide as it is shown";
  EXPECT_FLOAT_EQ(plan.cameras[0].rate, 15.0F);
  EXPECT_EQ(plan.cameras[1].role, CameraRole::thumbnail);
  EXPECT_EQ(plan.cameras[1].width, 160);
  EXPECT_FLOAT_EQ(plan.cameras[1].rate, 2.0F);
  EXPECT_EQ(plan.summary, "2 thumbnails, 2 pictures/s each");
}

TEST(CameraPlan, TenCamerasOnAThinLinkLeaveThreeQuartersToTheSharpOne) {
  const CameraPlan plan = Site(10, 100e3).plan();
  EXPECT_EQ(plan.cameras[0].role, CameraRole::sharp);
  EXPECT_EQ(Site::robots_of(plan, CameraRole::thumbnail).size(), 9U);
  EXPECT_LE(thumbnail_bits(plan), 0.25 * 29e3 + 1e-3);
  for (std::size_t i = 1; i < plan.cameras.size(); ++i) EXPECT_EQ(plan.cameras[i].width, 80);
  EXPECT_EQ(plan.summary,
            "mesh_100k leaves 29 kbit/s for pictures, 7 kbit/s of it for thumbnails: 9 thumbnails, each "
            "every 10 s");
}

TEST(CameraPlan, ThumbnailsOfALimitedLinkWaitForItsReport) {
  Site site(3);
  site.world.link = "mesh_100k";
  const CameraPlan plan = site.plan();
  EXPECT_EQ(plan.cameras[0].role, CameraRole::sharp);
  EXPECT_EQ(plan.cameras[1].role, CameraRole::waits);
  EXPECT_EQ(plan.cameras[1].why, "waits for the report of mesh_100k");
}

TEST(CameraPlan, WhatDoesNotFitTakesTurns) {
  const Site site(13, 50e3, "radio");
  const CameraPlan first = site.plan(0), second = site.plan(1), third = site.plan(2);
  EXPECT_THAT(Site::robots_of(first, CameraRole::thumbnail), ElementsAre("r2", "r3", "r4", "r5"));
  EXPECT_THAT(Site::robots_of(second, CameraRole::thumbnail), ElementsAre("r6", "r7", "r8", "r9"));
  EXPECT_THAT(Site::robots_of(third, CameraRole::thumbnail), ElementsAre("r10", "r11", "r12", "r13"));
  EXPECT_EQ(first.cameras[9].role, CameraRole::waits);
  EXPECT_EQ(first.cameras[9].why, "waits for its turn: radio leaves 4 kbit/s");
  EXPECT_THAT(first.summary, HasSubstr("8 wait for their turn"));
}

TEST(CameraPlan, RequestsAreBounded) {
  const Site site(60);
  const CameraPlan plan = site.plan(3);
  EXPECT_EQ(Site::robots_of(plan, CameraRole::thumbnail).size(), kMaxInTurns);
  EXPECT_EQ(Site::robots_of(plan, CameraRole::sharp).size(), 1U);
  EXPECT_EQ(Site::robots_of(plan, CameraRole::waits).size(), 53U);
  EXPECT_EQ(Site::robots_of(Site(13).plan(), CameraRole::thumbnail).size(), kMaxThumbnails) << "all of them";
  // The station looks at 16 cameras at most, and holds those of a turn for some seconds.
  for (std::size_t turn = 0; turn < 20; ++turn) {
    std::set<std::string> held{"of the details", "of the drive"};
    for (const std::size_t each : {turn, turn + 1})
      for (const PlannedCamera& camera : site.plan(each).cameras)
        if (camera.rate > 0.0F) held.insert(camera.name.first);
    EXPECT_LE(held.size(), 16U) << "turn " << turn;
  }
}

TEST(CameraPlan, ALinkWithoutRoomRefusesAndIsNamed) {
  Site site(3, 100e3);
  site.net.agents[1].total_out = 12'500.0F;  // All of the bandwidth, and no pictures.
  const CameraPlan plan = site.plan();
  EXPECT_EQ(plan.cameras[1].role, CameraRole::refused);
  EXPECT_EQ(plan.cameras[1].why, "link of r2: mesh_100k leaves 0 kbit/s");
  EXPECT_EQ(plan.cameras[2].role, CameraRole::thumbnail);
  site.net.agents[1].classes_out = {{"video", 3'600.0}};
  EXPECT_EQ(site.plan().cameras[1].role, CameraRole::thumbnail) << "what takes the room are pictures";
  site.net.agents[0].total_out = 20'000.0F;
  EXPECT_EQ(site.plan().cameras[0].role, CameraRole::refused) << "the sharp one, too";
}

TEST(CameraPlan, ALinkForOnePictureRefusesThumbnails) {
  const CameraPlan plan = Site(3, 8e3, "tiny").plan();
  EXPECT_EQ(plan.cameras[0].role, CameraRole::sharp);
  EXPECT_EQ(plan.cameras[1].role, CameraRole::refused);
  EXPECT_EQ(plan.cameras[1].why, "tiny leaves 1 kbit/s for thumbnails");
}

TEST(CameraPlan, TheSharpCameraHasALimitedLinkOfItsRobotAlone) {
  Site site(2, 500e3, "mesh_500k");
  site.world.robots[0].cameras.push_back({.name = "back"});
  const CameraPlan plan = site.plan();
  EXPECT_EQ(plan.cameras[1].role, CameraRole::waits);
  EXPECT_EQ(plan.cameras[1].why, "r1 sends the large picture");
  EXPECT_EQ(plan.cameras[2].role, CameraRole::thumbnail);
  site.off = {{"r1", "front"}};
  EXPECT_EQ(site.plan().cameras[1].role, CameraRole::thumbnail) << "the sharp one is off";
  site.off.clear();
  site.net = {};
  EXPECT_EQ(site.plan().cameras[1].role, CameraRole::thumbnail) << "the link has room for both";
}

TEST(CameraPlan, TheLinkOfADrivenRobotIsLeftToTheDriversPicture) {
  Site site(3, 500e3, "mesh_500k");
  site.world.robots[1].mode = "smart_joystick";
  EXPECT_EQ(site.plan().cameras[1].role, CameraRole::waits);
  EXPECT_EQ(site.plan().cameras[2].role, CameraRole::thumbnail);
  site.world.robots[1].mode = "waypoint";
  EXPECT_EQ(site.plan().cameras[1].role, CameraRole::thumbnail);
}

TEST(CameraPlan, WhatIsOffOrLostOrHasNoCameraIsNotAskedFor) {
  Site site(4);
  site.off = {{"r1", "front"}, {"r2", "front"}};
  site.world.robots[2].lost = true;
  site.world.robots[3].cameras.clear();
  const CameraPlan plan = site.plan();
  EXPECT_THAT(Site::robots_of(plan, CameraRole::off), ElementsAre("r1", "r2"));
  EXPECT_TRUE(plan.cameras[0].sharp);
  EXPECT_THAT(Site::robots_of(plan, CameraRole::lost), ElementsAre("r3"));
  EXPECT_EQ(plan.cameras[2].why, "r3 is lost");
  EXPECT_THAT(plan.without, ElementsAre("r4"));
  for (const PlannedCamera& camera : plan.cameras) EXPECT_EQ(camera.rate, 0.0F);
}

}  // namespace
}  // namespace adit::gui
