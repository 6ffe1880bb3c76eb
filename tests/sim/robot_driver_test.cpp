// SPDX-License-Identifier: Apache-2.0
// What the driver of a realistic robot sends: layout, frames, stamps, and samples that come late.
#include "sim/driver/robot_driver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>

#include "core/exec/virtual_runtime.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/Imu.h"
#include "sensor_msgs/msg/PointCloud2.h"

namespace adit::sim {
namespace {

std::int64_t stamp_of(const std_msgs::msg::Header& header) {
  return std::int64_t{header.stamp().sec()} * 1'000'000'000 + header.stamp().nanosec();
}

/// A robot in a box of walls, and what it sent in 10 s. Its driver has the fault from 4 s to 7 s.
struct Sent {
  using Fault = std::function<void(RobotDriver&, bool begins)>;
  explicit Sent(double noise, const Fault& fault = {}, const Platform& platform = {})
      : simulation(make(noise, platform)) {
    const auto keep = [this](auto& samples, auto& clock) {
      return [&samples, &clock, this](const auto& sample, const wire::SampleInfo&) {
        samples.push_back(sample);
        clock.push_back(scheduler.elapsed());
      };
    };
    auto odom_reader = wire::make_reader<nav_msgs::msg::Odometry>(*agent, wire::topics::kOdom, *strand,
                                                                  keep(odometry, odometry_came));
    auto imu_reader =
        wire::make_reader<sensor_msgs::msg::Imu>(*agent, wire::topics::kImu, *strand, keep(imu, imu_came));
    auto points_reader = wire::make_reader<sensor_msgs::msg::PointCloud2>(*agent, wire::topics::kPoints,
                                                                          *strand, keep(clouds, clouds_came));
    auto rear_topic = wire::topics::kPoints;
    rear_topic.name = "rt/rear/points";
    auto rear_reader =
        wire::make_reader<sensor_msgs::msg::PointCloud2>(*agent, rear_topic, *strand, keep(rear, rear_came));
    RobotDriver driver(simulation, 0, *strand, *body, {});
    EXPECT_TRUE(driver.start());
    const Timer step = strand->every(10ms, [this] {
      simulation.command(0, {0.3, 0.0, 0.5});
      simulation.step();
    });
    if (fault) {
      scheduler.run_until(kBegin);
      fault(driver, true);
      scheduler.run_until(kEnd);
      fault(driver, false);
    }
    scheduler.run_until(10s);
  }
  static constexpr Duration kBegin{4s}, kEnd{7s};

  static Simulation make(double noise, const Platform& platform) {
    const std::array<Box, 2> walls{Box{8, 8.5, -8, 8, 0, 3}, Box{-8, 8, 6, 6.5, 0, 3}};
    SimulationParams params;
    params.realistic = true;
    params.noise = noise;
    params.odometry = OdometryParams::realistic().scaled(noise);
    return *Simulation::create(std::make_shared<const World>(*make_box_world(walls, 0, 3)),
                               {{"r1", platform, {0, 0, 0}}}, params);
  }

  /// How many samples of odometry came after a newer one.
  int overtaken() const {
    int count = 0;
    for (std::size_t n = 1; n < odometry.size(); ++n)
      count += stamp_of(odometry[n].header()) < stamp_of(odometry[n - 1].header());
    return count;
  }

  Simulation simulation;
  VirtualScheduler scheduler{1};
  wire::SimulatedNetwork network{scheduler, {}};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 1h)};
  std::shared_ptr<Executor> strand{machine->strand("r1")};
  std::unique_ptr<wire::Participant> agent{network.join(101, "r1")}, body{network.join(101, "r1/driver")};
  std::vector<nav_msgs::msg::Odometry> odometry{};
  std::vector<sensor_msgs::msg::Imu> imu{};
  std::vector<sensor_msgs::msg::PointCloud2> clouds{}, rear{};
  std::vector<Duration> odometry_came{}, imu_came{}, clouds_came{}, rear_came{};
};

TEST(RobotDriver, SendsTheFieldsThatLidarDriversSend) {
  const Sent sent(0.0);
  ASSERT_NEAR(sent.clouds.size(), 99, 2);
  const auto& cloud = sent.clouds.back();
  EXPECT_EQ(cloud.header().frame_id(), "lidar");
  std::vector<std::string> names;
  std::size_t t = 0, ring = 0;
  for (const auto& field : cloud.fields()) {
    names.push_back(field.name());
    if (field.name() == "t") t = field.offset();
    if (field.name() == "ring") ring = field.offset();
    EXPECT_EQ(field.datatype(), field.name() == "ring" ? 4 : 7) << field.name();
  }
  EXPECT_EQ(names, (std::vector<std::string>{"x", "y", "z", "intensity", "t", "ring"}));
  ASSERT_EQ(cloud.data().size(), std::size_t{cloud.width()} * cloud.point_step());
  float last = 0.0f;
  int highest = 0;
  for (std::size_t n = 0; n < cloud.width(); ++n) {
    const std::uint8_t* point = cloud.data().data() + n * cloud.point_step();
    float time = 0.0f;
    std::uint16_t beam = 0;
    std::memcpy(&time, point + t, sizeof time);
    std::memcpy(&beam, point + ring, sizeof beam);
    ASSERT_GE(time, last);
    ASSERT_LT(time, 0.1f);
    last = time;
    highest = std::max(highest, int{beam});
  }
  EXPECT_GT(last, 0.05f);
  EXPECT_EQ(highest, 15);
}

TEST(RobotDriver, WithoutNoiseNothingComesLateOrInAnotherOrder) {
  const Sent sent(0.0);
  EXPECT_EQ(sent.overtaken(), 0);
  ASSERT_NEAR(sent.imu.size(), 997, 3);
  for (std::size_t n = 1; n < sent.imu.size(); ++n)
    ASSERT_EQ(stamp_of(sent.imu[n].header()) - stamp_of(sent.imu[n - 1].header()), 10'000'000);
  EXPECT_EQ(sent.imu.front().orientation_covariance()[0], -1.0) << "no orientation is measured";
  const Truth& truth = sent.simulation.truth(0);
  const auto& pose = sent.odometry.back().pose().pose();
  EXPECT_NEAR(pose.position().x(), truth.pose.position.x(), 0.02);
  EXPECT_NEAR(pose.position().y(), truth.pose.position.y(), 0.02);
}

TEST(RobotDriver, WithNoiseSomeSamplesComeLateAndOdometryIsOvertaken) {
  const Sent sent(1.0);
  EXPECT_GT(sent.overtaken(), 0);
  EXPECT_LT(sent.overtaken(), 25) << "2 % of 500";
  int together = 0;
  for (std::size_t n = 1; n < sent.imu_came.size(); ++n) together += sent.imu_came[n] == sent.imu_came[n - 1];
  EXPECT_GT(together, 0) << "a busy bus hands samples over at once";
  Duration longest{};
  for (std::size_t n = 1; n < sent.clouds_came.size(); ++n)
    longest = std::max(longest, sent.clouds_came[n] - sent.clouds_came[n - 1]);
  EXPECT_GT(longest, 115ms) << "the delay of a scan varies";
  EXPECT_LT(longest, 200ms);
  EXPECT_GT(sent.odometry.back().pose().covariance()[0], 0.0);
}

/// How far the stamps of `changed` are from those of `usual`, by the time at which they came; both came at
/// the same times.
template <class Sample>
std::vector<std::pair<Duration, std::int64_t>> offsets(const std::vector<Sample>& usual,
                                                       const std::vector<Sample>& changed,
                                                       const std::vector<Duration>& came) {
  std::vector<std::pair<Duration, std::int64_t>> out;
  EXPECT_EQ(usual.size(), changed.size());
  for (std::size_t n = 0; n < std::min(usual.size(), changed.size()); ++n)
    out.emplace_back(came[n], stamp_of(changed[n].header()) - stamp_of(usual[n].header()));
  return out;
}

/// Stamps are `jump` ahead in what was sent during the fault; what comes up to 0.1 s later may be of either.
void expect_jump(const std::vector<std::pair<Duration, std::int64_t>>& offsets, Duration jump) {
  ASSERT_GT(offsets.size(), 90U);
  for (const auto& [came, by] : offsets) {
    const bool inside = came > Sent::kBegin + 100ms && came <= Sent::kEnd;
    const bool outside = came <= Sent::kBegin || came > Sent::kEnd + 100ms;
    if (!inside && !outside) continue;
    ASSERT_EQ(by, inside ? jump.count() : 0) << seconds(came);
  }
}

TEST(RobotDriver, ClockThatJumpsChangesTheStampsOfOneSensorAndNothingElse) {
  const Sent usual(1.0);
  const std::array<std::pair<Sensor, Duration>, 4> jumps{std::pair{Sensor::lidar, Duration(3600s)},
                                                         {Sensor::odometry, 1'600'000'000s},
                                                         {Sensor::imu, -10s},
                                                         {Sensor::lidar, -7200s}};  // To before 1970.
  for (const auto& [sensor, jump] : jumps) {
    const auto change = [s = sensor, j = jump](RobotDriver& driver, bool begins) {
      driver.jump_clock(s, begins ? j : -j);
    };
    const Sent sent(1.0, change);
    const auto by = [s = sensor, j = jump](Sensor of) { return of == s ? j : Duration{}; };
    expect_jump(offsets(usual.clouds, sent.clouds, sent.clouds_came), by(Sensor::lidar));
    expect_jump(offsets(usual.odometry, sent.odometry, sent.odometry_came), by(Sensor::odometry));
    expect_jump(offsets(usual.imu, sent.imu, sent.imu_came), by(Sensor::imu));
    EXPECT_EQ(sent.clouds_came, usual.clouds_came);
    EXPECT_EQ(sent.odometry_came, usual.odometry_came);
    EXPECT_EQ(sent.imu_came, usual.imu_came);
    EXPECT_EQ(sent.clouds.back().data(), usual.clouds.back().data());
  }
}

TEST(RobotDriver, WithoutStampsASensorsStampsAreZero) {
  const Sent sent(0.0, [](RobotDriver& driver, bool begins) {
    driver.jump_clock(Sensor::lidar, begins ? 5s : -5s);
    driver.drop_stamps(Sensor::lidar, begins);
    driver.drop_stamps(Sensor::imu, begins);
  });
  const auto expect_zero = [](const auto& samples, const std::vector<Duration>& came, bool dropped) {
    for (std::size_t n = 0; n < samples.size(); ++n) {
      if (came[n] > Sent::kBegin + 50ms && came[n] <= Sent::kEnd) {
        ASSERT_EQ(stamp_of(samples[n].header()) == 0, dropped);
      } else if (came[n] <= Sent::kBegin || came[n] > Sent::kEnd + 50ms) {
        ASSERT_GT(stamp_of(samples[n].header()), 0);
      }
    }
  };
  expect_zero(sent.clouds, sent.clouds_came, true);
  expect_zero(sent.imu, sent.imu_came, true);
  expect_zero(sent.odometry, sent.odometry_came, false);
}

/// Points of a cloud as the driver laid them out.
std::vector<SweepPoint> points_of(const sensor_msgs::msg::PointCloud2& cloud) {
  std::vector<SweepPoint> out(cloud.width());
  std::memcpy(out.data(), cloud.data().data(), out.size() * sizeof(SweepPoint));
  return out;
}

TEST(RobotDriver, LostColumnsHaveNoReturnAndTheirTimeAsNamedAndTheOthersAreAsBefore) {
  const Sent usual(0.0);
  for (const LostTime time : {LostTime::zero, LostTime::nan, LostTime::wrapped, LostTime::kept}) {
    const Sent sent(0.0, [&](RobotDriver& driver, bool begins) { driver.lose_columns({0.1, time}, begins); });
    ASSERT_EQ(sent.clouds_came, usual.clouds_came);
    std::size_t lost = 0, clouds = 0;
    for (std::size_t n = 0; n < sent.clouds.size(); ++n) {
      const auto all = points_of(usual.clouds[n]), left = points_of(sent.clouds[n]);
      auto next = all.begin();  // Both are in the order of their beams.
      std::size_t without = 0;
      for (const SweepPoint& p : left) {
        if (!p.position().isZero()) {
          const auto same = [&](const SweepPoint& q) { return q.t == p.t && q.position() == p.position(); };
          next = std::find_if(next, all.end(), same);
          ASSERT_NE(next, all.end());
          continue;
        }
        ++without;
        const std::array<bool, 4> as_named{p.t == 0.0f, std::isnan(p.t), std::abs(p.t - 4.294967f) < 1e-5f,
                                           p.t >= 0.0f && p.t < 0.1f};
        ASSERT_TRUE(as_named[static_cast<std::size_t>(time)]) << p.t;
      }
      const bool outside = sent.clouds_came[n] <= Sent::kBegin || sent.clouds_came[n] > Sent::kEnd + 50ms;
      ASSERT_TRUE(!outside || without == 0);
      clouds += without > 0;
      lost += without;
    }
    EXPECT_NEAR(clouds, 30, 1);
    EXPECT_NEAR(lost / (clouds * 900.0 * 16.0), 0.1, 0.01);
  }
}

TEST(RobotDriver, CoveredLidarSeesNothingFartherThanItsCover) {
  const Sent sent(1.0, [](RobotDriver& driver, bool begins) { driver.cover(begins); });
  int covered = 0;
  for (std::size_t n = 0; n < sent.clouds.size(); ++n) {
    double farthest = 0.0;
    for (const SweepPoint& p : points_of(sent.clouds[n]))
      farthest = std::max<double>(farthest, p.position().norm());
    const bool outside = sent.clouds_came[n] <= Sent::kBegin || sent.clouds_came[n] > Sent::kEnd + 100ms;
    EXPECT_TRUE(!outside || farthest > 2.0) << farthest;
    covered += farthest < 0.3001;
  }
  EXPECT_NEAR(covered, 30, 1);
}

/// The same with a lidar a metre behind the first.
Platform two_lidars() {
  Platform out;
  out.lidars.assign(2, out.lidar());
  out.lidars[0].mounting.x = 0.5;
  out.lidars[1].mounting = {.x = -0.5, .z = 0.5, .yaw = M_PI};
  out.lidars[1].topic = "rear/points";
  out.lidars[1].frame = "rear";
  return out;
}

TEST(RobotDriver, EachOfSeveralLidarsSweepsFromItsPlaceOnItsTopic) {
  const Sent sent(0.0, {}, two_lidars());
  ASSERT_NEAR(sent.clouds.size(), 99, 2);
  ASSERT_EQ(sent.rear.size(), sent.clouds.size());
  EXPECT_EQ(sent.clouds.back().header().frame_id(), "lidar");
  EXPECT_EQ(sent.rear.back().header().frame_id(), "rear");
  EXPECT_EQ(stamp_of(sent.rear.back().header()), stamp_of(sent.clouds.back().header()));
  const Simulation& s = sent.simulation;
  const Pose3 front = s.sweep(0, 0).T_world_lidar.back(), rear = s.sweep(0, 1).T_world_lidar.back();
  EXPECT_NEAR((front.position - rear.position).norm(), 1.0, 1e-9);
  // Both see the wall x = 8 where it is.
  for (const SweepJob& job : {s.sweep(0, 0), s.sweep(0, 1)}) {
    int met = 0;
    for (const SweepPoint& p : job.trace()) {
      const Eigen::Vector3d at = job.T_world_lidar.back() * p.position().cast<double>();
      met += std::abs(at.y()) < 2.0 && at.z() > 0.4 && std::abs(at.x() - 8.0) < 0.15;
    }
    EXPECT_GT(met, 300);
  }
}

TEST(RobotDriver, FirstOfSeveralLidarsMeasuresAsIfItWereAlone) {
  Platform one = two_lidars();
  one.lidars.pop_back();
  const auto trace = [](const Platform& platform) {
    Simulation s = Sent::make(1.0, platform);
    for (int n = 0; n < 20; ++n) s.step();
    return s.sweep(0).trace();
  };
  const auto alone = trace(one), of_two = trace(two_lidars());
  ASSERT_EQ(alone.size(), of_two.size());
  EXPECT_EQ(std::memcmp(alone.data(), of_two.data(), alone.size() * sizeof(SweepPoint)), 0);
}

TEST(RobotDriver, SilentImuSendsNothingAndNothingOfItLater) {
  const Sent sent(0.0, [](RobotDriver& driver, bool begins) { driver.silence(Sensor::imu, begins); });
  EXPECT_NEAR(sent.imu.size(), 697, 3);
  EXPECT_NEAR(sent.odometry.size(), 500, 1);
}

}  // namespace
}  // namespace adit::sim
