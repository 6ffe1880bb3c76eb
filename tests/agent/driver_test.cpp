// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/driver.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/exec/virtual_runtime.hpp"
#include "core/wire/component_io.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "core/wire/topics.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "geometry_msgs/msg/TwistStamped.h"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/motion/scans.hpp"
#include "sensor_msgs/msg/LaserScan.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "tests/point_cloud.hpp"

namespace adit::agent {
namespace {

sensor_msgs::msg::PointCloud2 cloud(const std::vector<std::array<float, 4>>& points,
                                    std::uint32_t step = 16) {
  std::vector<float> numbers;
  for (const auto& point : points) numbers.insert(numbers.end(), point.begin(), point.begin() + step / 4);
  return cloud_of(numbers, step / 4);
}

TEST(PointCloud2, PointsOfBothUsualSteps) {
  for (const std::uint32_t step : {12u, 16u}) {
    const auto points = to_sweep(cloud({{1, 2, 3, 9}, {4, 5, 6, 9}}, step), 0.1);
    ASSERT_TRUE(points);
    ASSERT_EQ(points->points.size(), 2u);
    EXPECT_EQ(points->points[1].position, Eigen::Vector3f(4, 5, 6));
  }
}

TEST(PointCloud2, LayoutsThatDoNotFitAreRefused) {
  auto c = cloud({{1, 2, 3, 0}});
  c.width(2);
  EXPECT_EQ(to_sweep(c, 0.1).reason(), Reason::malformed);
  c = cloud({{1, 2, 3, 0}});
  c.width(0xffffffff);
  c.height(0xffffffff);
  EXPECT_EQ(to_sweep(c, 0.1).reason(), Reason::malformed);
  c = cloud({{1, 2, 3, 0}});
  c.point_step(0);
  EXPECT_EQ(to_sweep(c, 0.1).reason(), Reason::malformed);
  c = cloud({{1, 2, 3, 0}});
  c.fields()[2].offset(0xfffffffe);
  EXPECT_EQ(to_sweep(c, 0.1).reason(), Reason::malformed);
  c = cloud({{1, 2, 3, 0}});
  c.fields()[0].datatype(8);
  EXPECT_EQ(to_sweep(c, 0.1).reason(), Reason::malformed);
  c = cloud({{1, 2, 3, 0}});
  c.is_bigendian(true);
  EXPECT_EQ(to_sweep(c, 0.1).reason(), Reason::malformed);
  EXPECT_TRUE(to_sweep(cloud({}), 0.1)->points.empty());
}

sensor_msgs::msg::LaserScan laser(std::vector<float> ranges) {
  sensor_msgs::msg::LaserScan scan;
  scan.angle_min(-static_cast<float>(M_PI));
  scan.angle_increment(static_cast<float>(M_PI / 2));
  scan.range_min(0.1f);
  scan.range_max(30.0f);
  scan.ranges(std::move(ranges));
  return scan;
}

TEST(LaserScan, IsPointsAtTheLidarsHeight) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const auto points = to_sweep(laser({2.0f, 3.0f, 4.0f, inf}), 0.5, 0.1);
  ASSERT_TRUE(points);
  ASSERT_EQ(points->points.size(), 3u) << "what met nothing is no point";
  EXPECT_TRUE(points->points[0].position.isApprox(Eigen::Vector3f(-2, 0, 0.5), 1e-4f));
  EXPECT_TRUE(points->points[1].position.isApprox(Eigen::Vector3f(0, -3, 0.5), 1e-4f));
  EXPECT_TRUE(points->points[2].position.isApprox(Eigen::Vector3f(4, 0, 0.5), 1e-4f));
  EXPECT_TRUE(to_sweep(laser({nan, 0.01f, 31.0f, -1.0f}), 0.5, 0.1)->points.empty())
      << "none of the scanner's range";
}

TEST(LaserScan, InvalidAnglesAreRefused) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), 1e30f, 3.0f}) {
    auto scan = laser({1, 1, 1, 1});
    scan.angle_increment(bad);
    EXPECT_EQ(to_sweep(scan, 0.5, 0.1).reason(), Reason::malformed) << bad;
  }
  auto scan = laser({1});
  scan.angle_min(std::numeric_limits<float>::infinity());
  EXPECT_EQ(to_sweep(scan, 0.5, 0.1).reason(), Reason::malformed);
}

TEST(LaserScan, RaysThatTakeLongerThanASweepAreRefused) {
  auto scan = laser({1, 1, 1, 1});
  scan.time_increment(0.025f);
  ASSERT_TRUE(to_sweep(scan, 0.5, 0.1));
  EXPECT_TRUE(to_sweep(scan, 0.5, 0.1)->timed);
  for (const float bad : {2.5e7f, 0.2f, -0.2f, std::numeric_limits<float>::quiet_NaN()}) {
    scan.time_increment(bad);
    EXPECT_EQ(to_sweep(scan, 0.5, 0.1).reason(), Reason::sensor_times) << bad;
  }
  scan.time_increment(2.5e7f);
  EXPECT_THAT(to_sweep(scan, 0.5, 0.1).error().text,
              testing::HasSubstr("time_increment 2.5e+07 times its 4 rays is no sweep of 0.1 s"));
}

/// What the two kinds of driver hear.
template <class T>
std::vector<double> heard_by(const wire::Topic<T>& topic, VelocityType type,
                             const std::function<double(const T&)>& vx) {
  VirtualScheduler scheduler{1};
  wire::SimulatedNetwork network{scheduler, {}};
  const std::unique_ptr<Runtime> machine{scheduler.machine("r1", 1h)};
  const std::shared_ptr<Executor> strand{machine->strand("driver")};
  const std::unique_ptr<wire::Participant> agent{network.join(101, "r1")},
      body{network.join(101, "r1/driver")};
  std::vector<double> heard;
  const auto reader = wire::make_reader<T>(*body, topic, *strand, [&](const T& t, const wire::SampleInfo&) {
                        heard.push_back(vx(t));
                      }).value();
  VelocityWriter writer = VelocityWriter::make(*agent, type).value();
  scheduler.run_until(3s);
  writer.write({0.5, 0.1, -0.2});
  scheduler.run_until(4s);
  return heard;
}

TEST(Velocity, IsSentInTheDriversType) {
  using geometry_msgs::msg::Twist;
  using geometry_msgs::msg::TwistStamped;
  const std::function<double(const Twist&)> plain = [](const Twist& t) { return t.linear().x(); };
  const std::function<double(const TwistStamped&)> stamped = [](const TwistStamped& t) {
    EXPECT_EQ(t.header().stamp().sec(), 0) << "now, to a driver";
    EXPECT_EQ(t.twist().angular().z(), -0.2);
    return t.twist().linear().x();
  };
  EXPECT_EQ(heard_by(wire::topics::kCmdVel, VelocityType::twist, plain), std::vector{0.5});
  EXPECT_EQ(heard_by(wire::topics::kCmdVelStamped, VelocityType::twist_stamped, stamped), std::vector{0.5});
  EXPECT_TRUE(heard_by(wire::topics::kCmdVel, VelocityType::twist_stamped, plain).empty());
}

TEST(Velocity, AWriterWithoutATopicWritesNothing) { VelocityWriter().write({1, 0, 0}); }

/// A driver that publishes odometry, and an agent's side of the robot domain that counts what it believes.
class OdometryTest : public testing::Test {
 protected:
  OdometryTest() {
    Driver::Handlers handlers{};
    handlers.odometry = [this](const Pose3& pose, const Twist2&, std::uint64_t, Time received) {
      seen.push_back(pose);
      times.push_back(received);
    };
    handlers.battery = [](float) {};
    handlers.external = [this](const Twist2& velocity, Time received) {
      asked.push_back(velocity);
      times.push_back(received);
    };
    handlers.rival = [this](const wire::ParticipantId& who, Time received) {
      rivals.push_back(who);
      times.push_back(received);
    };
    handlers.fault = [this](const InputFault& fault) { faults.push_back(fault.cause.text); };
    driver = Driver::open({*agent, *strand, generation}, VelocityType::twist, std::move(handlers),
                          std::make_shared<OneSource>())
                 .value();
    writer = wire::Writer<nav_msgs::msg::Odometry>::make(*body, wire::topics::kOdom).value();
    run(3s);
  }
  void run(Duration time) { scheduler.run_until(elapsed += time); }
  /// How many of these were believed.
  std::size_t publish(double x, double qw, double vx) {
    nav_msgs::msg::Odometry sample;
    sample.pose().pose().position().x(x);
    sample.pose().pose().orientation().w(qw);
    sample.twist().twist().linear().x(vx);
    seen.clear();
    EXPECT_TRUE(writer.write(sample));
    run(100ms);
    return seen.size();
  }

  VirtualScheduler scheduler{1};
  Duration elapsed{};
  wire::SimulatedNetwork network{scheduler, {}};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 1h)};
  std::shared_ptr<Executor> strand{machine->strand("command")};
  std::unique_ptr<wire::Participant> agent{network.join(101, "r1")}, body{network.join(101, "r1/driver")};
  std::shared_ptr<Generation> generation{std::make_shared<Generation>()};
  std::unique_ptr<Driver> driver{};
  wire::Writer<nav_msgs::msg::Odometry> writer{};
  std::vector<Pose3> seen{};
  std::vector<Twist2> asked{};
  std::vector<wire::ParticipantId> rivals{};
  std::vector<Time> times{};
  std::vector<std::string> faults{};
};

TEST_F(OdometryTest, ImpossibleOdometryCountsAsSilence) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(publish(1.0, 1.0, 0.5), 1u);
  EXPECT_EQ(publish(999e3, 2.0, -0.5), 1u);
  for (const double x : {nan, inf, -inf, 1e300, -1e9}) EXPECT_EQ(publish(x, 1.0, 0.5), 0u) << x;
  for (const double w : {nan, inf, 0.0, 1e300}) EXPECT_EQ(publish(1.0, w, 0.5), 0u) << w;
  for (const double v : {nan, inf}) EXPECT_EQ(publish(1.0, 1.0, v), 0u) << v;
  ASSERT_EQ(faults.size(), 11u) << "each is reported";
  EXPECT_THAT(faults[0], testing::HasSubstr("its position nan 0 0 is no place within 1000 km"));
  EXPECT_THAT(faults[7], testing::HasSubstr("its orientation 0 0 0 0 is no quaternion"));
  EXPECT_THAT(faults[9], testing::HasSubstr("its twist is no number"));
}

TEST_F(OdometryTest, ARevokedComponentDrivesAndHearsNothing) {
  int velocities{};
  const auto reader =
      wire::make_reader(*body, wire::topics::kCmdVel, *strand,
                        [&](const geometry_msgs::msg::Twist&, const wire::SampleInfo&) { ++velocities; });
  run(3s);
  driver->write({0.1, 0, 0});
  EXPECT_EQ(publish(1.0, 1.0, 0.5), 1u);
  EXPECT_EQ(velocities, 1);
  generation->revoke();
  driver->write({0.1, 0, 0});
  EXPECT_EQ(publish(2.0, 1.0, 0.5), 0u);
  EXPECT_EQ(velocities, 1);
}

TEST_F(OdometryTest, ReportsAProgramsVelocityAndASecondWriter) {
  geometry_msgs::msg::Twist twist;
  twist.linear().x(0.3);
  auto outside = wire::Writer<geometry_msgs::msg::Twist>::make(*body, wire::topics::kExternalCmdVel).value();
  auto rival = wire::Writer<geometry_msgs::msg::Twist>::make(*body, wire::topics::kCmdVel).value();
  run(3s);
  driver->write({0.1, 0, 0});
  run(1s);
  EXPECT_TRUE(rivals.empty()) << "its own are no rival's";
  ASSERT_TRUE(outside.write(twist));
  ASSERT_TRUE(rival.write(twist));
  run(1s);
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].vx, 0.3);
  ASSERT_EQ(rivals.size(), 1u);
  EXPECT_EQ(rivals[0], body->id());
}

TEST_F(OdometryTest, SamplesCarryTheTimeAtWhichTheyCame) {
  geometry_msgs::msg::Twist twist;
  auto outside = wire::Writer<geometry_msgs::msg::Twist>::make(*body, wire::topics::kExternalCmdVel).value();
  auto rival = wire::Writer<geometry_msgs::msg::Twist>::make(*body, wire::topics::kCmdVel).value();
  run(3s);
  const Time before = strand->now();
  EXPECT_EQ(publish(1.0, 1.0, 0.5), 1u);
  ASSERT_TRUE(outside.write(twist));
  ASSERT_TRUE(rival.write(twist));
  run(1s);
  ASSERT_EQ(times.size(), 3u);
  for (const Time at : times) {
    EXPECT_GT(at, before);
    EXPECT_LT(at, before + 200ms);
  }
}

TEST(DriverRival, IsHeardInTheDriversOwnType) {
  VirtualScheduler scheduler{1};
  wire::SimulatedNetwork network{scheduler, {}};
  const std::unique_ptr<Runtime> machine{scheduler.machine("r1", 1h)};
  const std::shared_ptr<Executor> strand{machine->strand("command")};
  const std::unique_ptr<wire::Participant> agent{network.join(101, "r1")},
      body{network.join(101, "r1/driver")};
  std::vector<wire::ParticipantId> rivals;
  Driver::Handlers handlers{};
  handlers.odometry = [](const Pose3&, const Twist2&, std::uint64_t, Time) {};
  handlers.battery = [](float) {};
  handlers.external = [](const Twist2&, Time) {};
  handlers.rival = [&](const wire::ParticipantId& who, Time) { rivals.push_back(who); };
  const auto driver = Driver::open({*agent, *strand}, VelocityType::twist_stamped, std::move(handlers),
                                   std::make_shared<OneSource>())
                          .value();
  auto rival =
      wire::Writer<geometry_msgs::msg::TwistStamped>::make(*body, wire::topics::kCmdVelStamped).value();
  scheduler.run_until(3s);
  driver->write({0.1, 0, 0});
  ASSERT_TRUE(rival.write(geometry_msgs::msg::TwistStamped{}));
  scheduler.run_until(4s);
  EXPECT_EQ(rivals, std::vector{body->id()});
}

}  // namespace
}  // namespace adit::agent
