// SPDX-License-Identifier: Apache-2.0
// The collision monitor on a body that leans, with rays that are traced exactly: level ground and one box.
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <random>

#include "nav/monitor/near_points.hpp"
#include "tests/nav/box_world.hpp"
#include "tests/nav/scanned_monitor.hpp"

namespace adit::nav::test {
namespace {

using Cause = CollisionMonitor::Cause;
using Policy = CollisionMonitor::Policy;

struct Lidar {
  int rings;
  double lowest, highest;  ///< Degrees.
};
constexpr Lidar kUsual{16, -15, 15}, kDown{32, -45, 15};

/// A box on the ground in the direction `bearing`, its face `distance` m from the origin.
struct Obstacle {
  double bearing, distance, height;
  static constexpr double kHalfWidth = 0.15, kDepth = 0.3;
};

/// Range of a ray to level ground or the box, m.
///
/// `to_box`: turns the bearing of the box to x.
std::optional<double> met(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                          const Eigen::Matrix3d& to_box, const std::optional<Obstacle>& box) {
  double range = 12;
  if (direction.z() < 0) range = std::min(range, -from.z() / direction.z());
  if (box) {
    const Eigen::Vector3d o = to_box * from, d = to_box * direction;
    const Eigen::Vector3d low(box->distance, -Obstacle::kHalfWidth, 0);
    const Eigen::Vector3d high(box->distance + Obstacle::kDepth, Obstacle::kHalfWidth, box->height);
    double enter = 0, leave = range;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (low[axis] - o[axis]) / d[axis], b = (high[axis] - o[axis]) / d[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave) range = enter;
  }
  return range < 12 ? std::optional(range) : std::nullopt;
}

/// Points in base_link of a body that leans; only columns within 15 degrees of the box, or all without one.
std::vector<Eigen::Vector3f> look(const Platform& p, const Lidar& lidar, const Pose3& body,
                                  const std::optional<Obstacle>& box, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 0.02);
  std::vector<Eigen::Vector3f> points;
  const Eigen::Vector3d at(0, 0, p.lidar_height), from = body * at;
  const double middle = box ? box->bearing - body.yaw() : 0, half = box ? 15 : 180;
  const Eigen::Matrix3d to_box =
      Eigen::AngleAxisd(box ? -box->bearing : 0.0, Eigen::Vector3d::UnitZ()).matrix();
  const Eigen::Matrix3d R = body.orientation.toRotationMatrix();
  for (double column = -half; column < half; column += 0.8)
    for (int ring = 0; ring < lidar.rings; ++ring) {
      const double azimuth = middle + column * M_PI / 180;
      const double elevation =
          (lidar.lowest + (lidar.highest - lidar.lowest) * ring / (lidar.rings - 1)) * M_PI / 180;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      if (const auto range = met(from, R * ray, to_box, box))
        points.push_back((at + (*range + noise(random)) * ray).cast<float>());
    }
  return points;
}

Pose3 leaning(double x, double yaw, double most, std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-most, most);
  Pose3 body = Pose3::level({x, 0, yaw}, 0);
  body.orientation = body.orientation * Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitX());
  return body;
}

constexpr double kTen = 10 * M_PI / 180;

bool shows(const NearPoints& near, double x, double y) {
  for (const NearPoints::Place& place : near.places())
    if (std::hypot(place.x - x, place.y - y) < 0.25) return true;
  return false;
}

/// Number of draws: 1000, or the value of ADIT_DRAWS.
int draws() {
  const char* set = std::getenv("ADIT_DRAWS");
  return set ? std::atoi(set) : 1000;
}

// An obstacle of 0.30 m at 1 m, seen with the body at up to 10 degrees of roll and pitch, is never missed.
TEST(MonitorTilt, TiltedBodySeesTheSameObstaclesAsALevelOne) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> bearing(-M_PI, M_PI);
  const UprightRangeImage nothing{};
  int missed = 0;
  for (int n = 0; n < draws(); ++n) {
    const Platform platform = n % 2 == 0 ? wheeled() : tracked();
    static NearPoints near[2]{{wheeled(), 2.5}, {tracked(), 2.5}};
    NearPoints& monitor = near[n % 2];
    monitor.clear();
    const Obstacle box{bearing(random), 1.0, 0.30};
    const Pose3 body = leaning(0, 0, kTen, random);
    monitor.take(look(platform, kDown, body, box, random), body, 0, nothing);
    missed += !shows(monitor, std::cos(box.bearing), std::sin(box.bearing));
  }
  EXPECT_EQ(missed, 0);
}

// A lidar that sees the box from afar only: what was seen is remembered where it is, however the body leans
// later.
TEST(MonitorTilt, RemembersObstaclesSeenOnTheWay) {
  std::mt19937 random(2);
  int missed = 0;
  for (int n = 0; n < 100; ++n) {
    const Platform platform = n % 2 == 0 ? wheeled() : tracked();
    NearPoints near(platform, 3.0);
    const Obstacle box{0, 4.0, 0.30};
    for (int i = 0; i <= 20; ++i) {
      const Pose3 body = leaning(1.0 + 0.1 * i, 0, kTen, random);
      near.take(look(platform, kUsual, body, box, random), body, 0.1 * i, UprightRangeImage{});
    }
    missed += !shows(near, 4.0, 0);
  }
  EXPECT_EQ(missed, 0);
}

TEST(MonitorTilt, LevelGroundIsNoObstacleToABodyThatLeans) {
  std::mt19937 random(3);
  int wrong = 0;
  for (int n = 0; n < 100; ++n) {
    const Platform platform = n % 2 == 0 ? wheeled() : tracked();
    NearPoints near(platform, 2.5);
    const Pose3 body = leaning(0, 0, kTen, random);
    near.take(look(platform, n % 4 < 2 ? kDown : kUsual, body, std::nullopt, random), body, 0,
              UprightRangeImage{});
    wrong += !near.places().empty();
  }
  EXPECT_EQ(wrong, 0);
}

TEST(MonitorTilt, ARampIsNoObstacleAndABoxOnItIsOne) {
  std::mt19937 random(4);
  for (const double slope : {-0.3, 0.3}) {
    // The world is turned instead of the body: a ramp through the origin, the body lying on it.
    const Platform platform = wheeled();
    NearPoints near(platform, 2.5);
    Pose3 body{};
    body.orientation = Eigen::AngleAxisd(-std::atan(slope), Eigen::Vector3d::UnitY());
    near.take(look(platform, kDown, Pose3{}, std::nullopt, random), body, 0, UprightRangeImage{});
    EXPECT_TRUE(near.places().empty()) << slope;
    near.take(look(platform, kDown, Pose3{}, Obstacle{0, 1.0, 0.30}, random), body, 0.1, UprightRangeImage{});
    EXPECT_FALSE(near.places().empty()) << slope;
  }
}

TEST(MonitorTilt, ABodyThatMayTipOverStands) {
  std::mt19937 random(5);
  const Platform platform = wheeled();
  const double limit = Traversability::of(platform).tilt;
  ScannedMonitor monitor(platform);
  const auto lean = [&](double roll, double time) {
    Pose3 body{};
    body.orientation = Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
    monitor.look(look(platform, kUsual, Pose3{}, std::nullopt, random), body, time);
    return monitor.check({1, 0, 0}, {}, time, Policy::stop);
  };
  EXPECT_EQ(lean(0.9 * limit, 0).cause, Cause::none);
  EXPECT_EQ(lean(1.05 * limit, 0.1).cause, Cause::tilted);
  EXPECT_TRUE(lean(-1.05 * limit, 0.2).velocity.zero());
  const auto by_hand = monitor.check({1, 0, 0}, {}, 0.2, Policy::limit);
  EXPECT_EQ(by_hand.cause, Cause::tilted);
  EXPECT_NEAR(by_hand.velocity.vx, 0.3, 1e-9) << "an operator drives it down";
  EXPECT_EQ(lean(0.95 * limit, 0.3).cause, Cause::tilted) << "it has to come well below";
  EXPECT_EQ(lean(0.85 * limit, 0.4).cause, Cause::none);
}

}  // namespace
}  // namespace adit::nav::test
