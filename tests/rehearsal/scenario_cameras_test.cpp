// SPDX-License-Identifier: Apache-2.0
// The cameras of a scenario's robots, and the faults of cameras.
#include <gtest/gtest.h>

#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace adit::sim {
namespace {

/// A scenario whose robot r1 has these keys, in line 7; r2 has none. `fault`: in line 10.
Result<Scenario> with_cameras(const std::string& keys, const std::string& fault = "crash: r1") {
  return parse_scenario(
      "world: {boxes: [], floor: 0, ceiling: 3}\n"
      "duration: 20\nlidar: planar\nrobots:\n"
      "  - id: r1\n    platform: wheeled\n    " +
          keys +
          "\n    pose: [0, 0, 0]\n"
          "  - {id: r2, platform: wheeled, pose: [3, 0, 0]}\n"
          "faults: [{at: 1, " +
          fault + "}]\n",
      "c.yaml");
}

TEST(ScenarioCameras, HaveTheKeysOfAPlatformFile) {
  const auto s = with_cameras(
      "camera: [{name: front, topic: front, x: 0.2, y: 0.1, z: 0.3, roll: 0.1, pitch: 0.2, yaw: 0.3,"
      " field_of_view: 0.9, rate: 20, width: 160, height: 120, sends: raw},"
      " {name: rear, topic: rear, yaw: 3.14}]");
  ASSERT_TRUE(s.ok()) << s.error().text;
  const std::vector<CameraConfig>& cameras = s->robots[0].settings.platform.cameras;
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[0].name, "front");
  EXPECT_EQ(cameras[0].mounting.x, 0.2);
  EXPECT_EQ(cameras[0].mounting.y, 0.1);
  EXPECT_EQ(cameras[0].mounting.z, 0.3);
  EXPECT_EQ(cameras[0].mounting.pitch, 0.2);
  EXPECT_EQ(cameras[0].field_of_view, 0.9);
  EXPECT_EQ(cameras[0].rate, 20.0);
  EXPECT_EQ(cameras[0].width, 160);
  EXPECT_FALSE(cameras[0].compressed);
  EXPECT_TRUE(cameras[1].compressed);
  EXPECT_TRUE(s->robots[1].settings.platform.cameras.empty());
  EXPECT_EQ(make_starts(*s)[0].platform.cameras.size(), 2U) << "the driver has them, too";
}

TEST(ScenarioCameras, OneWithoutKeysLooksAheadFromTheTopOfTheFront) {
  const auto s = with_cameras("camera: {}");
  ASSERT_TRUE(s.ok()) << s.error().text;
  const Platform& platform = s->robots[0].settings.platform;
  ASSERT_EQ(platform.cameras.size(), 1U);
  const CameraConfig& camera = platform.cameras[0];
  EXPECT_EQ(camera.mounting.x, 0.5 * platform.length);
  EXPECT_EQ(camera.mounting.y, 0.0);
  EXPECT_EQ(camera.mounting.z, platform.height);
  EXPECT_EQ(camera.name, CameraConfig{}.name);
}

struct BadCamera {
  const char* keys;
  const char* hint;
};
TEST(ScenarioCameras, WrongKeysAreRefusedWithTheirLine) {
  for (const BadCamera& bad :
       {BadCamera{"camera: {rate: 90}", "60"}, BadCamera{"camera: {sends: png}", "jpeg"},
        BadCamera{"camera: {fieldofview: 1}", "field_of_view"}, BadCamera{"camera: {name: a b}", "letters"},
        BadCamera{"camera: {width: 4000}", "1920"}, BadCamera{"camera: {z: -1}", "z"},
        BadCamera{"camera: [{}, {}]", "no other camera"}, BadCamera{"camera: []", "1 to 8"},
        BadCamera{"camera: front", "mapping"}}) {
    const auto s = with_cameras(bad.keys);
    ASSERT_FALSE(s.ok()) << bad.keys;
    EXPECT_NE(s.error().text.find("c.yaml:7"), std::string::npos) << s.error().text;
    EXPECT_NE(s.error().text.find(bad.hint), std::string::npos) << s.error().text;
  }
}

TEST(ScenarioCameras, HaveFaultsThatAreWrittenAsTheyAreRead) {
  for (const std::string fault :
       {"sensor_silent: r1, sensor: camera, for: 2.000", "driver_clock: r1, jump: 3.000, sensor: camera",
        "no_stamp: r1, sensor: camera, for: 2.000", "broken_jpeg: r1, for: 2.000"}) {
    const auto s = with_cameras("camera: {}", fault);
    ASSERT_TRUE(s.ok()) << s.error().text;
    EXPECT_EQ(to_yaml(s->faults[0]), "{at: 1.000, " + fault + "}");
  }
}

TEST(ScenarioCameras, FaultsOfARobotWithoutACameraAreRefused) {
  for (const std::string fault :
       {"sensor_silent: r2, sensor: camera, for: 2", "broken_jpeg: r2, for: 2", "broken_jpeg: r9, for: 2"}) {
    const auto s = with_cameras("camera: {}", fault);
    ASSERT_FALSE(s.ok()) << fault;
    EXPECT_NE(s.error().text.find("c.yaml:10"), std::string::npos) << s.error().text;
  }
  const auto raw = with_cameras("camera: {sends: raw}", "broken_jpeg: r1, for: 2");
  ASSERT_FALSE(raw.ok());
  EXPECT_NE(raw.error().text.find("sends jpeg"), std::string::npos) << raw.error().text;
}

}  // namespace
}  // namespace adit::sim
