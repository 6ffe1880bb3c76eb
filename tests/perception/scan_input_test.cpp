// SPDX-License-Identifier: Apache-2.0
#include "perception/input/scan_input.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace adit::perception {
namespace {

constexpr std::uint64_t kStart = 1'000'000'000'000;  // ns
const float kNan = std::numeric_limits<float>::quiet_NaN();

Platform robot() {
  Platform p;
  p.length = 0.8;
  p.width = 0.6;
  p.lidars = {
      LidarConfig{.mounting = {.x = 0.2, .z = 0.5}, .frame = "lidar", .min_range = 0.4, .max_range = 50}};
  return p;
}

/// A body that drives with 2 m/s and turns with 1.5 rad/s from the origin on.
Result<Pose3> driven(std::uint64_t stamp) {
  const double t = static_cast<double>(stamp - kStart) * 1e-9, yaw = 1.5 * t;
  return Pose3::level({2 / 1.5 * std::sin(yaw), 2 / 1.5 * (1 - std::cos(yaw)), yaw}, 0);
}

Result<Pose3> standing(std::uint64_t) { return Pose3{}; }

Sweep of(std::vector<Eigen::Vector3f> points) {
  Sweep sweep;
  sweep.stamp = kStart;
  for (const Eigen::Vector3f& p : points) sweep.points.push_back({p, 0, 0, 0});
  return sweep;
}

TEST(ScanInput, DeskewsATurnWhileDriving) {
  ScanInput input(robot());
  const Pose3 T_base_lidar = robot().lidar().mounting.pose();
  // A wall post every few degrees, each seen by the column of its own time.
  Sweep sweep;
  sweep.stamp = kStart;
  sweep.timed = true;
  std::vector<Eigen::Vector3d> truth;
  for (int i = 0; i < 360; ++i) {
    const double angle = i * M_PI / 180, time = 0.1 * i / 359;
    const Eigen::Vector3d place(8 * std::cos(angle), 8 * std::sin(angle), 0);
    const Pose3 T_odom_lidar = *driven(kStart + static_cast<std::uint64_t>(time * 1e9)) * T_base_lidar;
    sweep.points.push_back({(T_odom_lidar.inverse() * place).cast<float>(), static_cast<float>(time), 0, 0});
    truth.push_back(place);
  }
  const auto scan = input.add(sweep, 0, "lidar", driven);
  ASSERT_TRUE(scan) << scan.error().text;
  ASSERT_TRUE(*scan);
  EXPECT_TRUE((*scan)->deskewed);
  EXPECT_NEAR(static_cast<double>((*scan)->stamp - kStart), 1e8, 100);
  ASSERT_EQ((*scan)->points.size(), truth.size());
  const Pose3 T_odom_end = *driven((*scan)->stamp);
  double worst = 0, raw = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    worst = std::max(worst, (T_odom_end * (*scan)->points[i].cast<double>() - truth[i]).norm());
    raw = std::max(raw,
                   (T_odom_end * (T_base_lidar * sweep.points[i].position.cast<double>()) - truth[i]).norm());
  }
  EXPECT_LT(worst, 0.003);
  EXPECT_GT(raw, 0.5) << "without it";
}

TEST(ScanInput, TheMountingIsTakenFromTheFileOrFromTfStatic) {
  ScanInput input(robot());
  const auto by_file = input.add(of({{3, 0, 0}}), 0, "/lidar", standing);
  ASSERT_TRUE(by_file) << by_file.error().text;
  EXPECT_LT(((*by_file)->points.at(0) - Eigen::Vector3f(3.2f, 0, 0.5f)).norm(), 1e-5f);
  const auto in_base = input.add(of({{3, 0, 0.1f}}), 0, "base_link", standing);
  EXPECT_EQ((*in_base)->points.at(0), Eigen::Vector3f(3, 0, 0.1f));
  const auto unknown = input.add(of({{3, 0, 0}}), 0, "velodyne", standing);
  EXPECT_EQ(unknown.reason(), Reason::frame_unknown);
  EXPECT_THAT(unknown.error().text, testing::HasSubstr("'velodyne'"));
  ASSERT_TRUE(input.add_transform("base_link", "velodyne", Pose3::level({0, 0, M_PI}, 1)));
  const auto known = input.add(of({{3, 0, 0}}), 0, "velodyne", standing);
  ASSERT_TRUE(known);
  EXPECT_LT(((*known)->points.at(0) - Eigen::Vector3f(-3, 0, 1)).norm(), 1e-5f);
}

TEST(ScanInput, LeavesOutPointsThatAreNoReturn) {
  ScanInput input(robot());
  const auto scan =
      input.add(of({{kNan, 1, 0}, {0.1f, 0, 0}, {60, 0, 0}, {-0.5f, 0.1f, -0.3f}, {3, 0, 0}, {0, 0, 1.5f}}),
                0, "lidar", standing);
  ASSERT_TRUE(scan) << scan.error().text;
  const ScanCounts& counts = (*scan)->counts;
  EXPECT_EQ(counts.not_finite, 1U);
  EXPECT_EQ(counts.out_of_range, 2U);
  EXPECT_EQ(counts.own_body, 1U);
  EXPECT_EQ(counts.used, 2U) << "the ceiling above the body is not its own";
}

TEST(ScanInput, AScanWithoutAnyReturnIsRefused) {
  ScanInput input(robot());
  EXPECT_EQ(input.add(of({}), 0, "lidar", standing).reason(), Reason::scan_empty);
  EXPECT_EQ(input.add(of({{kNan, kNan, kNan}, {kNan, 0, 0}}), 0, "lidar", standing).reason(),
            Reason::scan_empty);
  EXPECT_EQ(input.add(of({{0.1f, 0, 0}, {0, 0.2f, 0}}), 0, "lidar", standing).reason(), Reason::scan_empty)
      << "a bag over the lidar";
}

/// A scan of the ground and of what stands 1 m above it, `n` returns of each.
Sweep of_ground(int n) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < n; ++i) {
    const float a = 0.1f * static_cast<float>(i);
    points.push_back({4 * std::cos(a), 4 * std::sin(a), -0.5f});
    points.push_back({4 * std::cos(a), 4 * std::sin(a), 0.5f});
  }
  return of(points);
}

TEST(ScanInput, AcceptsEmptyScansOfPlanarSensors) {
  Platform p = robot();
  p.lidars[0].rings = 1;
  ScanInput level(p), tilted(p), laser(p);
  EXPECT_EQ(level.add(of({{kNan, 0, 0}}), 0, "lidar", standing).reason(), Reason::scan_empty)
      << "it never saw anything";
  ASSERT_TRUE(level.add(of({{3, 0, 0}}), 0, "lidar", standing));
  EXPECT_TRUE(level.add(of({}), 0, "lidar", standing)) << "one level ring in the open";
  ASSERT_TRUE(tilted.add(of_ground(40), 0, "lidar", standing));
  EXPECT_EQ(tilted.add(of({}), 0, "lidar", standing).reason(), Reason::scan_empty) << "it saw the ground";
  Sweep nothing = of({});
  nothing.planar = true;
  EXPECT_TRUE(laser.add(nothing, 0, "lidar", standing));
}

TEST(ScanInput, ALidarThatSeesNoGroundBelowItIsMountedOtherwise) {
  ScanInput input(robot());
  EXPECT_TRUE(input.add(of_ground(200), 0, "lidar", standing));
  Sweep turned = of_ground(200);
  for (TimedPoint& point : turned.points) point.position.z() = std::fabs(point.position.z());
  const auto scan = input.add(turned, 0, "lidar", standing);
  EXPECT_EQ(scan.reason(), Reason::lidar_mounting);
  EXPECT_THAT(scan.error().text, testing::HasSubstr("'lidar'"));
  Platform flying = robot();
  flying.drive = Drive::aerial;
  EXPECT_TRUE(ScanInput(flying).add(turned, 0, "lidar", standing));
}

TEST(ScanInput, ALidarUnderTheFloorIsRefused) {
  ScanInput input(robot());
  ASSERT_TRUE(input.add_transform("base_link", "velodyne", Pose3::level({0, 0, 0}, -0.4)));
  const auto scan = input.add(of({{3, 0, 1}}), 0, "velodyne", standing);
  EXPECT_EQ(scan.reason(), Reason::lidar_mounting);
  EXPECT_THAT(scan.error().text, testing::HasSubstr("0.4"));
  ASSERT_TRUE(input.add_transform("base_link", "velodyne", Pose3::level({0.1, 0, 0}, 0.4)));
  const auto repaired = input.add(of({{3, 0, 1}}), 0, "velodyne", standing);
  ASSERT_TRUE(repaired) << repaired.error().text;
  EXPECT_LT(((*repaired)->parts[0].origin - Eigen::Vector3d(0.1, 0, 0.4)).norm(), 1e-6)
      << "where it really is";
}

TEST(ScanInput, AnOvertakenScanIsRefused) {
  ScanInput input(robot());
  Sweep sweep = of({{3, 0, 0}});
  ASSERT_TRUE(input.add(sweep, 0, "lidar", standing));
  sweep.stamp -= 100'000'000;
  EXPECT_EQ(input.add(sweep, 0, "lidar", standing).reason(), Reason::sample_stale);
  sweep.stamp = 5;
  EXPECT_TRUE(input.add(sweep, 0, "lidar", standing)) << "the driver's clock was set back";
}

TEST(ScanInput, ManyOvertakenScansAreReported) {
  ScanInput input(robot());
  int late = 0, reported = 0;
  // Two drivers on one topic, one of them 50 ms behind.
  for (std::uint64_t n = 0; n < 40; ++n) {
    Sweep sweep = of({{3, 0, 0}});
    sweep.stamp = kStart + n * 50'000'000 - (n % 2) * 80'000'000;
    const auto scan = input.add(sweep, 0, "lidar", standing);
    late += scan.reason() == Reason::sample_stale;
    reported += scan.reason() == Reason::sensor_times;
  }
  EXPECT_EQ(late, 3);
  EXPECT_EQ(reported, 17);
  // One in twenty is the network's.
  ScanInput usual(robot());
  for (std::uint64_t n = 0; n < 200; ++n) {
    Sweep sweep = of({{3, 0, 0}});
    sweep.stamp = kStart + (100 + n) * 100'000'000 - (n % 20 == 19 ? 150'000'000 : 0);
    const auto scan = usual.add(sweep, 0, "lidar", standing);
    if (!scan) {
      EXPECT_EQ(scan.reason(), Reason::sample_stale) << n;
    }
  }
}

TEST(ScanInput, ASecondLidarThatIsSilentIsReported) {
  Platform p = robot();
  p.lidars.push_back({.mounting = {.x = -0.2, .z = 0.4}, .topic = "rear", .frame = "rear"});
  ScanInput input(p);
  std::size_t warned = 0;
  for (std::uint64_t n = 0; n < 20; ++n) {
    Sweep front = of({{4, 0, 0}});
    front.stamp = kStart + n * 100'000'000;
    const auto scan = input.add(front, 0, "lidar", standing);
    ASSERT_TRUE(scan && *scan);
    for (const ScanWarning& warning : (*scan)->warnings) {
      EXPECT_EQ(warning.reason, Reason::sensor_silent);
      EXPECT_THAT(warning.text, testing::HasSubstr("'rear'"));
      ++warned;
    }
  }
  EXPECT_EQ(warned, 11U) << "after a second";
}

TEST(ScanInput, AnImuThatIsSilentOrHasAnotherClockIsReported) {
  Platform p = robot();
  p.imu = ImuConfig{};
  for (const std::uint64_t offset : {std::uint64_t{0}, std::uint64_t{500'000'000'000}}) {
    ScanInput input(p);
    std::string text;
    for (std::uint64_t n = 0; n < 20; ++n) {
      Sweep sweep = of({{3, 0, 0}});
      sweep.stamp = kStart + n * 100'000'000;
      for (std::uint64_t k = 0; offset != 0 && k < 10; ++k)
        ASSERT_TRUE(
            input.add(ImuSample{sweep.stamp + offset + k * 10'000'000, {0, 0, 0}, {0, 0, 9.81}}, "imu"));
      const auto scan = input.add(sweep, 0, "lidar", standing);
      ASSERT_TRUE(scan && *scan) << "the odometry's attitude serves";
      for (const ScanWarning& warning : (*scan)->warnings) text = warning.text;
    }
    EXPECT_THAT(text, testing::HasSubstr(offset == 0 ? "sends nothing" : "another clock"));
  }
}

TEST(ScanInput, SeveralLidarsBecomeOneScan) {
  Platform p = robot();
  p.lidars.push_back({.mounting = {.x = -0.2, .z = 0.4, .yaw = M_PI}, .topic = "rear", .frame = "rear"});
  ScanInput input(p);
  Sweep rear = of({{3, 0, 0}});
  rear.stamp = kStart;
  const auto waits = input.add(rear, 1, "rear", driven);
  ASSERT_TRUE(waits);
  EXPECT_FALSE(*waits);
  Sweep front = of({{4, 0, 0}});
  front.stamp = kStart + 50'000'000;
  const auto scan = input.add(front, 0, "lidar", driven);
  ASSERT_TRUE(scan && *scan);
  ASSERT_EQ((*scan)->points.size(), 2U);
  const Eigen::Vector3d expected = driven(front.stamp)->inverse() * Eigen::Vector3d(-3.2, 0, 0.4);
  EXPECT_LT(((*scan)->points[1].cast<double>() - expected).norm(), 1e-4);
  // The rays of each lidar begin where it was, seen from where the body is now.
  ASSERT_EQ((*scan)->parts.size(), 2U);
  EXPECT_LT(((*scan)->parts[0].origin - Eigen::Vector3d(0.2, 0, 0.5)).norm(), 1e-9);
  const Eigen::Vector3d origin = driven(front.stamp)->inverse() * Eigen::Vector3d(-0.2, 0, 0.4);
  EXPECT_LT(((*scan)->parts[1].origin - origin).norm(), 1e-4);
  EXPECT_EQ((*scan)->parts[0].count, 1U);
  EXPECT_EQ((*scan)->parts[1].count, 1U);
  front.stamp += 500'000'000;
  EXPECT_EQ((*input.add(front, 0, "lidar", driven))->points.size(), 1U) << "the rear one is too old";
}

TEST(ScanInput, TheAttitudeIsTheImus) {
  Platform p = robot();
  p.imu = ImuConfig{};
  ScanInput input(p);
  const Eigen::Quaterniond R(Eigen::AngleAxisd(0.17, Eigen::Vector3d::UnitY()));
  for (std::uint64_t n = 0; n < 100; ++n)
    ASSERT_TRUE(input.add(
        ImuSample{kStart - (100 - n) * 10'000'000, {0, 0, 0}, R.conjugate() * Eigen::Vector3d(0, 0, 9.81)},
        "imu"));
  EXPECT_EQ(input.add(ImuSample{}, "imu7").error().reason, Reason::frame_unknown);
  const auto scan = input.add(of({{3, 0, 0}}), 0, "lidar", standing);
  ASSERT_TRUE(scan) << scan.error().text;
  ASSERT_TRUE((*scan)->attitude);
  EXPECT_LT((*scan)->attitude->angularDistance(R), 1e-6);
  // Nose down by 0.17: what is 0.5 m above base_link, 3.2 m ahead, is at the level of the ground.
  EXPECT_NEAR(levelled(**scan).at(0).z(), 0.5 * std::cos(0.17) - 3.2 * std::sin(0.17), 1e-4);
  EXPECT_NEAR(with_attitude(Pose3::level({1, 2, 0.7}, 3), R).yaw(), 0.7, 1e-12);
}

TEST(ScanInput, TheImusMountingCountsForItsOwnFrameAndForNone) {
  Platform p = robot();
  p.imu = ImuConfig{};
  p.imu->mounting.roll = M_PI;
  for (const char* shared : {"imu", "livox_frame"}) {
    p.imu->frame = shared;
    p.lidars[0].frame = "livox_frame";
    for (const char* frame : {"", shared}) {
      ScanInput input(p);
      EXPECT_TRUE(input.mounting_of_imu(frame)->orientation.isApprox(p.imu->mounting.pose().orientation));
      for (std::uint64_t n = 0; n < 100; ++n)
        ASSERT_TRUE(input.add(ImuSample{kStart + n * 10'000'000, {0, 0, 0}, {0, 0, -9.81}}, frame));
      const auto attitude = input.tilt()->at(kStart + 900'000'000);
      ASSERT_TRUE(attitude) << frame << ": " << attitude.error().text;
      EXPECT_NEAR(roll_pitch(*attitude).norm(), 0.0, 0.01);
    }
  }
}

TEST(ScanInput, AnImuWithoutStampsIsRefusedAndNotCalledSilent) {
  Platform p = robot();
  p.imu = ImuConfig{};
  ScanInput input(p);
  for (std::uint64_t n = 0; n < 30; ++n) {
    EXPECT_EQ(input.add(ImuSample{0, {0, 0, 0}, {0, 0, 9.81}}, "imu").reason(), Reason::sensor_times);
    Sweep sweep = of({{3, 0, 0}});
    sweep.stamp = kStart + n * 100'000'000;
    const auto scan = input.add(sweep, 0, "lidar", standing);
    ASSERT_TRUE(scan && *scan);
    EXPECT_TRUE((*scan)->warnings.empty());
  }
}

TEST(ScanInput, AnImuThatIsMountedOtherwiseStopsTheScans) {
  Platform p = robot();
  p.imu = ImuConfig{};
  ScanInput input(p);
  for (std::uint64_t n = 0; n < 100; ++n)
    (void)input.add(ImuSample{kStart - (100 - n) * 10'000'000, {0, 0, 0}, {0, 0, -9.81}}, "imu");
  EXPECT_EQ(input.add(of({{3, 0, 0}}), 0, "lidar", standing).reason(), Reason::imu_mounting);
}

}  // namespace
}  // namespace adit::perception
