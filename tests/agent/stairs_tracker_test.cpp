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

std::vector<Staircase> take(StairsTracker& tracker, const Staircase& seen, double x) {
  return tracker.take(std::array{seen}, {x, 2.5, 0.0});
}

TEST(StairsTracker, ConfirmsWhatItSawFromThreePlaces) {
  StairsTracker tracker;
  EXPECT_TRUE(take(tracker, flight(), 5.0).empty());
  EXPECT_TRUE(take(tracker, flight(), 5.2).empty()) << "as good as the same place";
  EXPECT_TRUE(take(tracker, flight(), 5.4).empty());
  EXPECT_TRUE(tracker.confirmed().empty());
  const auto found = take(tracker, flight(), 5.8);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].steps, 6);
  EXPECT_EQ(tracker.confirmed().size(), 1U);
}

TEST(StairsTracker, AStandingRobotConfirmsNothing) {
  StairsTracker tracker;
  for (int n = 0; n < 20; ++n) EXPECT_TRUE(take(tracker, flight(), 5.0).empty());
}

TEST(StairsTracker, ReportsOnceAndThenWhatChanged) {
  StairsTracker tracker;
  for (const double x : {4.0, 4.5, 5.0}) (void)take(tracker, flight(), x);
  EXPECT_TRUE(take(tracker, flight(), 5.5).empty());
  const auto longer = take(tracker, flight(8.0, 9), 6.0);
  ASSERT_EQ(longer.size(), 1U);
  EXPECT_EQ(longer[0].steps, 9);
  EXPECT_EQ(tracker.confirmed().size(), 1U);
}

TEST(StairsTracker, RefinesButNeverBecomesCertain) {
  StairsTracker tracker;
  for (int n = 0; n < 100; ++n) {
    Staircase seen = flight();
    seen.rise += n % 2 == 0 ? 0.004 : -0.004;
    (void)take(tracker, seen, 4.0 + 0.01 * n);
  }
  ASSERT_EQ(tracker.confirmed().size(), 1U);
  EXPECT_NEAR(tracker.confirmed()[0].rise, 0.2, 0.002);
  EXPECT_GE(tracker.confirmed()[0].sigma.rise, 0.002);
}

TEST(StairsTracker, IsBounded) {
  StairsTracker tracker;
  for (int n = 0; n < 1000; ++n) (void)take(tracker, flight(10.0 * n), 10.0 * n - 2.0);
  for (const double x : {1.0, 2.0, 3.0}) (void)take(tracker, flight(), x);
  EXPECT_EQ(tracker.confirmed().size(), 1U);
}

}  // namespace
}  // namespace adit::agent
