// SPDX-License-Identifier: Apache-2.0
// Scans of a robot's lidar, with the simulator's default noise, laid onto the planes of earlier ones.
#include "perception/odometry/align.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/config/platform_file.hpp"
#include "core/time/random.hpp"
#include "sim/drive/drive_recording.hpp"
#include "sim/world/generate.hpp"

namespace adit::perception {
namespace {

using namespace sim;

/// A furnished hall of 14 x 12 m, or another one of 10 x 16 m.
std::shared_ptr<const World> furnished_hall(bool other) {
  const double x = other ? 10 : 14, y = other ? 16 : 12;
  std::vector<Box> boxes{
      {-0.2, 0, 0, y, 0, 3}, {x, x + 0.2, 0, y, 0, 3}, {0, x, -0.2, 0, 0, 3}, {0, x, y, y + 0.2, 0, 3}};
  const std::vector<Box> inside =
      other
          ? std::vector<Box>{{3, 3.3, 3, 9, 0, 3}, {6, 9, 8, 8.4, 0, 2}, {7.5, 7.7, 3, 6, 0, 3}}
          : std::vector<Box>{
                {4, 5, 4, 5, 0, 2}, {8, 8.6, 7, 9, 0, 1.2}, {10, 11, 2.5, 3.2, 0, 3}, {5, 5.3, 8, 8.3, 0, 3}};
  boxes.insert(boxes.end(), inside.begin(), inside.end());
  return std::make_shared<const World>(make_box_world(boxes, 0.0, 3.0).value());
}

/// One scan in base_link and where it was taken.
struct PlacedScan {
  Pose3 pose{};
  std::vector<Eigen::Vector3f> points{};
};

/// Scans at rest, as deskewing leaves them, each at another place of a round through the world.
std::vector<PlacedScan> scans(std::shared_ptr<const World> world, const std::vector<Eigen::Vector2d>& places,
                              std::uint64_t seed) {
  DriveSpec spec;
  spec.world = std::move(world);
  spec.platform = config::load_platform("wheeled").value();
  spec.start = {places.front().x(), places.front().y(), 0};
  spec.seed = seed;
  for (const Eigen::Vector2d& place : places) {
    spec.steps.emplace_back(DriveTo{place});
    spec.steps.emplace_back(StandFor{0.6});
  }
  const DriveRecording drive = record_drive(spec).value();
  const Pose3 T_base_lidar = spec.platform.lidar().mounting.pose();
  std::vector<PlacedScan> out;
  for (const Sweep& sweep : drive.sweeps) {
    const std::uint64_t end = DriveRecording::end_of(sweep);
    const Pose3 pose = drive.truth_at(end);
    const Pose3 moved = drive.truth_at(sweep.stamp - 100'000'000).inverse() * pose;
    if (moved.position.norm() > 0.01) continue;
    if (!out.empty() && (out.back().pose.position - pose.position).norm() < 0.3) continue;
    PlacedScan scan{pose, {}};
    for (const TimedPoint& p : sweep.points)
      scan.points.push_back((T_base_lidar * Eigen::Vector3d(p.position.cast<double>())).cast<float>());
    out.push_back(std::move(scan));
  }
  return out;
}

VoxelPlanes planes_of(const std::vector<PlacedScan>& all) {
  std::vector<Eigen::Vector3f> points;
  for (const PlacedScan& scan : all)
    for (const Eigen::Vector3f& p : scan.points)
      points.push_back((scan.pose * Eigen::Vector3d(p.cast<double>())).cast<float>());
  return align_target(points);
}

const std::vector<Eigen::Vector2d> kRound{{2, 2},      {4.5, 2},  {7, 1.5},  {9.5, 1.5},
                                          {12.5, 1.5}, {12.5, 4}, {12.5, 7}, {12.5, 10.5},
                                          {9, 10.5},   {6, 10.5}, {2, 10.5}, {2, 6}};
const std::vector<Eigen::Vector2d> kAgain{{2, 3},      {2.5, 2},  {5.5, 1.8},   {8.3, 1.7},  {12, 2.3},
                                          {12.2, 5.2}, {12.4, 9}, {10.4, 10.3}, {7.2, 10.6}, {4, 10.4}};
/// The first hall as it was seen on one round.
const VoxelPlanes& hall_target() {
  static const VoxelPlanes kTarget = planes_of(scans(furnished_hall(false), kRound, 1));
  return kTarget;
}

constexpr double kDegree = M_PI / 180;

TEST(Align, FindsScansUpToHalfAMetreAndTenDegreesFromTheGuess) {
  const VoxelPlanes& target = hall_target();
  const std::vector<PlacedScan> later = scans(furnished_hall(false), kAgain, 2);
  ASSERT_GE(later.size(), 9u);
  Random random(1);
  int tried = 0;
  for (const PlacedScan& scan : later)
    for (int n = 0; n < 6; ++n, ++tried) {
      // The corners of what is promised, and places within.
      const double way = n < 3 ? 0.5 : random.uniform(0, 0.5), to = random.uniform(-M_PI, M_PI);
      const double turn = (n < 3 ? (n % 2 == 0 ? 10 : -10) : random.uniform(-10, 10)) * kDegree;
      const Pose3 guess{
          scan.pose.position + Eigen::Vector3d(way * std::cos(to), way * std::sin(to), 0.03),
          Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())) * scan.pose.orientation};
      const Alignment found = align(target, scan.points, guess,
                                    {.search_distance = 0.5, .search_angle = 10 * kDegree, .window = 0.3});
      EXPECT_LT((found.pose.position - scan.pose.position).norm(), 0.06) << tried;
      EXPECT_LT(found.pose.orientation.angularDistance(scan.pose.orientation), 0.7 * kDegree) << tried;
      EXPECT_GT(found.overlap, 0.75) << tried;
      EXPECT_TRUE(found.localizability.all_strong()) << tried;
      EXPECT_TRUE(found.converged) << tried;
    }
}

TEST(Align, SaysThatAScanOfAnotherRoomDoesNotFit) {
  const VoxelPlanes& target = hall_target();
  const std::vector<PlacedScan> elsewhere =
      scans(furnished_hall(true), {{1.5, 1.5}, {5, 1.5}, {8.8, 1.5}, {8.8, 4}, {8.8, 6.5}, {5, 6.8}}, 3);
  ASSERT_GE(elsewhere.size(), 5u);
  for (const PlacedScan& scan : elsewhere)
    for (const double shift : {0.0, 1.0, 2.0, 3.5}) {
      const Pose3 guess{scan.pose.position + Eigen::Vector3d(shift, shift, 0), scan.pose.orientation};
      const Alignment found = align(target, scan.points, guess,
                                    {.search_distance = 0.5, .search_angle = 10 * kDegree, .window = 0.3});
      EXPECT_LT(found.overlap, 0.55) << scan.pose.position.transpose();
    }
}

TEST(Align, NothingToAlignHasNoOverlap) {
  const std::vector<PlacedScan> some = scans(furnished_hall(false), {{2, 2}, {4, 2}}, 1);
  const VoxelPlanes target = planes_of(some);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::vector<Eigen::Vector3f>& source :
       {std::vector<Eigen::Vector3f>{}, std::vector<Eigen::Vector3f>(2000, Eigen::Vector3f(nan, nan, nan))}) {
    const Alignment found = align(target, source, Pose3{});
    EXPECT_EQ(found.overlap, 0.0);
    EXPECT_FALSE(found.localizability.all_strong());
    EXPECT_TRUE(found.pose.position.allFinite());
  }
  const Alignment none = align(align_target({}), some[0].points, Pose3{});
  EXPECT_EQ(none.overlap, 0.0);
}

}  // namespace
}  // namespace adit::perception
