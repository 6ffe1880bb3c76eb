// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/motion_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "core/time/random.hpp"

namespace adit::perception {
namespace {

constexpr std::uint64_t kBegin = 1'000'000'000'000;  // ns
constexpr std::uint64_t kMillisecond = 1'000'000;

/// A body that drives a circle at 1 m/s and 0.5 rad/s, 2 m in radius.
struct Circle {
  static Pose3 at(double t) {
    const double a = 0.5 * t;
    return Pose3::level({2 * std::sin(a), 2 - 2 * std::cos(a), a}, 0);
  }
  static ImuSample imu(double t) {
    return {kBegin + static_cast<std::uint64_t>(t * 1e9), {0, 0, 0.5}, {0, 0.5, kStandardGravity}};
  }
};

MotionFilter started(const MotionParams& params) {
  MotionFilter filter(params);
  filter.start(kBegin, Circle::at(0), {0, 0, 0}, false, 0.005);
  MotionState state = filter.state();
  state.velocity = {1, 0, 0};
  state.P.diagonal().segment<3>(MotionState::kV).setConstant(1e-4);
  filter.correct(state);
  return filter;
}

void drive(MotionFilter& filter, double from, double to, bool imu, double wheel_scale) {
  for (int n = static_cast<int>(from * 100) + 1; n <= static_cast<int>(to * 100); ++n) {
    const double t = 0.01 * n;
    if (imu) filter.add(Circle::imu(t));
    if (wheel_scale > 0 && n % 2 == 0) {
      Pose3 pose = Circle::at(t);
      pose.position *= wheel_scale;
      filter.add(BodyMotion{kBegin + static_cast<std::uint64_t>(n) * 10 * kMillisecond, pose});
    }
  }
}

double error(const MotionFilter& filter, double t) {
  return (filter.pose().position - Circle::at(t).position).norm();
}

TEST(MotionFilter, FollowsTheImu) {
  MotionFilter filter = started({.has_wheels = false});
  drive(filter, 0, 4, true, 0);
  filter.advance(kBegin + 4000 * kMillisecond);
  EXPECT_LT(error(filter, 4), 0.05);
  EXPECT_NEAR(filter.pose().yaw(), 2.0, 0.01);
}

TEST(MotionFilter, FollowsTheWheelsWithoutAnImu) {
  MotionFilter filter = started({.has_imu = false});
  drive(filter, 0, 4, false, 1.0);
  filter.advance(kBegin + 4000 * kMillisecond);
  EXPECT_LT(error(filter, 4), 0.05);
  EXPECT_NEAR(filter.velocity().norm(), 1.0, 0.02);
}

/// Degrees by which the body leans, by the filter, after a minute of standing on level ground. It began with
/// a roll of 1 degree. The driver's roll errs by half a degree, now this way, now that.
double lean_after_a_minute(bool driver_states_tilt) {
  constexpr double kDegree = M_PI / 180;
  MotionFilter filter({.has_imu = false});
  const auto rolled = [](double angle) {
    return Pose3{{0, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()))};
  };
  filter.start(kBegin, rolled(kDegree), {0, 0, 0}, false, 0.02);
  for (int n = 1; n <= 600; ++n) {
    const std::uint64_t stamp = kBegin + static_cast<std::uint64_t>(n) * 100 * kMillisecond;
    const double roll = driver_states_tilt ? 0.5 * kDegree * std::sin(0.1 * n) : 0.0;
    filter.add(BodyMotion{stamp, rolled(roll)});
    filter.advance(stamp);
  }
  const MotionState& s = filter.state();
  const Eigen::Vector3d up = -(s.rotation.conjugate() * s.gravity_vector()).normalized();
  return std::acos(std::min(1.0, up.z())) / kDegree;
}

TEST(MotionFilter, LearnsGravityFromTheDriversRollAndPitch) { EXPECT_LT(lean_after_a_minute(true), 0.3); }
TEST(MotionFilter, DoesNotTakeThePlaneOfAPlanarDriverForLevel) {
  EXPECT_NEAR(lean_after_a_minute(false), 1.0, 0.01);
}

TEST(MotionFilter, BridgesAGapOfTheImuByTheWheels) {
  MotionFilter filter = started({});
  drive(filter, 0, 2, true, 1.0);
  drive(filter, 2, 2.5, false, 1.0);
  drive(filter, 2.5, 4, true, 1.0);
  filter.advance(kBegin + 4000 * kMillisecond);
  EXPECT_LT(error(filter, 4), 0.1);
}

TEST(MotionFilter, DoesNotBelieveASlip) {
  MotionFilter filter = started({});
  drive(filter, 0, 2, true, 1.0);
  // For 0.4 s the wheels count twice the way.
  Pose3 slipped = Circle::at(2);
  for (int n = 1; n <= 40; ++n) {
    const double t = 2 + 0.01 * n;
    filter.add(Circle::imu(t));
    if (n % 2 != 0) continue;
    const Pose3 step = Circle::at(t - 0.02).inverse() * Circle::at(t);
    slipped = slipped * Pose3{2 * step.position, step.orientation};
    filter.add(BodyMotion{kBegin + static_cast<std::uint64_t>((200 + n) * 10) * kMillisecond, slipped});
  }
  filter.advance(kBegin + 2400 * kMillisecond);
  EXPECT_LT(error(filter, 2.4), 0.08);  // Twice the way would be 0.4 m off.
}

TEST(MotionFilter, ABodyAtRestStaysThereForAnHour) {
  MotionFilter filter({});
  filter.start(kBegin, Pose3{}, {0.004, 0, 0}, true, 0.005);
  for (int s = 0; s < 3600; ++s) {
    for (int n = 1; n <= 10; ++n) {
      const std::uint64_t stamp =
          kBegin +
          (static_cast<std::uint64_t>(s) * 1000 + static_cast<std::uint64_t>(n) * 100) * kMillisecond;
      for (int k = 9; k >= 0; --k)
        filter.add(ImuSample{
            stamp - static_cast<std::uint64_t>(k) * 10 * kMillisecond, {0.004, 0.001, 0}, {0.08, 0, 9.82}});
      filter.add(BodyMotion{stamp, Pose3{}});
    }
    filter.advance(kBegin + static_cast<std::uint64_t>(s + 1) * 1000 * kMillisecond);
  }
  EXPECT_LT(filter.pose().position.norm(), 0.25);
  EXPECT_LT(filter.velocity().norm(), 0.002);
}

TEST(MotionFilter, PosesOutsideOfItsHistoryAreErrors) {
  MotionFilter filter = started({.has_wheels = false});
  EXPECT_FALSE(MotionFilter({}).at(kBegin));
  drive(filter, 0, 2, true, 0);
  filter.advance(kBegin + 2000 * kMillisecond);
  EXPECT_EQ(filter.at(kBegin).error().reason, Reason::out_of_range);
  EXPECT_TRUE(filter.at(kBegin + 1500 * kMillisecond));
  EXPECT_TRUE(filter.at(kBegin + 2200 * kMillisecond));
  EXPECT_EQ(filter.at(kBegin + 2400 * kMillisecond).error().reason, Reason::out_of_range);
}

TEST(MotionFilter, ItsMemoryIsBounded) {
  MotionFilter filter({});
  for (int n = 0; n < 10'000; ++n) {
    filter.add(ImuSample{kBegin + static_cast<std::uint64_t>(n) * kMillisecond, {0, 0, 0}, {0, 0, 9.81}});
    filter.add(BodyMotion{kBegin + static_cast<std::uint64_t>(n) * kMillisecond, Pose3{}});
  }
  EXPECT_FALSE(filter.started());
  EXPECT_TRUE(filter.covers(kBegin + 9'999 * kMillisecond));
}

TEST(MotionFilter, TheCovarianceStaysPositiveAfterALongBlindStretch) {
  Random random(1);
  using Matrix = MotionState::Matrix;
  for (const double sigma : {31.0, 100.0, 1e4})
    for (int n = 0; n < 200; ++n) {
      Matrix mix;
      for (int k = 0; k < mix.size(); ++k) mix.data()[k] = random.uniform(-1, 1);
      Eigen::Matrix<double, 6, 6> J;
      for (int k = 0; k < J.size(); ++k) J.data()[k] = random.uniform(-1, 1);
      MotionState::Vector open;
      for (int k = 0; k < open.size(); ++k) open[k] = random.uniform(-1, 1);
      const Matrix P = 1e-4 * mix * mix.transpose() + sigma * sigma * open * open.transpose();
      const Matrix next = after_registration(P, 1e6 * J * J.transpose(), true);
      ASSERT_TRUE(next.allFinite());
      const Eigen::SelfAdjointEigenSolver<Matrix> solver(next);
      ASSERT_GT(solver.eigenvalues().minCoeff(), -1e-12 * solver.eigenvalues().maxCoeff())
          << sigma << " " << n;
      ASSERT_GT(next.diagonal().minCoeff(), 0);
    }
}

TEST(MotionFilter, ACorrectionThatIsNoNumberIsRefused) {
  MotionFilter filter = started({.has_wheels = false});
  MotionState state = filter.state();
  state.P(3, 3) = -1e-3;
  state.position.x() = 77;
  filter.correct(state);
  EXPECT_NEAR(filter.pose().position.x(), 0, 1e-9);
  EXPECT_GT(filter.state().P.diagonal().minCoeff(), 0);
  EXPECT_GT(filter.state().P(0, 0), 1);
}

}  // namespace
}  // namespace adit::perception
