// SPDX-License-Identifier: Apache-2.0
// The path of a convoy's leader, the distance to the robot ahead, and the limit of the leader's speed.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "nav/convoy/governor.hpp"
#include "nav/convoy/spacing.hpp"
#include "nav/convoy/trail.hpp"

namespace adit::nav {
namespace {

/// A path of `length` metres along x, recorded every few centimetres.
Trail straight_trail(double length) {
  Trail trail;
  for (double x = 0.0; x <= length + 1e-9; x += 0.07) trail.record({x, 0, 0});
  trail.record({length, 0, 0});
  return trail;
}

std::vector<Eigen::Vector3d> points(const Trail& trail, std::uint32_t from, std::uint32_t to) {
  std::vector<Eigen::Vector3d> out;
  for (std::uint32_t n = from; n < to; ++n) out.push_back(trail.point(n));
  return out;
}

TEST(ConvoyTrail, ItsPointsAreEquallyFarApartAlongTheWayDriven) {
  Trail trail;
  for (double angle = 0.0; angle < M_PI; angle += 0.01)
    trail.record({5 * std::sin(angle), 5 - 5 * std::cos(angle), 0});
  for (std::uint32_t n = 1; n < trail.end(); ++n)
    EXPECT_NEAR((trail.point(n) - trail.point(n - 1)).norm(), Trail::kSpacing, 0.02);
  EXPECT_NEAR(trail.length(), 5 * M_PI, 0.6);
}

TEST(ConvoyTrail, ALeaderThatDrivesBackMovesBackOnItsPath) {
  Trail trail = straight_trail(10.0);
  const std::uint32_t end = trail.end();
  EXPECT_NEAR(trail.leader_at({10.2, 0, 0}), 10.2, 1e-6);
  for (double x = 10.0; x > 6.0; x -= 0.1) trail.record({x, 0, 0});
  EXPECT_EQ(trail.end(), end) << "nothing was added";
  EXPECT_NEAR(trail.leader_at({6.0, 0.1, 0}), 6.0, 1e-6);
}

TEST(ConvoyTrail, APlaceBeforeItsBeginningHasANegativePosition) {
  const Trail trail = straight_trail(10.0);
  EXPECT_NEAR(trail.project({-2.0, 0, 0}, 0, 10)->along, -2.0, 1e-6);
  EXPECT_NEAR(trail.project({3.3, 0.4, 0}, 0, 10)->along, 3.3, 1e-6);
  EXPECT_NEAR(trail.project({3.3, 0.4, 0}, 0, 10)->offset, 0.4, 1e-6);
  EXPECT_NEAR(trail.at(3.3).x(), 3.3, 1e-6);
}

TEST(ConvoyTrail, PiecesArriveInAnyOrderAndTwice) {
  const Trail complete = straight_trail(20.0);
  Trail trail;
  EXPECT_TRUE(trail.add(20, points(complete, 20, 28)));
  EXPECT_TRUE(trail.add(24, points(complete, 24, 32))) << "half of it is known";
  EXPECT_TRUE(trail.add(36, points(complete, 36, 40))) << "adjacent to nothing: ignored";
  EXPECT_EQ(trail.end(), 32u);
  EXPECT_TRUE(trail.add(12, points(complete, 12, 20)));
  EXPECT_EQ(trail.first(), 12u);
  for (std::uint32_t n = trail.first(); n < trail.end(); ++n)
    EXPECT_EQ(trail.point(n), complete.point(n)) << n;
}

TEST(ConvoyTrail, PointsThatAreNoPathAreRefused) {
  const Trail complete = straight_trail(20.0);
  Trail trail;
  trail.add(0, points(complete, 0, 8));
  const std::vector<Eigen::Vector3d> far{{4, 0, 0}, {40, 0, 0}}, beside{{4, 30, 0}, {4.5, 30, 0}};
  const std::vector<Eigen::Vector3d> unknown{{4, NAN, 0}, {4.5, 0, 0}};
  EXPECT_FALSE(trail.add(8, far));
  EXPECT_FALSE(trail.add(8, beside));
  EXPECT_FALSE(trail.add(8, unknown));
  EXPECT_TRUE(trail.add(UINT32_MAX - 9, points(complete, 0, 8))) << "of the future: ignored";
  EXPECT_FALSE(trail.add(UINT32_MAX - 4, points(complete, 0, 8)));
  EXPECT_EQ(trail.end(), 8u);
}

TEST(ConvoyTrail, IsBounded) {
  const Trail trail = straight_trail(500.0);
  EXPECT_EQ(trail.end() - trail.first(), Trail::kCapacity);
  EXPECT_NEAR(trail.at(trail.length()).x(), 500.0, Trail::kSpacing);
}

TEST(ConvoySpacing, KeepsItsGapAndNeverDrivesBackwards) {
  const Spacing spacing{};
  EXPECT_NEAR(spacing.speed(spacing.wanted(0.8), 0.8, 2.0), 0.8, 1e-9) << "at the wanted gap, as fast";
  EXPECT_EQ(spacing.speed(spacing.standstill, 0.0, 2.0), 0.0);
  EXPECT_EQ(spacing.speed(0.3, 0.0, 2.0), 0.0);
  EXPECT_EQ(spacing.speed(20.0, 1.0, 1.2), 1.2);
}

// A speed step of the leader: no follower of six overshoots its predecessor.
TEST(ConvoySpacing, AStepOfSpeedDoesNotGrowAlongTheConvoy) {
  const Spacing spacing{};
  constexpr int kRobots = 6;
  constexpr double kTick = 0.05, kSlow = 0.4, kFast = 1.0;
  std::vector<double> x(kRobots), v(kRobots, kSlow), highest(kRobots, 0.0), smallest(kRobots, 1e9);
  for (int i = 0; i < kRobots; ++i) x[static_cast<std::size_t>(i)] = -i * spacing.wanted(kSlow);
  for (double t = 0.0; t < 120.0; t += kTick) {
    const std::vector<double> before = v, at = x;
    v[0] = t < 60.0 ? kFast : 0.0;
    for (std::size_t i = 1; i < kRobots; ++i) {
      const double wanted = spacing.speed(at[i - 1] - at[i], before[i - 1], 5.0);
      v[i] += std::clamp(wanted - v[i], -1.0 * kTick, 1.0 * kTick);  // 1 m/s2
      smallest[i] = std::min(smallest[i], at[i - 1] - at[i]);
    }
    for (std::size_t i = 0; i < kRobots; ++i) {
      x[i] += v[i] * kTick;
      highest[i] = std::max(highest[i], v[i]);
    }
  }
  for (std::size_t i = 1; i < kRobots; ++i) {
    EXPECT_LE(highest[i], 1.02 * highest[i - 1]) << i;
    EXPECT_GT(smallest[i], 0.5) << i;
    EXPECT_NEAR(x[i - 1] - x[i], spacing.standstill, 0.1) << i;
  }
}

// The last of six is stationary 3 s after the leader (wanted: 2 s), and none is too near.
TEST(ConvoySpacing, AConvoyThatHaltsClosesUpAtOnce) {
  const Spacing spacing{};
  constexpr int kRobots = 6;
  constexpr double kTick = 0.05, kSpeed = 0.7, kDeadBand = 0.4;
  std::vector<double> x(kRobots), v(kRobots, kSpeed);
  for (std::size_t i = 0; i < kRobots; ++i) x[i] = -static_cast<double>(i) * spacing.wanted(kSpeed);
  double leader_stands = 0.0, last_stands = 0.0;
  for (double t = 0.0; t < 20.0; t += kTick) {
    const std::vector<double> before = v, at = x;
    v[0] = std::max(0.0, v[0] - kTick);
    if (before[0] > 0.0) leader_stands = t;
    for (std::size_t i = 1; i < kRobots; ++i) {
      const double gap = at[i - 1] - at[i];
      double wanted = before[0] > 0.0 ? spacing.speed(gap, before[i - 1], 1.0)
                                      : spacing.halting_speed(gap, before[i - 1], 1.0);
      if (before[i - 1] == 0.0 && gap - spacing.standstill < kDeadBand) wanted = 0.0;
      v[i] += std::clamp(wanted - v[i], -1.0 * kTick, 1.0 * kTick);
      if (v[i] > 0.0) last_stands = t;
    }
    for (std::size_t i = 0; i < kRobots; ++i) x[i] += v[i] * kTick;
  }
  EXPECT_LE(last_stands - leader_stands, 3.0);
  for (std::size_t i = 1; i < kRobots; ++i) {
    EXPECT_GT(x[i - 1] - x[i], spacing.standstill - 0.1) << i;
    EXPECT_LT(x[i - 1] - x[i], spacing.standstill + kDeadBand) << i;
  }
}

TEST(ConvoyGovernor, TheLeaderSlowsToTheLastOneAndWaitsForABoundedTime) {
  Governor governor;
  EXPECT_TRUE(std::isinf(governor.step({5.9, 0.2, 0.0}, 1.5, 0.1).limit));
  EXPECT_EQ(governor.step({6.1, 0.2, 0.0}, 1.5, 0.1).limit, 0.2);
  EXPECT_TRUE(std::isinf(governor.step({6.1, 0.2, 0.0}, 3.0, 0.1).limit)) << "a wider gap was asked for";
  Governor::Verdict last{};
  for (int i = 0; i < 310; ++i) last = governor.step({8.0, 0.0, 0.0}, 1.5, 0.1);
  EXPECT_TRUE(last.split);
  EXPECT_TRUE(std::isinf(last.limit)) << "it drives on";
  EXPECT_FALSE(governor.step({2.0, 0.5, 0.0}, 1.5, 0.1).split) << "the gap closed";
}

TEST(ConvoyGovernor, ASilentMemberSlowsTheLeaderForABoundedTime) {
  Governor governor;
  EXPECT_TRUE(std::isinf(governor.step({2.0, 0.5, 4.9}, 1.5, 0.1).limit));
  EXPECT_EQ(governor.step({2.0, 0.5, 5.1}, 1.5, 0.1).limit, 0.3);
  Governor::Verdict last{};
  for (int i = 0; i < 210; ++i) last = governor.step({2.0, 0.5, 9.0}, 1.5, 0.1);
  EXPECT_TRUE(last.split);
  EXPECT_TRUE(std::isinf(last.limit));
}

TEST(ConvoyGovernor, TheLeaderDrivesSlowlyWhileOthersCloseUpToOneThatLeft) {
  Governor governor;
  EXPECT_EQ(governor.step({2.1, 0.7, 0.0}, 1.5, 0.1).share, 1.0);
  governor.member_left();
  EXPECT_EQ(governor.step({2.1, 0.7, 0.0}, 1.5, 0.1).share, 0.5) << "the new gap was not reported yet";
  for (int i = 0; i < 30; ++i) EXPECT_EQ(governor.step({4.8, 0.7, 0.0}, 1.5, 0.1).share, 0.5);
  EXPECT_EQ(governor.step({2.2, 0.7, 0.0}, 1.5, 0.1).share, 1.0) << "closed up";
  governor.member_left();
  Governor::Verdict last{};
  for (int i = 0; i < 110; ++i) last = governor.step({4.8, 0.7, 0.0}, 1.5, 0.1);
  EXPECT_EQ(last.share, 1.0) << "for a bounded time";
}

}  // namespace
}  // namespace adit::nav
