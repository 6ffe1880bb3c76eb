// SPDX-License-Identifier: Apache-2.0
// The odometry on simulated drives with the simulator's default noise.
#include <gtest/gtest.h>

#include <utility>

#include "core/config/platform_file.hpp"
#include "perception/odometry/lidar_odometry.hpp"
#include "sim/drive/drive_recording.hpp"
#include "sim/drive/odometry_runner.hpp"

namespace adit::perception {
namespace {

using namespace sim;

std::shared_ptr<const World> hall() {
  const std::vector<Box> boxes{{-0.2, 0, 0, 12, 0, 3},   {14, 14.2, 0, 12, 0, 3}, {0, 14, -0.2, 0, 0, 3},
                               {0, 14, 12, 12.2, 0, 3},  {4, 5, 4, 5, 0, 2},      {8, 8.6, 7, 9, 0, 1.2},
                               {10, 11, 2.5, 3.2, 0, 3}, {5, 5.3, 8, 8.3, 0, 3}};
  return std::make_shared<const World>(make_box_world(boxes, 0.0, 3.0).value());
}

DriveSpec round_trip(std::uint64_t seed) {
  DriveSpec spec;
  spec.world = hall();
  spec.platform = config::load_platform("wheeled").value();
  spec.start = {2, 2, 0};
  spec.steps = {StandFor{1.5},         DriveTo{{7, 1.5}},  DriveTo{{12.5, 1.5}}, DriveTo{{12.5, 10.5}},
                TurnBy{2 * M_PI, 1.4}, DriveTo{{2, 10.5}}, DriveTo{{2, 2}},      StandFor{0.5}};
  spec.seed = seed;
  return spec;
}

struct Outcome {
  double worst{}, end{}, end_yaw{}, worst_tilt{};
  bool honest{true};  ///< No error above 5 sigma + 0.1 m.
  std::size_t lost{}, poses{}, slips{};
  Localisation last{};
};

/// Hands a recording to the odometry; each sweep comes 60 ms after its end.
void play(const DriveRecording& drive, OdometryRunner& runner, bool imu, bool wheels) {
  std::size_t i = 0, w = 0;
  for (const Sweep& sweep : drive.sweeps) {
    const std::uint64_t until = DriveRecording::end_of(sweep) + 60'000'000;
    for (; imu && i < drive.imu.size() && drive.imu[i].stamp < until; ++i) runner.add(drive.imu[i]);
    for (; wheels && w < drive.wheels.size() && drive.wheels[w].stamp < until; ++w)
      runner.add(BodyMotion{drive.wheels[w].stamp, drive.wheels[w].pose});
    runner.add(Sweep(sweep));
  }
  runner.finish();
}

/// Runs the odometry over a recording. `imu`, `wheels`: which sensors of motion it has.
Outcome run(const DriveRecording& drive, const Platform& on, bool imu, bool wheels) {
  Platform platform = on;
  if (!platform.imu) platform.imu = ImuConfig{.mounting = {.z = 0.2}};
  auto params = LidarOdometryParams::of(platform, wheels);
  params.motion.has_imu = imu;
  Outcome out;
  std::optional<Pose3> T_world_odom;
  OdometryRunner runner(platform, params, imu || wheels, [&](const OdometryRunner::Step& step) {
    if (!step.located) return;
    const Pose3 truth = drive.truth_at(step.end);
    if (!T_world_odom) T_world_odom = truth * step.state.pose.inverse();
    const Pose3 believed = *T_world_odom * step.state.pose;
    const double error = (believed.position - truth.position).head<2>().norm();
    out.worst = std::max(out.worst, error);
    out.end = error;
    out.end_yaw = std::abs(wrap_angle(believed.yaw() - truth.yaw()));
    out.honest = out.honest && error <= 5 * step.state.sigma() + 0.1;
    out.lost += step.state.health == Localisation::lost;
    out.slips += step.state.wheels_slip;
    out.last = step.state.health;
    ++out.poses;
  });
  play(drive, runner, imu, wheels);
  return out;
}

TEST(OdometryOnADrive, KnowsWhereItIsWithAnySensorsOfMotion) {
  const DriveSpec spec = round_trip(3);
  const DriveRecording drive = record_drive(spec).value();
  for (const bool imu : {true, false})
    for (const bool wheels : {true, false}) {
      const Outcome found = run(drive, spec.platform, imu, wheels);
      SCOPED_TRACE(std::string(imu ? "IMU " : "") + (wheels ? "wheels" : ""));
      EXPECT_GT(found.poses, 250u);
      EXPECT_EQ(found.lost, 0u);
      EXPECT_LT(found.worst, imu || wheels ? 0.12 : 0.3);  // 0.3 % of 40 m with a sensor of motion.
      EXPECT_LT(found.end_yaw, 0.01);
      EXPECT_TRUE(found.honest);
      EXPECT_EQ(found.last, Localisation::ok);
    }
}

TEST(OdometryOnADrive, PhantomReturnsAndWalkersDoNotMisleadIt) {
  DriveSpec spec = round_trip(4);
  spec.dust = 0.2;
  spec.people = {PersonSpec{.path = {{3, 6}, {9, 6}}}, PersonSpec{.path = {{6, 2.5}, {6, 11}}}};
  const DriveRecording drive = record_drive(spec).value();
  const Outcome found = run(drive, spec.platform, true, true);
  EXPECT_EQ(found.lost, 0u);
  EXPECT_LT(found.worst, 0.15);
}

/// A drive in a smooth tunnel of which the lidar sees no end but near one.
DriveSpec in_a_tunnel(std::vector<DriveStep> steps) {
  DriveSpec spec;
  const std::vector<Box> boxes{{-0.2, 0, -1.7, 1.7, 0, 3},
                               {70, 70.2, -1.7, 1.7, 0, 3},
                               {0, 70, -1.7, -1.5, 0, 3},
                               {0, 70, 1.5, 1.7, 0, 3}};
  spec.world = std::make_shared<const World>(make_box_world(boxes, 0.0, 3.0).value());
  spec.platform = config::load_platform("wheeled").value();
  spec.start = {2, 0, 0};
  spec.steps = std::move(steps);
  spec.lidar.max_range = 15.0;
  return spec;
}

TEST(OdometryOnADrive, ASmoothTunnelIsLeftToTheWheels) {
  const DriveSpec spec = in_a_tunnel({StandFor{1.5}, DriveTo{{68, 0}, 2.0}});
  const DriveRecording drive = record_drive(spec).value();
  const Outcome found = run(drive, spec.platform, true, true);
  EXPECT_LT(found.worst, 0.5);  // The wheels alone are 1 % off.
  EXPECT_TRUE(found.honest);
  EXPECT_EQ(found.lost, 0u);
}

/// The largest error of the height on the way to the end of a level corridor and around the corner, m, with
/// wheels and lidar alone, and by how much it changes in half a minute of standing there.
std::pair<double, double> height_errors(std::uint64_t seed) {
  DriveSpec spec;
  const std::vector<Box> boxes{{-1.6, 51.6, -1.6, -1.3, 0, 3}, {-1.6, -1.3, -1.6, 1.6, 0, 3},
                               {-1.6, 48.7, 1.3, 1.6, 0, 3},   {51.3, 51.6, -1.6, 31.6, 0, 3},
                               {48.4, 48.7, 1.3, 31.6, 0, 3},  {48.4, 51.6, 31.3, 31.6, 0, 3}};
  spec.world = std::make_shared<const World>(make_box_world(boxes, 0.0, 3.0).value());
  spec.platform = config::load_platform("wheeled").value();
  spec.seed = seed;
  spec.steps = {StandFor{2.0}, DriveTo{{50, 0}, 2.0}, DriveTo{{50, 28}, 2.0}, StandFor{30.0}};
  const DriveRecording drive = record_drive(spec).value();
  double worst = 0, low = 1e3, high = -1e3;
  OdometryRunner runner(
      spec.platform, LidarOdometryParams::of(spec.platform), true, [&](const OdometryRunner::Step& step) {
        if (!step.located) return;
        const double error = step.state.pose.position.z() - drive.truth_at(step.end).position.z();
        worst = std::max(worst, std::abs(error));
        if (drive.truth.back().stamp - step.end > 29'000'000'000) return;
        low = std::min(low, error);
        high = std::max(high, error);
      });
  play(drive, runner, false, true);
  return {worst, high - low};
}

TEST(OdometryOnADrive, TheHeightStaysOnLevelGround) {
  const auto [worst, standing] = height_errors(1);
  EXPECT_LT(worst, 0.35);
  EXPECT_LT(standing, 0.01);
}

TEST(OdometryOnADrive, WheelsThatSpinInASmoothTunnelAreNotBelieved) {
  const DriveSpec spec = in_a_tunnel({StandFor{1.5}, DriveTo{{32, 0}, 2.0}, StandFor{32}});
  DriveRecording drive = record_drive(spec).value();
  // For the last 30 s the wheels turn at 0.4 m/s.
  const std::uint64_t begin = drive.wheels.back().stamp - 30'000'000'000;
  for (WheelSample& each : drive.wheels)
    if (each.stamp > begin)
      each.pose.position +=
          each.pose.orientation * Eigen::Vector3d(0.4e-9 * static_cast<double>(each.stamp - begin), 0, 0);
  const Outcome found = run(drive, spec.platform, true, true);
  EXPECT_TRUE(found.honest) << found.worst;
  EXPECT_LT(found.worst, 8.0);  // 12 m by the wheels; by an IMU that leans by 0.1 degrees 7.7 m.
  EXPECT_GT(found.slips, 250u);
  EXPECT_EQ(found.lost, 0u);
}

TEST(OdometryOnADrive, ADoorIntoAnotherRoomIsNoContradiction) {
  DriveSpec spec;
  // Two rooms with a door of 1.2 m in a wall of 0.3 m between them, and a pillar behind it.
  const std::vector<Box> boxes{
      {-0.2, 0, -4, 4, 0, 3}, {6, 6.3, -4, -0.6, 0, 3},  {6, 6.3, 0.6, 4, 0, 3},      {0, 6, -4.2, -4, 0, 3},
      {0, 6, 4, 4.2, 0, 3},   {6.3, 20, -8.2, -8, 0, 3}, {6.3, 20, 8, 8.2, 0, 3},     {20, 20.2, -8, 8, 0, 3},
      {6, 6.3, -8, -4, 0, 3}, {6, 6.3, 4, 8, 0, 3},      {9.5, 10.5, -0.5, 0.5, 0, 3}};
  spec.world = std::make_shared<const World>(make_box_world(boxes, 0.0, 3.0).value());
  spec.platform = config::load_platform("wheeled").value();
  spec.start = {2, 0, 0};
  spec.steps = {StandFor{1.5},          DriveTo{{7.5, 0}, 1.5}, DriveTo{{8, 4}, 1.5},   DriveTo{{15, 5}, 1.5},
                DriveTo{{15, -4}, 1.5}, DriveTo{{8, -4}, 1.5},  DriveTo{{7.5, 0}, 1.5}, DriveTo{{2, 0}, 1.5}};
  const DriveRecording drive = record_drive(spec).value();
  for (const bool imu : {true, false}) {
    const Outcome found = run(drive, spec.platform, imu, true);
    EXPECT_EQ(found.lost, 0u);
    EXPECT_LT(found.worst, 0.12);
    EXPECT_TRUE(found.honest);
    EXPECT_EQ(found.last, Localisation::ok);
  }
}

TEST(OdometryOnADrive, TheSameDataGiveTheSamePoses) {
  DriveSpec spec = round_trip(5);
  spec.steps.resize(3);
  const DriveRecording drive = record_drive(spec).value();
  const Outcome a = run(drive, spec.platform, true, true), b = run(drive, spec.platform, true, true);
  EXPECT_EQ(a.worst, b.worst);
  EXPECT_EQ(a.end, b.end);
}

}  // namespace
}  // namespace adit::perception
