// SPDX-License-Identifier: Apache-2.0
// Ground and drops under a lidar whose attitude is known badly, and over slopes.
#include <gtest/gtest.h>

#include "nav/terrain/plane_fit.hpp"
#include "tests/nav/box_world.hpp"
#include "tests/nav/height_world.hpp"
#include "tests/nav/places.hpp"

namespace adit::nav::test {
namespace {

Eigen::Quaterniond attitude(double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
         AngleAxisd(roll, Vector3d::UnitX());
}

TEST(PlaneFit, IsNotTiltedByAWallOrALowerFloor) {
  std::vector<Eigen::Vector3f> samples;
  for (float x = -3; x < 3; x += 0.2f)
    for (float y = -3; y < 3; y += 0.2f)
      samples.emplace_back(x, y, 0.05f * x - 0.02f * y + (x > 2 ? 0.8f : y < -2 ? -0.6f : 0.0f));
  const PlanePrior prior{};
  const Eigen::Vector2f start = search_gradient(samples, prior, 0.02f, 0.15f);
  const PlaneFit fit = fit_plane(samples, prior, start, 0.02f, 0.1f, 0.025f);
  EXPECT_NEAR(fit.gradient.x(), 0.05f, 0.003f);
  EXPECT_NEAR(fit.gradient.y(), -0.02f, 0.003f);
  EXPECT_NEAR(fit.height, 0.0f, 0.005f);
  EXPECT_LT(fit.sigma_gradient, 0.005f);
}

/// Drop cells and passable ones, over all scans of a drive of 2 m along x on a plane. The attitude that is
/// reported is wrong by a roll and a pitch of `bias` (degrees).
std::pair<int, int> drops_on_plane(double slope, double bias, double yaw) {
  const Platform platform = wheeled();
  TerrainMap map(platform);
  const HeightWorld world{[=](double x, double) { return slope * x; }};
  std::mt19937 random(7);
  const Eigen::Quaterniond wrong = attitude(bias * M_PI / 180, bias * M_PI / 180, 0);
  const auto truth = attitude(0, -std::atan(slope), 0) * attitude(0, 0, yaw);
  LocalMapBuilder builder;
  std::pair<int, int> count{0, 0};
  for (int i = 0; i < 20; ++i) {
    const Pose3 body{{0.1 * i, 0, slope * 0.1 * i}, truth};
    map.add_scan(world.scan(platform, body, 16, 120, 0.02, random), {body.position, truth * wrong}, 0.1 * i);
    builder.make(map, {});
    for (const CellClass kind : builder.ground_classes()) {
      count.first += kind == CellClass::drop;
      count.second += kind != CellClass::unknown;
    }
  }
  return count;
}

TEST(TerrainTilt, FindsNoDropOnAPlaneHoweverItsBodyLeans) {
  for (const double degrees : {0.0, 10.0})
    for (const double bias : {0.0, 1.0, -2.0, 3.0})
      for (const double yaw : {0.0, 2.0}) {
        const auto [drops, passable] = drops_on_plane(std::tan(degrees * M_PI / 180), bias, yaw);
        EXPECT_GT(passable, 20000) << degrees << ' ' << bias << ' ' << yaw;
        EXPECT_LT(drops, passable / 1000) << degrees << ' ' << bias << ' ' << yaw;
      }
}

// A body that pitches by 2 degrees to and fro, as when it brakes, and an attitude that knows nothing of it.
TEST(TerrainTilt, RegistersAnUnreportedPitch) {
  const Platform platform = wheeled();
  TerrainMap map(platform);
  const HeightWorld world{[](double x, double y) { return std::fabs(y) > 2 ? 0.5 : 0.01 * std::sin(2 * x); }};
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    const double pitch = i < 10 ? 0.0 : 0.035;
    const Pose3 body{{0.1 * i, 0, 0}, attitude(0, pitch, 0)};
    map.add_scan(world.scan(platform, body, 16, 240, 0.01, random), Pose3::level({0.1 * i, 0, 0}, 0),
                 0.1 * i);
    for (const LocalPlace& cell : places(map))
      ASSERT_TRUE(cell.cost < 1 || std::fabs(cell.y) > 1.8f) << i << ": " << cell.x << ' ' << cell.y;
  }
  EXPECT_NEAR(map.tilt_error().x(), -0.035f, 0.006f);
  EXPECT_NEAR(map.ground().plane().gradient.x(), 0.0f, 0.01f)
      << "what the ground does is not what the body does";
}

TEST(TerrainTilt, FindsEveryEdgeFromTwoMetres) {
  int found = 0;
  for (int n = 0; n < 40; ++n) {
    const double depth = 0.2 + 0.8 * (n / 4) / 9.0, across = 0.3 * (n % 4);
    const Platform platform = wheeled();
    TerrainMap map(platform);
    const HeightWorld world{[=](double x, double y) { return x + std::tan(across) * y > 3 ? -depth : 0.0; }};
    std::mt19937 random(static_cast<unsigned>(n));
    bool seen = false;
    for (double x = 0.5; x <= 1.001 && !seen; x += 0.1) {
      const Pose3 body = Pose3::level({x, 0, 0}, 0);
      map.add_scan(world.scan(platform, body, 16, 180, 0.02, random), body, x);
      for (const LocalPlace& cell : places(map))
        seen |= cell.kind == CellClass::drop && cell.cost >= 1 && std::fabs(cell.y) < 0.3f &&
                std::fabs(cell.x - 3) < 0.35f;
    }
    found += seen;
    EXPECT_TRUE(seen) << depth << " m deep, " << across;
  }
  EXPECT_EQ(found, 40);
}

/// A sweep at whose begin and end the body pitches by up to `pitch` (rad), in the frame of its middle: behind
/// the robot each ring is at another elevation than ahead.
std::vector<Eigen::Vector3f> scan_while_pitching(const HeightWorld& world, const Platform& platform,
                                                 double pitch, std::mt19937& random) {
  constexpr int kParts = 64;
  std::vector<Eigen::Vector3f> points;
  for (int part = 0; part < kParts; ++part) {
    const double share = std::max(0.0, 2.0 * std::fabs(2.0 * part / kParts - 1.0) - 1.0);
    const Eigen::Quaterniond then = attitude(0, pitch * share, 0);
    for (const Eigen::Vector3f& p : world.scan(platform, {{0, 0, 0}, then}, 16, 512, 0.01, random)) {
      const double sector = (std::atan2(p.y(), p.x()) / M_PI + 1.0) / 2.0 * kParts;
      if (static_cast<int>(sector) == part) points.push_back(then.cast<float>() * p);
    }
  }
  return points;
}

TEST(TerrainTilt, RingsThatDriftDuringASweepMakeNoDrop) {
  const Platform platform = wheeled();
  TerrainMap map(platform);
  const HeightWorld world{[](double, double) { return 0.0; }};
  std::mt19937 random(5);
  for (int i = 0; i < 10; ++i) {
    map.add_scan(scan_while_pitching(world, platform, i < 3 ? 0.0 : 0.05, random), Pose3{}, 0.1 * i);
    for (const LocalPlace& cell : places(map))
      ASSERT_TRUE(cell.cost < 1 || cell.kind != CellClass::drop) << i << ": " << cell.x << ' ' << cell.y;
  }
}

// Rays that a car's paint mirrored end far below ground that other rays measured.
TEST(TerrainTilt, AMirrorMakesNoDrop) {
  const Platform platform = wheeled();
  TerrainMap map(platform);
  const HeightWorld world{[](double, double) { return 0.0; }};
  std::mt19937 random(3);
  for (int i = 0; i < 10; ++i) {
    auto scan = world.scan(platform, Pose3{}, 64, 180, 0.01, random);
    for (Eigen::Vector3f& p : scan)
      if (p.z() < 0.1f && std::fabs(p.y()) < 0.15f && p.x() > 2.1f && p.x() < 2.9f)
        p = Eigen::Vector3f(0, 0, 0.5f) + 1.5f * (p - Eigen::Vector3f(0, 0, 0.5f));
    map.add_scan(scan, Pose3{}, 0.1 * i);
  }
  for (const LocalPlace& cell : places(map))
    EXPECT_TRUE(cell.cost < 1 || cell.kind != CellClass::drop) << cell.x << ' ' << cell.y;
}

}  // namespace
}  // namespace adit::nav::test
