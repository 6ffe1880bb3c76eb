// SPDX-License-Identifier: Apache-2.0
// What is true of a map.
#include "sim/truth/map_truth.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace adit::sim {
namespace {

/// A room of 8 x 6 x 3 m with walls of 0.4 m and a pillar.
std::shared_ptr<const World> walled_room() {
  const std::vector<Box> boxes{{-0.4, 0, -0.4, 6.4, 0, 3},
                               {8, 8.4, -0.4, 6.4, 0, 3},
                               {0, 8, -0.4, 0, 0, 3},
                               {0, 8, 6, 6.4, 0, 3},
                               {4, 4.6, 2, 2.6, 0, 3}};
  return std::make_shared<const World>(make_box_world(boxes, 0.0, 3.0).value());
}

SeenSurface seen_in(const std::shared_ptr<const World>& world) {
  SeenSurface out(world, std::vector<Platform>(1));
  for (const double x : {1.5, 3.0, 6.5}) out.look(0, Pose3::level({x, 4.5, 0.3 * x}, 0.0));
  return out;
}

/// The true map: a voxel that holds seen surface is occupied; others are free in the room's air.
MapVoxels true_map(const SeenSurface& seen, const Eigen::Vector3f& shift = Eigen::Vector3f::Zero()) {
  MapVoxels out;
  const auto snap = [](float v) { return (std::floor(v / 0.2f + 1e-3f) + 0.5f) * 0.2f; };
  std::set<std::array<int, 3>> known;
  for (const Eigen::Vector3f& p : seen.points()) {
    const Eigen::Vector3f centre(snap(p.x()), snap(p.y()), snap(p.z()));
    if (known.insert({int(centre.x() * 100), int(centre.y() * 100), int(centre.z() * 100)}).second)
      out.occupied.push_back(centre + shift);
  }
  for (float x = 0.5f; x < 3.4f; x += 0.2f)
    for (float z = 0.5f; z < 2.5f; z += 0.2f) out.free.push_back(Eigen::Vector3f(x, 3.0f, z) + shift);
  return out;
}

TEST(MapTruth, SurfaceIsWhereRaysEnd) {
  const auto world = walled_room();
  const SeenSurface seen = seen_in(world);
  ASSERT_GT(seen.points().size(), 2000u);
  for (const Eigen::Vector3f& p : seen.points()) {
    const auto on = [](float v, float wall) { return std::abs(v - wall) < 0.06f; };
    EXPECT_TRUE(on(p.x(), 0) || on(p.x(), 8) || on(p.y(), 0) || on(p.y(), 6) || on(p.z(), 0) ||
                on(p.z(), 3) || on(p.x(), 4) || on(p.x(), 4.6f) || on(p.y(), 2) || on(p.y(), 2.6f))
        << p.transpose();
  }
  SeenSurface again(world, std::vector<Platform>(1));
  again.look(0, Pose3::level({1.5, 4.5, 0.45}, 0.0));
  const std::size_t once = again.points().size();
  again.look(0, Pose3::level({1.5, 4.5, 0.45}, 0.0));
  EXPECT_EQ(again.points().size(), once);
}

TEST(MapTruth, TheTrueMapIsRight) {
  const auto world = walled_room();
  const SeenSurface seen = seen_in(world);
  const MapJudgement judged = judge_map(true_map(seen), seen.points(), *world);
  EXPECT_EQ(judged.share, 1.0);
  EXPECT_EQ(judged.wrong(), 0.0);
  EXPECT_NEAR(judged.area, 0.01 * static_cast<double>(seen.points().size()), 1e-9);
}

TEST(MapTruth, HalfAMapHoldsHalfOfTheSurface) {
  const auto world = walled_room();
  const SeenSurface seen = seen_in(world);
  MapVoxels map = true_map(seen);
  std::erase_if(map.occupied, [](const Eigen::Vector3f& p) { return p.x() > 3.0f; });
  const MapJudgement judged = judge_map(map, seen.points(), *world);
  EXPECT_GT(judged.share, 0.2);
  EXPECT_LT(judged.share, 0.8);
  EXPECT_EQ(judged.wrong(), 0.0);
}

TEST(MapTruth, AMapBesideTheTruthIsWrong) {
  const auto world = walled_room();
  const SeenSurface seen = seen_in(world);
  // Every wall 0.7 m off along x and y, into the room and out of it.
  const MapJudgement judged = judge_map(true_map(seen, {0.7f, 0.7f, 0.0f}), seen.points(), *world);
  EXPECT_LT(judged.share, 0.9);
  EXPECT_GT(judged.wrong_occupied, 0.05);
  MapVoxels through = true_map(seen);
  through.free = {{-0.2f, 3, 1}, {4.3f, 2.3f, 1}, {3, 3, 1}, {3, 3, -0.3f}};
  EXPECT_EQ(judge_map(through, seen.points(), *world).wrong_free, 0.75);
}

TEST(MapTruth, EmptyMapHasNoShareAndNoErrors) {
  const auto world = walled_room();
  const MapJudgement judged = judge_map({}, seen_in(world).points(), *world);
  EXPECT_EQ(judged.share, 0.0);
  EXPECT_EQ(judged.wrong(), 0.0);
  EXPECT_EQ(judge_map({}, {}, *world).share, 0.0);
}

}  // namespace
}  // namespace adit::sim
