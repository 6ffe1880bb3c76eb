// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/pose_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace adit::agent {
namespace {

constexpr std::uint64_t kMs = 1'000'000;
const Time kNow{100s};

Platform wheeled() {
  Platform platform;
  platform.max_speed = 2.0;
  platform.max_turn = 1.5;
  return platform;
}

/// Samples of a driver whose odometry counts 10 % too much, every 20 ms, and the true pose.
struct Drive {
  std::uint64_t stamp{1'000'000 * kMs};
  double x{};
  Pose3 driver() const { return Pose3::level({1.1 * x, 0, 0}, 0); }
  Pose3 truth() const { return Pose3::level({x, 0, 0}, 0); }
  void step() {
    stamp += 20 * kMs;
    x += 0.02;
  }
  OdometryReport report(const Pose3& T_local_truth, std::uint32_t instance) const {
    const Pose3 T_local_base = T_local_truth * truth();
    return {stamp, T_local_base, T_local_base * driver().inverse(), instance, Localisation::ok, 0.02};
  }
};

double jump(const Pose3& a, const Pose3& b) { return (a.position - b.position).norm(); }

TEST(PoseCorrection, FollowsTheReportsWithoutAJump) {
  PoseCorrection correction(wheeled());
  Drive drive;
  Pose3 last = correction.apply(drive.driver(), drive.stamp);
  for (int n = 1; n <= 500; ++n) {
    drive.step();
    const Pose3 now = correction.apply(drive.driver(), drive.stamp);
    ASSERT_LT(jump(now, last), 0.04) << n;
    last = now;
    if (n % 5 == 0) correction.take(drive.report(Pose3{}, 1), kNow);
  }
  EXPECT_NEAR(last.position.x(), drive.x, 0.02);
  EXPECT_EQ(correction.health(kNow), Localisation::ok);
}

TEST(PoseCorrection, AnotherInstanceContinuesFromThePresentPose) {
  PoseCorrection correction(wheeled());
  Drive drive;
  Pose3 last{};
  for (int n = 0; n < 400; ++n) {
    drive.step();
    const Pose3 now = correction.apply(drive.driver(), drive.stamp);
    if (n > 0) {
      ASSERT_LT(jump(now, last), 0.04) << n;
    }
    last = now;
    // The second instance has a frame that begins elsewhere, and turned.
    const Pose3 T_local_truth = n < 200 ? Pose3{} : Pose3::level({-7, 3, 2}, 1);
    if (n % 5 == 0) correction.take(drive.report(T_local_truth, n < 200 ? 1 : 2), kNow);
  }
  EXPECT_NEAR(last.position.x(), drive.x, 0.1);
  EXPECT_NEAR(last.position.y(), 0, 0.02);
}

TEST(PoseCorrection, ALargeErrorIsMadeUpForAsFastAsTheBodyMoves) {
  PoseCorrection correction(wheeled());
  Drive drive;
  correction.apply(drive.driver(), drive.stamp);
  correction.take(drive.report(Pose3{}, 1), kNow);
  OdometryReport far = drive.report(Pose3{}, 1);
  far.T_local_driver.position.y() += 1.0;
  correction.take(far, kNow);
  Pose3 last = correction.apply(drive.driver(), drive.stamp);
  for (int n = 0; n < 150; ++n) {
    drive.stamp += 20 * kMs;
    const Pose3 now = correction.apply(drive.driver(), drive.stamp);
    ASSERT_LE(jump(now, last), MotionBound::kFaster * 2.0 * 0.02 + 1e-9);
    last = now;
  }
  EXPECT_NEAR(last.position.y(), 1.0, 1e-6);
}

TEST(PoseCorrection, ADriverThatBeginsAgainIsFollowedFromThePresentCorrection) {
  PoseCorrection correction(wheeled());
  Drive drive;
  for (int n = 0; n < 100; ++n) {
    drive.step();
    correction.apply(drive.driver(), drive.stamp);
    if (n % 5 == 0) correction.take(drive.report(Pose3{}, 1), kNow);
  }
  const OdometryReport old = drive.report(Pose3{}, 1);
  // The driver begins at zero again.
  const Pose3 T_new_old = drive.driver().inverse();
  drive.stamp += 20 * kMs;
  correction.begin_frame(drive.stamp);
  const Pose3 first = correction.apply(T_new_old * drive.driver(), drive.stamp);
  correction.take(old, kNow);  // Of the previous frame.
  EXPECT_LT(jump(correction.apply(T_new_old * drive.driver(), drive.stamp + kMs), first), 1e-9);
  OdometryReport next = old;
  next.stamp = drive.stamp;
  next.T_local_driver = old.T_local_driver * T_new_old.inverse();
  correction.take(next, kNow);
  EXPECT_LT(jump(correction.apply(T_new_old * drive.driver(), drive.stamp + 2 * kMs), first), 1e-6);
}

TEST(PoseCorrection, IgnoresReportsThatAreNoPoses) {
  PoseCorrection correction(wheeled());
  Drive drive;
  correction.apply(drive.driver(), drive.stamp);
  OdometryReport broken = drive.report(Pose3{}, 1);
  broken.T_local_driver.position.x() = std::numeric_limits<double>::quiet_NaN();
  correction.take(broken, kNow);
  broken = drive.report(Pose3{}, 1);
  broken.T_local_driver.orientation.coeffs().setZero();
  correction.take(broken, kNow);
  EXPECT_TRUE(correction.apply(drive.driver(), drive.stamp).position.allFinite());
  EXPECT_EQ(correction.health(kNow), Localisation::starting);
}

/// The own odometry stands still, by reports at 10 Hz that come 0.1 s late, while the driver moves.
struct StuckRun {
  bool honest{true};  ///< Never more than 5 sigma and 0.1 m off for longer than 0.5 s.
  double end{}, end_yaw{};
  double largest_step{};  ///< Between two poses, m.
};
StuckRun stuck(double speed, double turn, double seconds) {
  PoseCorrection correction(wheeled());
  StuckRun run;
  std::uint64_t stamp = 1'000'000 * kMs;
  std::optional<OdometryReport> on_its_way;
  Pose3 last{};
  double beyond = 0;
  for (int n = 0; n <= static_cast<int>(seconds * 50); ++n, stamp += 20 * kMs) {
    const double t = 0.02 * n;
    const Pose3 driver = Pose3::level({speed * t, 0, turn * t}, 0);
    const Pose3 now = correction.apply(driver, stamp);
    if (n % 5 == 0) {
      if (on_its_way) correction.take(*on_its_way, kNow);
      on_its_way = OdometryReport{stamp, Pose3{}, driver.inverse(), 1, Localisation::ok, 0.02};
    }
    if (n > 0) run.largest_step = std::max(run.largest_step, jump(now, last));
    last = now;
    beyond = now.position.norm() > 5 * correction.sigma() + 0.1 ? beyond + 0.02 : 0.0;
    run.honest = run.honest && beyond <= 0.5;
    run.end = now.position.norm();
    run.end_yaw = std::abs(now.yaw());
  }
  return run;
}

TEST(PoseCorrection, WheelsOfABodyThatIsStuckDoNotCarryItAway) {
  for (const double speed : {0.4, 1.0, 2.0}) {
    const StuckRun run = stuck(speed, 0, 20);
    EXPECT_TRUE(run.honest) << speed;
    EXPECT_LT(run.end, 0.25 * speed) << speed;  // What the wheels count until the next report.
    EXPECT_LE(run.largest_step, MotionBound::kFaster * 2.0 * 0.02 + 1e-9);
  }
}

TEST(PoseCorrection, ATurnThatTheBodyDoesNotMakeIsNotBelieved) {
  const StuckRun run = stuck(0, 1.4, 2.3);
  EXPECT_LT(run.end_yaw, 0.35);  // Of 3.2 rad.
}

TEST(PoseCorrection, ADriverThatBeginsAgainElsewhereIsSeenToDoSo) {
  PoseCorrection correction(wheeled());
  Drive drive;
  for (int n = 0; n < 100; ++n) {
    drive.step();
    correction.apply(drive.driver(), drive.stamp);
  }
  const Pose3 last = correction.apply(drive.driver(), drive.stamp + 20 * kMs);
  EXPECT_GT(jump(correction.apply(Pose3::level({40, 0, 0}, 0), drive.stamp + 40 * kMs), last), 30.0);
}

TEST(PoseCorrection, ALargeCorrectionThatIsPendingIsNeitherOkNorCertain) {
  PoseCorrection correction(wheeled());
  Drive drive;
  correction.apply(drive.driver(), drive.stamp);
  correction.take(drive.report(Pose3{}, 1), kNow);
  correction.shift(Pose3::level({0, 1.0, 0}, 0));
  correction.apply(drive.driver(), drive.stamp + 20 * kMs);
  EXPECT_EQ(correction.health(kNow), Localisation::weak);
  EXPECT_GT(correction.sigma(), 0.9);
  // The map has the correction at once.
  EXPECT_NEAR(correction.located(drive.report(Pose3{}, 1))->position.y(), 1.0, 1e-9);
}

TEST(PoseCorrection, AWayByTheDriverAloneIsLessCertain) {
  PoseCorrection correction(wheeled());
  Drive drive;
  correction.apply(drive.driver(), drive.stamp);
  correction.take(drive.report(Pose3{}, 1), kNow);
  for (int n = 0; n < 500; ++n) {
    drive.step();
    correction.apply(drive.driver(), drive.stamp);
  }
  EXPECT_GT(correction.sigma(), 1.0);  // Of 11 m.
  correction.take(drive.report(Pose3{}, 2), kNow);
  EXPECT_GT(correction.sigma(), 1.0);
}

// A restart of the odometry while the body is stuck: nothing sees that it stands.
TEST(PoseCorrection, AWayOfWheelsThatSlippedSaysNothing) {
  PoseCorrection correction(wheeled());
  Drive drive;
  correction.apply(drive.driver(), drive.stamp);
  OdometryReport slips = drive.report(Pose3{}, 1);
  slips.wheels_slip = true;
  correction.take(slips, kNow);
  const Pose3 from = drive.driver();
  for (int n = 0; n < 20; ++n) {
    drive.step();
    correction.apply(drive.driver(), drive.stamp);
  }
  const double way = (drive.driver().position - from.position).norm();
  EXPECT_GT(correction.sigma(), 0.9 * way);
  correction.take(drive.report(Pose3{}, 2), kNow);
  EXPECT_GT(correction.sigma(), 0.9 * way);
}

/// Drives on by so many metres, with reports whose sigma grows by 0.5 % of the way from `sigma` on.
void drive_on(PoseCorrection& correction, Drive& drive, double metres, std::uint32_t instance, double sigma) {
  for (double way = 0; way < metres; way += 0.02) {
    drive.step();
    correction.apply(drive.driver(), drive.stamp);
    OdometryReport report = drive.report(Pose3{}, instance);
    report.sigma = sigma + 0.005 * way;
    correction.take(report, kNow);
  }
}

TEST(PoseCorrection, SigmaGoesOnAfterARestart) {
  PoseCorrection before(wheeled());
  Drive drive;
  drive_on(before, drive, 200, 1, 0.02);
  ASSERT_GT(before.sigma(), 1.0);
  PoseCorrection after(wheeled());
  after.restore(before.T_odom_driver(), before.sigma());
  EXPECT_EQ(after.sigma(), before.sigma());
  drive_on(after, drive, 1, 1, 0.02);
  EXPECT_GT(after.sigma(), before.sigma());
}

TEST(PoseCorrection, SigmaCountsFromAnOperatorsPose) {
  PoseCorrection correction(wheeled());
  Drive drive;
  drive_on(correction, drive, 200, 1, 0.02);
  correction.reset_sigma();
  EXPECT_EQ(correction.sigma(), 0.0);
  drive_on(correction, drive, 1, 1, 1.02);
  EXPECT_GT(correction.sigma(), 0.05);
  EXPECT_LT(correction.sigma(), 0.15);
  // The lidar sees again what it had lost, and then drifts as before.
  drive_on(correction, drive, 0.02, 1, 0.05);
  drive_on(correction, drive, 40, 1, 0.05);
  EXPECT_NEAR(correction.sigma(), 0.25, 0.02);
  drive_on(correction, drive, 0.02, 2, 0.02);  // Another instance.
  EXPECT_NEAR(correction.sigma(), 0.25, 0.02);
}

/// A report of a robot that stands where it is; lost with a standard deviation of 8 m, seen with 0.3 m.
OdometryReport standing(const Drive& drive, std::uint32_t instance, bool lost,
                        std::uint32_t relocalised = 0) {
  OdometryReport report = drive.report(Pose3{}, instance);
  report.health = lost ? Localisation::lost : Localisation::ok;
  report.sigma = lost ? 8.0 : 0.02;
  report.sigma_seen = lost ? 0.3 : 0.02;
  report.relocalised = relocalised;
  return report;
}

TEST(PoseCorrection, AnotherInstanceDoesNotFindAPlaceThatWasLost) {
  PoseCorrection correction(wheeled());
  Drive drive;
  const auto take = [&](const OdometryReport& report) {
    drive.stamp += 20 * kMs;
    correction.apply(drive.driver(), drive.stamp);
    correction.take(report, kNow);
  };
  take(standing(drive, 1, false));
  take(standing(drive, 1, true));
  for (int n = 0; n < 100; ++n) {
    take(standing(drive, 2, false));
    ASSERT_EQ(correction.health(kNow), Localisation::lost) << n;
    ASSERT_GT(correction.sigma(), 7.9) << n;
    ASSERT_NEAR(correction.sigma_seen(), 0.3, 0.01) << n;
    ASSERT_NEAR(correction.moved(), 8.0, 0.02) << n;
  }
  take(standing(drive, 3, false));  // Nor does a third one.
  EXPECT_EQ(correction.health(kNow), Localisation::lost);
  // The command component is restarted, too.
  PoseCorrection next(wheeled());
  next.restore(correction.T_odom_driver(), correction.sigma(), correction.account());
  next.apply(drive.driver(), drive.stamp);
  next.take(standing(drive, 3, false), kNow);
  EXPECT_EQ(next.health(kNow), Localisation::lost);
  EXPECT_NEAR(next.moved(), 8.0, 0.05);
  OdometryReport found = standing(drive, 3, false, 1);
  found.sigma = 0.1;
  take(found);
  EXPECT_EQ(correction.health(kNow), Localisation::ok);
  EXPECT_NEAR(correction.sigma(), std::hypot(0.3, 0.1), 0.02);
}

TEST(PoseCorrection, AnOperatorsPoseEndsThatAnotherInstanceIsLost) {
  PoseCorrection correction(wheeled());
  Drive drive;
  correction.apply(drive.driver(), drive.stamp);
  correction.take(standing(drive, 1, true), kNow);
  correction.take(standing(drive, 2, false), kNow);
  ASSERT_EQ(correction.health(kNow), Localisation::lost);
  correction.reset_sigma();
  correction.take(standing(drive, 2, false), kNow);
  EXPECT_EQ(correction.health(kNow), Localisation::ok);
  EXPECT_LT(correction.sigma(), 0.05);
}

TEST(PoseCorrection, AStepThatWasOnItsWayDoesNotMoveAnOperatorsPose) {
  PoseCorrection correction(wheeled());
  Drive drive;
  const auto take = [&](const OdometryReport& report) {
    drive.stamp += 20 * kMs;
    correction.apply(drive.driver(), drive.stamp);
    correction.take(report, kNow);
    return correction.located(report)->position;
  };
  OdometryReport report = standing(drive, 1, true);
  const Eigen::Vector3d set = take(report);
  correction.hold_steps();
  correction.reset_sigma();
  // A place that was found just before, and then the operator's pose.
  const Pose3 found = Pose3::level({6, 2, 1}, 0);
  const auto moved = [&](std::uint32_t steps) {
    OdometryReport out = standing(drive, 1, false, steps);
    out.T_local_base = found * out.T_local_base;
    out.T_local_driver = found * out.T_local_driver;
    out.steps = steps;
    return out;
  };
  const std::uint32_t jumps = correction.jumps();
  EXPECT_LT((take(moved(1)) - set).norm(), 0.01);
  EXPECT_GT(correction.jumps(), jumps);
  correction.release_steps(2);
  EXPECT_LT((take(moved(2)) - set).norm(), 0.01);
  // One that follows is a new one.
  OdometryReport next = moved(3);
  next.T_local_base.position.y() += 1.0;
  next.T_local_driver.position.y() += 1.0;
  EXPECT_NEAR((take(next) - set).norm(), 1.0, 0.01);
}

TEST(PoseCorrection, ARestartOfTheCommandComponentAddsNothingToSigma) {
  PoseCorrection before(wheeled());
  Drive drive;
  before.apply(drive.driver(), drive.stamp);
  before.take(standing(drive, 1, true), kNow);
  PoseCorrection after(wheeled());
  after.restore(before.T_odom_driver(), before.sigma(), before.account());
  after.apply(drive.driver(), drive.stamp);
  after.take(standing(drive, 1, true), kNow);
  EXPECT_NEAR(after.sigma(), before.sigma(), 1e-9);
  EXPECT_NEAR(after.moved(), before.moved(), 1e-9);
}

TEST(PoseCorrection, SilenceIsNoHealth) {
  PoseCorrection correction(wheeled());
  Drive drive;
  correction.apply(drive.driver(), drive.stamp);
  correction.take(drive.report(Pose3{}, 1), kNow);
  EXPECT_EQ(correction.health(kNow + 900ms), Localisation::ok);
  EXPECT_EQ(correction.health(kNow + 1100ms), Localisation::starting);
}

}  // namespace
}  // namespace adit::agent
