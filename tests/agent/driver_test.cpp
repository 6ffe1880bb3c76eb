#include "robot_agent/motion/driver.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "sensor_msgs/msg/PointCloud2.h"

namespace adit::agent {
namespace {

sensor_msgs::msg::PointCloud2 cloud(const std::vector<std::array<float, 4>>& points,
                                    std::uint32_t step = 16) {
  sensor_msgs::msg::PointCloud2 c;
  for (std::uint32_t i = 0; i < 3; ++i) {
    sensor_msgs::msg::PointField f;
    f.name(std::string(1, "xyz"[i]));
    f.offset(4 * i);
    f.datatype(7);
    f.count(1);
    c.fields().push_back(f);
  }
  c.height(1);
  c.width(static_cast<std::uint32_t>(points.size()));
  c.point_step(step);
  c.row_step(step * c.width());
  c.data().resize(points.size() * step);
  for (std::size_t i = 0; i < points.size(); ++i) std::memcpy(&c.data()[i * step], points[i].data(), step);
  return c;
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

}  // namespace
}  // namespace adit::agent
