// SPDX-License-Identifier: Apache-2.0
#include "core/findings/merge_stairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "core/time/random.hpp"

namespace adit::findings {
namespace {

constexpr double kDegree = M_PI / 180;

/// Twelve steps to the north-east.
Staircase twelve_steps() {
  return {.foot = {8.0, 2.5, 0.1},
          .heading = 40 * kDegree,
          .rise = 0.17,
          .run = 0.28,
          .width = 1.2,
          .steps = 12,
          .sigma = {.place = 0.03, .heading = 0.02, .rise = 0.003, .run = 0.005, .width = 0.05}};
}

/// The part of a flight that has so many steps, from one of them on.
Staircase part_of(Staircase s, int first, int steps) {
  const Eigen::Vector2d ahead = first * s.run * s.direction();
  s.foot += Eigen::Vector3d(ahead.x(), ahead.y(), first * s.rise);
  s.steps = steps;
  return s;
}

/// The flight moved to the left of its direction, ahead and up, m.
Staircase moved(Staircase s, double left, double ahead, double up) {
  const Eigen::Vector2d u = s.direction();
  s.foot += Eigen::Vector3d(ahead * u.x() - left * u.y(), ahead * u.y() + left * u.x(), up);
  return s;
}

std::vector<MergedStairs> merged(const std::vector<Staircase>& flights) {
  std::vector<SeenStairs> seen;
  for (std::size_t i = 0; i < flights.size(); ++i)
    seen.push_back({{"r" + std::to_string(i + 1), 7}, flights[i]});
  return merge_stairs(seen);
}

TEST(MergeStairs, OneReportStaysAsItIs) {
  EXPECT_TRUE(merge_stairs({}).empty());
  const auto one = merged({twelve_steps()});
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].stairs, twelve_steps());
}

TEST(MergeStairs, SeenFromBothEndsItHasAllSteps) {
  const Staircase all = twelve_steps();
  const auto both = merged({part_of(all, 0, 8), part_of(all, 5, 7)});
  ASSERT_EQ(both.size(), 1U);
  EXPECT_EQ(both[0].seen.size(), 2U);
  EXPECT_EQ(both[0].stairs.steps, 12);
  EXPECT_NEAR((both[0].stairs.foot - all.foot).norm(), 0, 1e-6);
  EXPECT_NEAR((both[0].stairs.top() - all.top()).norm(), 0, 1e-6);
  EXPECT_LT(both[0].stairs.sigma.rise, all.sigma.rise);
  const auto neither_shares_one = merged({part_of(all, 6, 6), part_of(all, 0, 6)});
  ASSERT_EQ(neither_shares_one.size(), 1U);
  EXPECT_EQ(neither_shares_one[0].stairs.steps, 12);
  const auto by_a_third =
      merged({part_of(all, 0, 4), part_of(all, 8, 4), moved(part_of(all, 2, 8), 0.02, 0.03, -0.02)});
  ASSERT_EQ(by_a_third.size(), 1U);
  EXPECT_EQ(by_a_third[0].stairs.steps, 12);
}

TEST(MergeStairs, WithTheSameCountAndPlacesThatAllowItNoStepIsAdded) {
  Staircase other = moved(twelve_steps(), 0.1, 0.2, 0.1);
  other.sigma.place = 0.2;
  const auto both = merged({twelve_steps(), other});
  ASSERT_EQ(both.size(), 1U);
  EXPECT_EQ(both[0].stairs.steps, 12);
  other.sigma.place = 0.03;
  other.foot = part_of(twelve_steps(), 1, 3).foot;
  ASSERT_EQ(merged({twelve_steps(), other}).size(), 1U);
  EXPECT_EQ(merged({twelve_steps(), other})[0].stairs.steps, 13) << "here they do not";
}

TEST(MergeStairs, MeansAreWeightedByInformation) {
  Staircase good = twelve_steps(), poor = twelve_steps();
  good.sigma = {.place = 0.01, .heading = 0.01, .rise = 0.002, .run = 0.004, .width = 0.02};
  poor.sigma = {.place = 0.03, .heading = 0.03, .rise = 0.006, .run = 0.012, .width = 0.06};
  poor = moved(poor, 0.1, 0, 0);
  poor.rise += 0.01;
  poor.run += 0.01;
  poor.width += 0.2;
  poor.heading += 0.1;
  const auto both = merged({poor, good});
  ASSERT_EQ(both.size(), 1U);
  const Staircase& mean = both[0].stairs;
  EXPECT_NEAR(mean.rise, good.rise + 0.001, 1e-9) << "nine parts to one";
  EXPECT_NEAR(mean.run, good.run + 0.001, 1e-9);
  EXPECT_NEAR(mean.width, good.width + 0.02, 1e-9);
  EXPECT_NEAR(mean.heading, good.heading + 0.01, 1e-9);
  EXPECT_NEAR((mean.foot - good.foot).norm(), 0.01, 1e-9);
  EXPECT_NEAR(mean.sigma.width, 0.02 / std::sqrt(10 / 9.0), 1e-9);
}

TEST(MergeStairs, HeadingsMeetAcrossTheHalfTurn) {
  Staircase a = twelve_steps(), b = twelve_steps();
  a.heading = M_PI - 0.02;
  b.heading = -M_PI + 0.02;
  const auto both = merged({a, b});
  ASSERT_EQ(both.size(), 1U);
  EXPECT_NEAR(std::abs(both[0].stairs.heading), M_PI, 1e-9);
}

TEST(MergeStairs, OtherFlightsStayApart) {
  Staircase flight = twelve_steps();
  for (const double sigma : {0.01, 0.1, 0.5, 3.0}) {
    flight.sigma.place = sigma;
    const double length = (flight.steps - 1) * flight.run, height = (flight.steps - 1) * flight.rise;
    const auto count = [&](const Staircase& other) { return merged({flight, other}).size(); };
    EXPECT_EQ(count(moved(flight, 0, 0, 2.4)), 2U) << "above it, on another floor";
    EXPECT_EQ(count(moved(flight, 0, 0, height + flight.rise)), 2U) << "above it, without a gap in height";
    EXPECT_EQ(count(moved(flight, 1.2, 0, 0)), 2U) << "beside it";
    EXPECT_EQ(count(moved(flight, -0.7, 0.5, 0.3)), 2U);
    EXPECT_EQ(count(moved(flight, 0, length + 1.2, height + flight.rise)), 2U) << "behind a landing";
    EXPECT_EQ(count(moved(flight, 0, -(length + 1.2), -(height + flight.rise))), 2U);
    Staircase turned = flight;
    turned.heading += 20 * kDegree;
    EXPECT_EQ(count(turned), 2U);
    turned.heading = flight.heading - M_PI;
    turned.foot = flight.top();
    EXPECT_EQ(count(turned), 2U) << "back, in the same stairwell";
    turned.heading = flight.heading + M_PI / 2;
    EXPECT_EQ(count(turned), 2U);
  }
}

TEST(MergeStairs, PlacesMayDifferAsFarAsTheirSigmasAllow) {
  Staircase a = twelve_steps(), b = moved(twelve_steps(), 0, 0, 0.35);
  EXPECT_EQ(merged({a, b}).size(), 2U);
  b.sigma.place = 0.1;
  EXPECT_EQ(merged({a, b}).size(), 1U);
  b = moved(twelve_steps(), 0.55, 0, 0);
  EXPECT_EQ(merged({a, b}).size(), 1U);
  b = twelve_steps();
  b.rise = 0.22;
  EXPECT_EQ(merged({a, b}).size(), 2U);
  b.sigma.rise = 0.03;
  EXPECT_EQ(merged({a, b}).size(), 1U);
}

TEST(MergeStairs, TheOrderOfReportsDoesNotMatter) {
  Random random(3);
  std::vector<SeenStairs> seen;
  for (int flight = 0; flight < 6; ++flight) {
    Staircase s = twelve_steps();
    s.foot.x() += 10 * (flight / 2);
    s.foot.z() += 3.0 * (flight % 2);
    for (std::uint64_t robot = 1; robot <= 5; ++robot) {
      const int first = static_cast<int>(random.below(5));
      Staircase one = moved(part_of(s, first, 12 - first), 0.05 * random.uniform(), 0.05 * random.uniform(),
                            0.05 * random.uniform());
      one.rise += 0.004 * random.uniform();
      one.heading += 0.05 * random.uniform();
      seen.push_back({{"r" + std::to_string(robot), static_cast<std::uint64_t>(flight + 1)}, one});
    }
  }
  const auto first = merge_stairs(seen);
  ASSERT_EQ(first.size(), 6U);
  for (const MergedStairs& stairs : first) {
    EXPECT_EQ(stairs.seen.size(), 5U);
    EXPECT_EQ(stairs.seen.front().key.robot, "r1");
    EXPECT_TRUE(valid(stairs.stairs));
  }
  for (int round = 0; round < 50; ++round) {
    for (std::size_t i = seen.size() - 1; i > 0; --i) std::swap(seen[i], seen[random.below(i + 1)]);
    ASSERT_EQ(merge_stairs(seen), first);
  }
}

TEST(MergeStairs, AnyValidReportsGiveValidStaircasesInTime) {
  Random random(4);
  const auto between = [&](double least, double most) { return least + (most - least) * random.uniform(); };
  std::vector<SeenStairs> seen;
  for (std::uint64_t i = 1; i <= 4096; ++i) {
    const Staircase s{
        .foot = {between(-9, 9), between(-9, 9), between(-3, 3)},
        .heading = between(-M_PI, M_PI),
        .rise = between(Staircase::kLeastRise, Staircase::kMostRise),
        .run = between(Staircase::kLeastRun, Staircase::kMostRun),
        .width = between(Staircase::kLeastWidth, Staircase::kMostWidth),
        .steps = Staircase::kLeastSteps + static_cast<int>(random.below(98)),
        .sigma = random.chance(0.2) ? Staircase::Sigmas{} : Staircase::Sigmas{10.0, M_PI, 1.0, 1.0, 10.0}};
    ASSERT_TRUE(valid(s));
    seen.push_back({{"r1", i}, s});
  }
  const auto start = std::chrono::steady_clock::now();
  const auto all = merge_stairs(std::move(seen));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  std::size_t count = 0;
  for (const MergedStairs& stairs : all) {
    EXPECT_TRUE(valid(stairs.stairs));
    count += stairs.seen.size();
  }
  EXPECT_EQ(count, 4096U);
}

}  // namespace
}  // namespace adit::findings
