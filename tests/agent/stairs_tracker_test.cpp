// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/stairs/stairs_tracker.hpp"

#include <gtest/gtest.h>

#include <array>

namespace adit::agent {
namespace {

Staircase flight(double x = 8.0, int steps = 6) {
  return {.foot = {x, 2.5, 0.1},
          .rise = 0.2,
          .run = 0.3,
          .width = 1.2,
          .steps = steps,
          .sigma = {.place = 0.02, .heading = 0.01, .rise = 0.004, .run = 0.005, .width = 0.05}};
}

/// The number of confirmed ones afterwards.
std::size_t take(StairsTracker& tracker, const Staircase& seen, double x) {
  tracker.take(std::array{seen}, {x, 2.5, 0.0});
  return tracker.confirmed().size();
}

TEST(StairsTracker, ConfirmsWhatItSawFromThreePlaces) {
  StairsTracker tracker;
  EXPECT_EQ(take(tracker, flight(), 5.0), 0U);
  EXPECT_EQ(take(tracker, flight(), 5.2), 0U) << "as good as the same place";
  EXPECT_EQ(take(tracker, flight(), 5.4), 0U);
  EXPECT_EQ(take(tracker, flight(), 5.8), 1U);
  EXPECT_EQ(tracker.confirmed()[0].stairs.steps, 6);
}

TEST(StairsTracker, AStandingRobotConfirmsNothing) {
  StairsTracker tracker;
  for (int n = 0; n < 20; ++n) EXPECT_EQ(take(tracker, flight(), 5.0), 0U);
}

TEST(StairsTracker, AStaircaseKeepsItsNumberAndNoneHasThatOfAnotherInstance) {
  StairsTracker tracker(1), next(2);
  for (const double x : {4.0, 4.5, 5.0}) {
    (void)take(tracker, flight(), x);
    (void)take(next, flight(), x);
  }
  const auto before = tracker.confirmed().at(0);
  EXPECT_EQ(take(tracker, flight(8.0, 9), 6.0), 1U);
  EXPECT_EQ(tracker.confirmed()[0].stairs.steps, 9);
  EXPECT_EQ(tracker.confirmed()[0].id, before.id);
  EXPECT_NE(next.confirmed().at(0).id, before.id);
  tracker.clear();
  for (const double x : {4.0, 4.5, 5.0}) (void)take(tracker, flight(), x);
  EXPECT_NE(tracker.confirmed().at(0).id, before.id);
}

TEST(StairsTracker, RefinesButNeverBecomesCertain) {
  StairsTracker tracker;
  for (int n = 0; n < 100; ++n) {
    Staircase seen = flight();
    seen.rise += n % 2 == 0 ? 0.004 : -0.004;
    (void)take(tracker, seen, 4.0 + 0.01 * n);
  }
  ASSERT_EQ(tracker.confirmed().size(), 1U);
  EXPECT_NEAR(tracker.confirmed()[0].stairs.rise, 0.2, 0.002);
  EXPECT_GE(tracker.confirmed()[0].stairs.sigma.rise, 0.002);
}

TEST(StairsTracker, IsBounded) {
  StairsTracker tracker;
  for (int n = 0; n < 1000; ++n) (void)take(tracker, flight(10.0 * n), 10.0 * n - 2.0);
  for (const double x : {1.0, 2.0, 3.0}) (void)take(tracker, flight(), x);
  EXPECT_EQ(tracker.confirmed().size(), 1U);
}

}  // namespace
}  // namespace adit::agent
