// SPDX-License-Identifier: Apache-2.0
#include "core/config/sensors_file.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/config/platform_file.hpp"
#include "tests/folders/folders.hpp"

namespace adit {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string write(const std::string& text) {
  const std::string file = scratch_folder() + "/sensors.yaml";
  std::ofstream(file) << text;
  return file;
}

const std::string kBody =
    "name: x\ndrive: differential\nlength: 1\nwidth: 1\nmax_speed: 1\nmax_turn: 1\nmax_acceleration: "
    "1\nstep: 0\n";

Result<Platform> load(const std::string& more) { return config::load_platform_file(write(kBody + more)); }

TEST(SensorsFile, a_platform_may_name_its_sensors) {
  const auto p = load(
      "sensors:\n"
      "  lidar: {x: 0.1, y: 0, z: 0.5, roll: 0, pitch: 0.2, yaw: 0, topic: points, frame: lidar, rings: 32, "
      "rate: 20,\n"
      "          min_range: 0.4, max_range: 30, noise: 0.03}\n"
      "  imu: {x: 0, y: 0, z: 0.2, roll: 3.14159265, pitch: 0, yaw: 0, topic: imu/raw, frame: imu_link, "
      "rate: 200}\n");
  ASSERT_TRUE(p) << p.error().text;
  ASSERT_EQ(p->lidars.size(), 1U);
  const LidarConfig lidar = p->lidar();
  EXPECT_EQ(lidar.mounting.position(), Eigen::Vector3d(0.1, 0, 0.5));
  EXPECT_EQ(lidar.mounting.pitch, 0.2);
  EXPECT_EQ(lidar.rings, 32);
  EXPECT_EQ(lidar.rate, 20);
  EXPECT_EQ(lidar.min_range, 0.4);
  EXPECT_EQ(lidar.max_range, 30);
  EXPECT_EQ(lidar.noise, 0.03);
  EXPECT_FALSE(lidar.rosette);
  EXPECT_TRUE(load("sensors: {lidar: {x: 0, y: 0, z: 1, pattern: rosette}}\n")->lidar().rosette);
  EXPECT_EQ(p->lidar_height, 0.5);
  EXPECT_EQ(p->lidar_rings, 32);
  ASSERT_TRUE(p->imu);
  EXPECT_EQ(p->imu->topic, "imu/raw");
  EXPECT_EQ(p->imu->frame, "imu_link");
  EXPECT_EQ(p->imu->rate, 200);
  EXPECT_TRUE(p->imu->mounting.upside_down());
  EXPECT_FALSE(lidar.mounting.upside_down());
}

TEST(SensorsFile, lidar_height_means_z_of_one_level_lidar) {
  const auto p = load("lidar_height: 0.7\nlidar_rings: 32\nlidar_lowest: -45\n");
  ASSERT_TRUE(p) << p.error().text;
  ASSERT_EQ(p->all_lidars().size(), 1U);
  EXPECT_EQ(p->lidar().mounting.position(), Eigen::Vector3d(0, 0, 0.7));
  EXPECT_EQ(p->lidar().rings, 32);
  EXPECT_EQ(p->lidar().lowest, -45);
  EXPECT_EQ(p->lidar().frame, "lidar");
  EXPECT_FALSE(p->imu);
}

TEST(SensorsFile, a_list_of_lidars_is_allowed) {
  const auto p = load(
      "sensors:\n  lidar:\n    - {x: 0.3, y: 0, z: 0.5, topic: front, frame: front}\n"
      "    - {x: -0.3, y: 0, z: 0.4, yaw: 3.14159265, topic: rear, frame: rear}\n");
  ASSERT_TRUE(p) << p.error().text;
  ASSERT_EQ(p->all_lidars().size(), 2U);
  EXPECT_EQ(p->all_lidars()[1].topic, "rear");
  EXPECT_EQ(p->lidar_height, 0.5);
}

TEST(SensorsFile, the_rotation_is_that_of_urdf) {
  const Mounting m{.roll = 0.1, .pitch = 0.2, .yaw = M_PI / 2};
  const Eigen::Vector3d forward = m.pose() * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(forward.y(), std::cos(0.2), 1e-12);
  EXPECT_NEAR(forward.z(), -std::sin(0.2), 1e-12) << "a positive pitch looks down";
}

TEST(SensorsFile, wrong_entries_name_the_line) {
  struct Row {
    const char *text, *error;
  };
  for (const Row& row :
       {Row{"sensors:\n  lidar: {x: 0, y: 0, z: -0.1}\n", ":10: z: expected a number in (0, 5]"},
        Row{"sensors:\n  lidar: {x: 0, z: 1}\n", ":10: key 'y' is missing"},
        Row{"sensors:\n  lidar: {x: 0, y: 0, z: 1, tilt: 1}\n", ":10: unknown key 'tilt'"},
        Row{"sensors:\n  lidar: []\n", ":10: lidar: expected 1 to 4 lidars"},
        Row{"sensors:\n  lidar:\n    - {x: 0, y: 0, z: 1}\n    - {x: 0, y: 0, z: 2}\n",
            ":12: lidar: expected a topic and a frame that no other lidar has"},
        Row{"sensors:\n  lidar: {x: 0, y: 0, z: 1, min_range: 2, max_range: 2}\n",
            "min_range below max_range"},
        Row{"lidar_height: 1\nsensors:\n  lidar: {x: 0, y: 0, z: 1}\n",
            ":9: lidar_height: expected either lidar_height or a lidar under sensors"},
        Row{"sensors: {lidar: {x: 0, y: 0, z: 1, pattern: petals}}\n", "rosette"},
        Row{"sensors:\n  imu: {x: 0, y: 0, z: 1}\n", "'lidar_height' is missing"},
        Row{"lidar_height: 1\nmax_tilt: 2\n", ":10: max_tilt: expected a number in (0, 1.5]"}}) {
    const auto p = load(row.text);
    ASSERT_FALSE(p) << row.text;
    EXPECT_THAT(p.error().text, HasSubstr(row.error)) << row.text;
  }
}

TEST(SensorsFile, what_flies_may_carry_its_lidar_below) {
  const auto p = config::load_platform_file(write(
      "name: x\ndrive: aerial\nlength: 1\nwidth: 1\nmax_speed: 1\nmax_turn: 1\nmax_acceleration: 1\nstep: 0\n"
      "sensors:\n  lidar: {x: 0, y: 0, z: -0.1}\n"));
  ASSERT_TRUE(p) << p.error().text;
  EXPECT_EQ(p->lidar().mounting.z, -0.1);
}

TEST(SensorsFile, may_be_a_file_of_its_own) {
  for (const char* text : {"sensors:\n  lidar: {x: 0, y: 0, z: 1.73, rings: 64}\n",
                           "lidar: {x: 0, y: 0, z: 1.73, rings: 64}\n"}) {
    const auto sensors = config::load_sensors_file(write(text));
    ASSERT_TRUE(sensors) << sensors.error().text;
    EXPECT_EQ(sensors->lidars.at(0).mounting.z, 1.73);
    EXPECT_EQ(sensors->lidars.at(0).rings, 64);
    EXPECT_FALSE(sensors->imu);
  }
  EXPECT_THAT(config::load_sensors_file(write("imu: {x: 0, y: 0, z: 1}\n")).error().text,
              HasSubstr("expected a lidar"));
  EXPECT_THAT(config::load_sensors_file(write("lidr: {}\n")).error().text, HasSubstr("unknown key 'lidr'"));
  EXPECT_FALSE(config::load_sensors_file("/nowhere/sensors.yaml"));
}

}  // namespace
}  // namespace adit
