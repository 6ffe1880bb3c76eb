// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/check/sensor_check.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/point_cloud.hpp"

namespace adit::agent {
namespace {

using testing::HasSubstr;

const char* const kFile = R"(name: body
sensors:
  lidar:
    x: 0.1
    y: 0
    z: 0.5
    roll: 0
    pitch: 0
  imu:
    z: 0.2
    roll: 0
)";

/// A robot in a hall with a level floor and walls 4 m away, whose sensors may be mounted otherwise than the
/// file says.
struct MountedRobot {
  Mounting lidar{.x = 0.1, .z = 0.5}, imu{.z = 0.2};  ///< In truth.
  std::string lidar_frame{"lidar"};
  double gyro_gain{1}, force{9.81}, scan_rate{10}, clock{0};
  bool odometry_turns{true};

  std::vector<CheckLine> check(bool turn = true) {
    Platform platform;
    platform.lidars = {LidarConfig{.mounting = {.x = 0.1, .z = 0.5}}};
    platform.imu = ImuConfig{.mounting = {.z = 0.2}};
    SensorCheck check(platform, ConfigLines(*config::parse(kFile, "body.yaml")));
    for (int n = 0; n < 300; ++n) {
      if (n == 200) check.begin_turn();
      step(check, n, n < 200 ? 0.0 : 1.0);
    }
    EXPECT_EQ(check.turned(), odometry_turns);
    return check.report(turn);
  }
  static const CheckLine& line(const std::vector<CheckLine>& all, const std::string& what) {
    for (const CheckLine& each : all)
      if (each.what.find(what) != std::string::npos) return each;
    static const CheckLine none{};
    ADD_FAILURE() << "no line " << what;
    return none;
  }

 private:
  template <class Header>
  void stamp(Header& header, int n, const char* frame, double clock_error = 0) const {
    const auto ns = static_cast<std::uint64_t>((100 + 0.02 * n + clock_error) * 1e9);
    header.stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
    header.stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
    header.frame_id(frame);
  }
  void step(SensorCheck& check, int n, double rate) const {
    const Time received = Time(from_seconds(5 + 0.02 * n));
    nav_msgs::msg::Odometry odometry;
    stamp(odometry.header(), n, "odom");
    const double yaw = odometry_turns ? rate * 0.02 * (n - 200) : 0.0;
    odometry.pose().pose().orientation().z(std::sin(yaw / 2));
    odometry.pose().pose().orientation().w(std::cos(yaw / 2));
    check.take(odometry, received);
    const Eigen::Quaterniond back = imu.pose().orientation.conjugate();
    for (int k = 0; k < 2; ++k) {
      sensor_msgs::msg::Imu sample;
      stamp(sample.header(), n, "imu", 0.01 * k);
      const Eigen::Vector3d w = gyro_gain * (back * Eigen::Vector3d(0, 0, rate));
      const Eigen::Vector3d f = back * Eigen::Vector3d(0, 0, force);
      sample.angular_velocity().x(w.x());
      sample.angular_velocity().y(w.y());
      sample.angular_velocity().z(w.z());
      sample.linear_acceleration().x(f.x());
      sample.linear_acceleration().y(f.y());
      sample.linear_acceleration().z(f.z());
      check.take(sample, received + from_seconds(0.01 * k));
    }
    if (n % static_cast<int>(50 / scan_rate) != 0) return;
    std::vector<float> numbers;
    const Pose3 T_lidar_base = lidar.pose().inverse();
    for (int i = 0; i < 360; i += 6)
      for (const auto& [r, z] : {std::pair{1.5, 0.0}, {3.0, 0.0}, {4.0, 0.4}, {4.0, 0.9}}) {
        const double a = i * M_PI / 180;
        const Eigen::Vector3d p = T_lidar_base * Eigen::Vector3d(r * std::cos(a), r * std::sin(a), z);
        for (int axis = 0; axis < 3; ++axis) numbers.push_back(static_cast<float>(p[axis]));
      }
    sensor_msgs::msg::PointCloud2 cloud = cloud_of(numbers);
    stamp(cloud.header(), n, lidar_frame.c_str(), clock);
    check.take(cloud, 0, received);
  }
};

TEST(SensorCheck, ARobotThatIsMountedAsTheFileSaysIsOk) {
  const auto lines = MountedRobot{}.check();
  EXPECT_GE(lines.size(), 16U);
  for (const CheckLine& line : lines) EXPECT_TRUE(line.ok) << line.what << ": " << line.found;
}

TEST(SensorCheck, TheLidarsHeightAndTiltAreMeasuredAgainstTheGround) {
  MountedRobot higher;
  higher.lidar.z = 0.62;
  const auto height = MountedRobot::line(higher.check(), "height");
  EXPECT_FALSE(height.ok);
  EXPECT_THAT(height.found, HasSubstr("0.62 m above the ground, the file says 0.50"));
  EXPECT_EQ(height.where, "body.yaml:6");
  MountedRobot nods;
  nods.lidar.pitch = 0.07;
  nods.lidar.roll = -0.05;
  const auto lines = nods.check();
  EXPECT_FALSE(MountedRobot::line(lines, ": pitch").ok);
  EXPECT_THAT(MountedRobot::line(lines, ": pitch").found, HasSubstr("0.070 would fit"));
  EXPECT_EQ(MountedRobot::line(lines, ": pitch").where, "body.yaml:8");
  EXPECT_THAT(MountedRobot::line(lines, ": roll").found, HasSubstr("-0.050 would fit"));
  MountedRobot over;
  over.lidar.roll = M_PI;
  const auto turned = MountedRobot::line(over.check(), "height");
  EXPECT_FALSE(turned.ok);
  EXPECT_THAT(turned.found, HasSubstr("the other way up"));
  EXPECT_EQ(turned.where, "body.yaml:7");
}

TEST(SensorCheck, GravityItsAxisAndUnitAreJudged) {
  MountedRobot over;
  over.imu.roll = M_PI;
  const auto axis = MountedRobot::line(over.check(), ": axis");
  EXPECT_FALSE(axis.ok);
  EXPECT_THAT(axis.found, HasSubstr("180 degrees off z of base_link, nearest to -z"));
  EXPECT_EQ(axis.where, "body.yaml:11");
  MountedRobot in_g;
  in_g.force = 1;
  EXPECT_TRUE(MountedRobot::line(in_g.check(), ": gravity").ok);
  EXPECT_THAT(MountedRobot::line(in_g.check(), ": gravity").found, HasSubstr("in g"));
  MountedRobot in_feet;
  in_feet.force = 32.2;
  EXPECT_FALSE(MountedRobot::line(in_feet.check(), ": gravity").ok);
}

TEST(SensorCheck, TheGyrosSignAndUnitAreJudgedByTheTurn) {
  MountedRobot opposite;
  opposite.gyro_gain = -1;
  EXPECT_FALSE(MountedRobot::line(opposite.check(), "gyro in the turn").ok);
  EXPECT_THAT(MountedRobot::line(opposite.check(), "gyro in the turn").found, HasSubstr("opposite"));
  MountedRobot in_degrees;
  in_degrees.gyro_gain = 57.3;
  EXPECT_THAT(MountedRobot::line(in_degrees.check(), "gyro in the turn").found, HasSubstr("rad/s"));
  MountedRobot sideways;
  sideways.imu.roll = M_PI / 2;
  EXPECT_FALSE(MountedRobot::line(sideways.check(), "axis of the turn").ok);
  MountedRobot stays;
  stays.odometry_turns = false;
  EXPECT_THAT(MountedRobot::line(stays.check(), "gyro in the turn").found,
              HasSubstr("less than a quarter turn"));
}

TEST(SensorCheck, RatesClocksAndFramesAreJudged) {
  MountedRobot slow;
  slow.scan_rate = 5;
  EXPECT_THAT(MountedRobot::line(slow.check(), "lidar /points: rate").found, HasSubstr("5.0 per second"));
  EXPECT_FALSE(MountedRobot::line(slow.check(), "lidar /points: rate").ok);
  MountedRobot other_clock;
  other_clock.clock = -3;
  EXPECT_FALSE(MountedRobot::line(other_clock.check(), "lidar /points: clock").ok);
  EXPECT_THAT(MountedRobot::line(other_clock.check(), "lidar /points: clock").found,
              HasSubstr("3000 ms behind"));
  MountedRobot foreign;
  foreign.lidar_frame = "velodyne";
  EXPECT_FALSE(MountedRobot::line(foreign.check(), "lidar /points: frame").ok);
  EXPECT_THAT(MountedRobot::line(foreign.check(), "lidar /points: frame").found, HasSubstr("'velodyne'"));
}

TEST(SensorCheck, SilenceIsReportedPerTopic) {
  Platform platform;
  platform.imu = ImuConfig{};
  const SensorCheck check(platform, ConfigLines(*config::parse("name: body\nlidar_height: 0.5\n", "b.yaml")));
  const auto lines = check.report(true);
  ASSERT_EQ(lines.size(), 3U);
  for (const CheckLine& line : lines) EXPECT_THAT(line.found, HasSubstr("no message")) << line.what;
  const std::string text = to_text(lines);
  EXPECT_THAT(text, HasSubstr("wrong  lidar /points: no message"));
  EXPECT_THAT(text, HasSubstr("change: b.yaml:"));
  EXPECT_FALSE(judge_buffer(212992).ok);
  EXPECT_TRUE(judge_buffer(4 << 20).ok);
}

}  // namespace
}  // namespace adit::agent
