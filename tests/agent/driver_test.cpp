#include "robot_agent/motion/driver.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/exec/virtual_runtime.hpp"
#include "core/wire/memory/ether.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/motion/scans.hpp"
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
    const auto points = to_points(cloud({{1, 2, 3, 9}, {4, 5, 6, 9}}, step));
    ASSERT_TRUE(points);
    ASSERT_EQ(points->size(), 2u);
    EXPECT_EQ((*points)[1], Eigen::Vector3f(4, 5, 6));
  }
}

TEST(PointCloud2, NotFinitePointsAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto points = to_points(cloud({{nan, 2, 3, 0}, {4, 5, 6, 0}}));
  ASSERT_TRUE(points);
  EXPECT_EQ(points->size(), 1u);
}

TEST(PointCloud2, LayoutsThatDoNotFitAreRefused) {
  auto c = cloud({{1, 2, 3, 0}});
  c.width(2);
  EXPECT_EQ(to_points(c).reason(), Reason::malformed);
  c = cloud({{1, 2, 3, 0}});
  c.width(0xffffffff);
  c.height(0xffffffff);
  EXPECT_EQ(to_points(c).reason(), Reason::malformed);
  c = cloud({{1, 2, 3, 0}});
  c.point_step(0);
  EXPECT_EQ(to_points(c).reason(), Reason::malformed);
  c = cloud({{1, 2, 3, 0}});
  c.fields()[2].offset(0xfffffffe);
  EXPECT_EQ(to_points(c).reason(), Reason::malformed);
  c = cloud({{1, 2, 3, 0}});
  c.fields()[0].datatype(8);
  EXPECT_EQ(to_points(c).reason(), Reason::malformed);
  c = cloud({{1, 2, 3, 0}});
  c.is_bigendian(true);
  EXPECT_EQ(to_points(c).reason(), Reason::malformed);
  EXPECT_TRUE(to_points(cloud({}))->empty());
}

/// A driver that publishes odometry, and an agent's side of the robot domain that counts what it believes.
class OdometryTest : public testing::Test {
 protected:
  OdometryTest() {
    Driver::Handlers handlers{};
    handlers.odometry = [this](const Pose3& pose, const Twist2&, std::uint64_t) { seen.push_back(pose); };
    handlers.battery = [](float) {};
    driver = Driver::open(*agent, *strand, std::move(handlers)).value();
    writer = wire::Writer<nav_msgs::msg::Odometry>::make(*body, wire::topics::odom).value();
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
  wire::Ether ether{scheduler, {}};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 1h)};
  std::shared_ptr<Executor> strand{machine->strand("command")};
  std::unique_ptr<wire::Wire> agent{ether.join(101, "r1")}, body{ether.join(101, "r1/driver")};
  std::unique_ptr<Driver> driver{};
  wire::Writer<nav_msgs::msg::Odometry> writer{};
  std::vector<Pose3> seen{};
};

TEST_F(OdometryTest, WhatNoBodyCanHaveIsAsGoodAsSilence) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(publish(1.0, 1.0, 0.5), 1u);
  EXPECT_EQ(publish(999e3, 2.0, -0.5), 1u);
  for (const double x : {nan, inf, -inf, 1e300, -1e9}) EXPECT_EQ(publish(x, 1.0, 0.5), 0u) << x;
  for (const double w : {nan, inf, 0.0, 1e300}) EXPECT_EQ(publish(1.0, w, 0.5), 0u) << w;
  for (const double v : {nan, inf}) EXPECT_EQ(publish(1.0, 1.0, v), 0u) << v;
}

}  // namespace
}  // namespace adit::agent
