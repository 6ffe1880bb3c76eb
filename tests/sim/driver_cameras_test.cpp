// SPDX-License-Identifier: Apache-2.0
// What the driver of a simulated robot sends of its cameras, to whom, and with which faults.
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "core/exec/virtual_runtime.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/CompressedImage.h"
#include "sensor_msgs/msg/Image.h"
#include "sim/driver/robot_driver.hpp"

namespace adit::sim {
namespace {

using Jpeg = sensor_msgs::msg::CompressedImage;

Time picture_stamp(const std_msgs::msg::Header& header) {
  return Time(std::chrono::seconds(header.stamp().sec()) + Duration(header.stamp().nanosec()));
}

CameraConfig small_camera(const std::string& name, bool compressed) {
  CameraConfig camera{.name = name, .topic = name, .rate = 10, .width = 32, .height = 24};
  camera.mounting = {.x = 0.3, .z = 0.4};
  camera.compressed = compressed;
  return camera;
}

/// A robot with a front camera that sends JPEG and a rear one that sends raw pictures, in a box of walls.
struct CameraStage {
  explicit CameraStage(bool cameras = true) : simulation(make(cameras)) {
    EXPECT_TRUE(driver.start());
    step = strand->every(10ms, [this] {
      simulation.command(0, {0.3, 0.0, 0.5});
      simulation.step();
    });
  }
  static Simulation make(bool cameras) {
    const std::array<Box, 2> walls{Box{8, 8.5, -8, 8, 0, 3}, Box{-8, 8, 6, 6.5, 0, 3}};
    SimulationParams params;
    params.realistic = true;
    params.odometry = OdometryParams::realistic();
    Platform platform;
    platform.lidar_rings = 2;  // Not what is tested.
    if (cameras) platform.cameras = {small_camera("front", true), small_camera("rear", false)};
    return *Simulation::create(std::make_shared<const World>(*make_box_world(walls, 0, 3)),
                               {{"r1", platform, {0, 0, 0}}}, params);
  }
  template <class Sample>
  std::unique_ptr<wire::RawReader> read(wire::Topic<Sample> topic, const char* name,
                                        std::function<void(const Sample&)> take) {
    topic.name = name;
    auto reader = wire::make_reader<Sample>(*agent, topic, *strand,
                                            [take](const Sample& s, const wire::SampleInfo&) { take(s); });
    EXPECT_TRUE(reader.ok());
    return std::move(*reader);
  }
  std::unique_ptr<wire::RawReader> read_front() {
    return read<Jpeg>(wire::topics::kCompressedImage, "rt/front/image_raw/compressed",
                      [this](const Jpeg& picture) {
                        front.push_back(picture);
                        came.push_back(strand->now());
                      });
  }

  Simulation simulation;
  VirtualScheduler scheduler{1};
  wire::SimulatedNetwork network{scheduler, {}};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 1h)};
  std::shared_ptr<Executor> strand{machine->strand("r1")};
  std::unique_ptr<wire::Participant> agent{network.join(101, "r1")}, body{network.join(101, "r1/driver")};
  RobotDriver driver{simulation, 0, *strand, *body, {}};
  Timer step{};
  std::vector<Jpeg> front{};
  std::vector<Time> came{};
};

/// How many samples the driver wrote on a topic.
std::uint64_t samples_written(const CameraStage& stage, const std::string& topic) {
  std::uint64_t out = 0;
  for (const wire::TopicCount& count : stage.body->counters().topics)
    if (count.topic == topic) out += count.samples_out;
  return out;
}

TEST(DriverCameras, SendNothingWithoutAReaderAndTheRateWithOne) {
  CameraStage stage;
  stage.scheduler.run_until(2s);
  EXPECT_EQ(samples_written(stage, "rt/front/image_raw/compressed"), 0U);
  auto reader = stage.read_front();
  stage.scheduler.run_until(5s);
  EXPECT_NEAR(stage.front.size(), 30, 2);
  EXPECT_EQ(samples_written(stage, "rt/rear/image_raw"), 0U) << "only the camera that is looked at";
  reader.reset();
  stage.scheduler.run_until(5500ms);
  const std::uint64_t before = samples_written(stage, "rt/front/image_raw/compressed");
  stage.scheduler.run_until(8s);
  EXPECT_EQ(samples_written(stage, "rt/front/image_raw/compressed"), before);
}

TEST(DriverCameras, APictureIsStampedWithItsExposureAndComesLater) {
  CameraStage stage;
  const auto reader = stage.read_front();
  stage.scheduler.run_until(2s);
  ASSERT_GT(stage.front.size(), 15U);
  for (std::size_t n = 0; n < stage.front.size(); ++n) {
    const Jpeg& picture = stage.front[n];
    EXPECT_EQ(picture.header().frame_id(), "front_optical");
    EXPECT_EQ(picture.format(), "rgb8; jpeg compressed bgr8");
    const Duration age = stage.came[n] - picture_stamp(picture.header());
    EXPECT_GE(age, 25ms);
    EXPECT_LE(age, 60ms);
    ASSERT_GT(picture.data().size(), 100U);
    EXPECT_EQ(picture.data()[0], 0xff);
    EXPECT_EQ(picture.data()[1], 0xd8);
    EXPECT_EQ(picture.data().back(), 0xd9) << "the end of a JPEG";
  }
  EXPECT_NE(stage.front.front().data(), stage.front.back().data()) << "the robot drives";
}

TEST(DriverCameras, ARawPictureHasAllItsBytes) {
  CameraStage stage;
  std::vector<sensor_msgs::msg::Image> rear;
  const auto reader = stage.read<sensor_msgs::msg::Image>(wire::topics::kImage, "rt/rear/image_raw",
                                                          [&](const auto& image) { rear.push_back(image); });
  stage.scheduler.run_until(1s);
  ASSERT_FALSE(rear.empty());
  EXPECT_EQ(rear.back().encoding(), "rgb8");
  EXPECT_EQ(rear.back().width(), 32U);
  EXPECT_EQ(rear.back().height(), 24U);
  EXPECT_EQ(rear.back().step(), 96U);
  EXPECT_EQ(rear.back().data().size(), 96U * 24U);
  EXPECT_EQ(rear.back().header().frame_id(), "rear_optical");
}

TEST(DriverCameras, TheSameRunGivesTheSamePictures) {
  CameraStage a, b;
  const auto reader_a = a.read_front(), reader_b = b.read_front();
  a.scheduler.run_until(2s);
  b.scheduler.run_until(2s);
  EXPECT_EQ(a.front, b.front);
  EXPECT_EQ(a.came, b.came);
}

TEST(DriverCameras, ChangeNothingOfTheOtherSensors) {
  const auto odometry = [](bool cameras) {
    CameraStage stage(cameras);
    std::vector<nav_msgs::msg::Odometry> out;
    const auto reader = stage.read<nav_msgs::msg::Odometry>(
        wire::topics::kOdom, "rt/odom", [&](const auto& sample) { out.push_back(sample); });
    auto front = cameras ? stage.read_front() : nullptr;
    stage.scheduler.run_until(3s);
    return out;
  };
  EXPECT_EQ(odometry(true), odometry(false));
}

TEST(DriverCameras, HaveTheFaultsOfSensors) {
  CameraStage stage;
  const auto reader = stage.read_front();
  const auto during = [&](Duration until) {
    stage.front.clear();
    stage.came.clear();
    stage.scheduler.run_until(until);
    return stage.front;
  };
  EXPECT_GT(during(1s).size(), 5U);
  stage.driver.silence(Sensor::camera, true);
  stage.scheduler.run_until(1100ms);
  EXPECT_EQ(during(2s).size(), 0U);
  stage.driver.silence(Sensor::camera, false);

  stage.driver.jump_clock(Sensor::camera, 100s);
  stage.scheduler.run_until(2100ms);
  ASSERT_GT(during(3s).size(), 5U);
  for (std::size_t n = 0; n < stage.front.size(); ++n)
    EXPECT_GT(picture_stamp(stage.front[n].header()) - stage.came[n], 99s);
  stage.driver.jump_clock(Sensor::camera, -100s);

  stage.driver.drop_stamps(Sensor::camera, true);
  stage.scheduler.run_until(3100ms);
  ASSERT_GT(during(4s).size(), 5U);
  for (const Jpeg& picture : stage.front) EXPECT_EQ(picture_stamp(picture.header()), Time{});
  stage.driver.drop_stamps(Sensor::camera, false);

  stage.driver.break_jpegs(true);
  stage.scheduler.run_until(4100ms);
  ASSERT_GT(during(5s).size(), 5U);
  for (const Jpeg& picture : stage.front) {
    const std::size_t size = picture.data().size();
    EXPECT_GT(size, 100U);
    EXPECT_FALSE(picture.data()[size - 2] == 0xff && picture.data()[size - 1] == 0xd9) << "it has an end";
  }
  stage.driver.break_jpegs(false);
  stage.scheduler.run_until(5100ms);
  ASSERT_GT(during(6s).size(), 5U);
  EXPECT_EQ(stage.front.back().data().back(), 0xd9);
}

TEST(DriverCameras, AFastCameraSendsAtItsRate) {
  Platform platform;
  platform.cameras = {small_camera("front", true)};
  platform.cameras[0].rate = 50;
  platform.cameras[0].width = 640;
  platform.cameras[0].height = 480;
  CameraStage stage(false);
  Simulation fast = *Simulation::create(stage.simulation.shared_world(), {{"r1", platform, {}}}, {});
  const auto other = stage.network.join(101, "fast");
  RobotDriver driver(fast, 0, *stage.strand, *other, {});
  ASSERT_TRUE(driver.start());
  const auto reader = stage.read_front();
  stage.scheduler.run_until(1s);
  EXPECT_NEAR(stage.front.size(), 48, 2);
}

}  // namespace
}  // namespace adit::sim
