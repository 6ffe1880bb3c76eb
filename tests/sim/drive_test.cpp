// SPDX-License-Identifier: Apache-2.0
// Scripted drives and what they record.
#include "sim/drive/drive_recording.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "core/config/platform_file.hpp"

namespace adit::sim {
namespace {

std::shared_ptr<const World> square_room() {
  const std::vector<Box> boxes{{-0.2, 0, 0, 10, 0, 3},
                               {10, 10.2, 0, 10, 0, 3},
                               {0, 10, -0.2, 0, 0, 3},
                               {0, 10, 10, 10.2, 0, 3},
                               {4, 5, 4, 5, 0, 2}};
  return std::make_shared<const World>(make_box_world(boxes, 0.0, 3.0).value());
}

DriveSpec square(double noise) {
  DriveSpec spec;
  spec.world = square_room();
  spec.platform = config::load_platform("wheeled").value();
  spec.start = {2, 2, 0};
  spec.steps = {StandFor{1.0}, DriveTo{{8, 2}}, DriveTo{{8, 8}}, TurnBy{-2 * M_PI, 1.2}, StandFor{0.5}};
  spec.noise = noise;
  return spec;
}

TEST(Drive, FollowsItsSteps) {
  const DriveRecording drive = record_drive(square(0.0)).value();
  const Pose3 end = drive.truth.back().pose;
  EXPECT_NEAR(end.position.x(), 8.0, 0.15);
  EXPECT_NEAR(end.position.y(), 8.0, 0.15);
  EXPECT_NEAR(drive.distance(), 12.0, 0.8);
  double turned = 0.0;
  for (std::size_t n = 1; n < drive.truth.size(); ++n)
    turned += wrap_angle(drive.truth[n].pose.yaw() - drive.truth[n - 1].pose.yaw());
  EXPECT_NEAR(turned, M_PI / 2 - 2 * M_PI, 0.15);
}

TEST(Drive, WithoutNoiseSensorsAgreeWithTheTruth) {
  const DriveSpec spec = square(0.0);
  const DriveRecording drive = record_drive(spec).value();
  const double time = static_cast<double>(drive.truth.back().stamp - kDriveStart) * 1e-9;
  EXPECT_NEAR(static_cast<double>(drive.sweeps.size()), time * 10, 1.0);
  EXPECT_NEAR(static_cast<double>(drive.imu.size()), time * 100, 5.0);
  EXPECT_NEAR(static_cast<double>(drive.wheels.size()), time * 50, 2.0);
  const Pose3 T_world_odom = Pose3::level(spec.start, 0.0);
  for (const WheelSample& wheels : drive.wheels) {
    const Pose3 truth = drive.truth_at(wheels.stamp);
    ASSERT_LT(((T_world_odom * wheels.pose).position - truth.position).head<2>().norm(), 0.02);
    ASSERT_LT((T_world_odom * wheels.pose).orientation.angularDistance(truth.orientation), 0.02);
  }
  // Every point, moved by the true pose of its own time, lies on a wall, the block, the floor or the ceiling.
  // A time off by 10 ms moves a hundredth of them away; columns of the grid at corners move very few.
  std::size_t astray = 0, all = 0;
  const Pose3 T_base_lidar = spec.platform.lidar().mounting.pose();
  for (const perception::Sweep& sweep : drive.sweeps)
    for (std::size_t n = 0; n < sweep.points.size(); n += 11) {
      const perception::TimedPoint& p = sweep.points[n];
      const auto at = sweep.stamp + static_cast<std::uint64_t>(static_cast<double>(p.time) * 1e9);
      const Eigen::Vector3d place =
          drive.truth_at(at) * T_base_lidar * Eigen::Vector3d(p.position.cast<double>());
      const auto near = [](double v, double wall) { return std::abs(v - wall) < 0.06; };
      const double x = place.x(), y = place.y(), z = place.z();
      const bool hit = near(x, 0) || near(x, 10) || near(y, 0) || near(y, 10) || near(z, 0) || near(z, 3) ||
                       near(z, 2) || near(x, 4) || near(x, 5) || near(y, 4) || near(y, 5);
      astray += !hit;
      ++all;
    }
  EXPECT_LT(static_cast<double>(astray), 5e-4 * static_cast<double>(all));
}

TEST(Drive, SameSpecificationGivesTheSameData) {
  DriveSpec spec = square(1.0);
  spec.steps = {DriveTo{{3, 2}}};
  const DriveRecording a = record_drive(spec).value(), b = record_drive(spec).value();
  spec.seed = 2;
  const DriveRecording c = record_drive(spec).value();
  ASSERT_EQ(a.sweeps.size(), b.sweeps.size());
  EXPECT_EQ(a.sweeps.back().points.size(), b.sweeps.back().points.size());
  EXPECT_EQ(a.sweeps.back().points.back().position, b.sweeps.back().points.back().position);
  EXPECT_EQ(a.imu.back().accel, b.imu.back().accel);
  EXPECT_NE(a.imu.back().accel, c.imu.back().accel);
}

TEST(Drive, PlaysInTheOrderOfTime) {
  struct Order : DriveSink {
    void on_imu(const perception::ImuSample& s) override { see(s.stamp); }
    void on_wheels(const WheelSample& s) override { see(s.stamp); }
    void on_truth(const TruthSample& s) override { see(s.stamp); }
    void on_sweep(perception::Sweep&& s) override {
      see(DriveRecording::end_of(s));
      ++sweeps;
    }
    void see(std::uint64_t stamp) {
      sorted = sorted && stamp >= last;
      last = stamp;
      ++all;
    }
    bool sorted{true};
    std::uint64_t last{};
    std::size_t sweeps{}, all{};
  } order;
  DriveSpec spec = square(1.0);
  spec.steps = {DriveTo{{3, 2}}};
  const DriveRecording drive = record_drive(spec).value();
  drive.play(order);
  EXPECT_TRUE(order.sorted);
  EXPECT_EQ(order.sweeps, drive.sweeps.size());
  EXPECT_EQ(order.all, drive.sweeps.size() + drive.imu.size() + drive.wheels.size() + drive.truth.size());
}

TEST(Drive, PathThroughAWallIsAnError) {
  DriveSpec spec = square(1.0);
  spec.steps = {DriveTo{{12, 2}}};
  const Result<DriveRecording> drive = record_drive(spec);
  ASSERT_FALSE(drive.ok());
  EXPECT_THAT(drive.error().text, testing::HasSubstr("touches the world at (9."));
}

TEST(Drive, StepsOutOfRangeAreErrors) {
  for (const DriveStep& bad : std::vector<DriveStep>{DriveTo{{3, 2}, 9.0}, DriveTo{{3, NAN}, 1.0},
                                                     TurnBy{1.0, 9.0}, TurnBy{NAN, 1.0}, StandFor{-1.0}}) {
    DriveSpec spec = square(1.0);
    spec.steps = {bad};
    EXPECT_EQ(record_drive(spec).reason(), Reason::out_of_range);
  }
}

TEST(Drive, DustReturnsTakeTheirShare) {
  DriveSpec spec = square(1.0);
  spec.steps = {StandFor{0.3}};
  const DriveRecording clean = record_drive(spec).value();
  spec.dust = 0.2;
  const DriveRecording dusty = record_drive(spec).value();
  const auto nearer = [](const DriveRecording& drive, float range) {
    const std::vector<perception::TimedPoint>& points = drive.sweeps[0].points;
    return static_cast<double>(
               std::count_if(points.begin(), points.end(),
                             [&](const perception::TimedPoint& p) { return p.position.norm() < range; })) /
           static_cast<double>(points.size());
  };
  // Nothing but dust is nearer than 1.5 m; a third of it is.
  EXPECT_LT(nearer(clean, 1.5f), 0.001);
  EXPECT_NEAR(nearer(dusty, 1.5f), 0.2 * 0.39, 0.02);
}

TEST(Drive, PlanarScansHaveNoTimes) {
  DriveSpec spec = square(1.0);
  spec.realistic = false;
  spec.lidar = LidarParams::planar();
  spec.steps = {DriveTo{{3, 2}}};
  const DriveRecording drive = record_drive(spec).value();
  ASSERT_FALSE(drive.sweeps.empty());
  EXPECT_TRUE(drive.sweeps[0].planar);
  EXPECT_FALSE(drive.sweeps[0].timed);
  EXPECT_NEAR(drive.sweeps[0].points[0].position.z(), 0.0f, 1e-6f);
  EXPECT_TRUE(drive.imu.empty());
}

}  // namespace
}  // namespace adit::sim
