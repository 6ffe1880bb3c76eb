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

TEST(StairsTracker, ConfirmsWhatItSawFromTwoPlacesThatAreFarApart) {
  StairsTracker tracker;
  EXPECT_EQ(take(tracker, flight(), 5.0), 0U);
  EXPECT_EQ(take(tracker, flight(), 5.9), 0U) << "both clouds may have scans in common";
  StairsTracker other;
  EXPECT_EQ(take(other, flight(), 5.0), 0U);
  EXPECT_EQ(take(other, flight(), 6.1), 1U);
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

using Riser = perception::StairsCheck::Riser;

/// A tracker that confirmed a flight of so many steps, from x = 4 to 5.
StairsTracker confirmed_one(int steps = 6) {
  StairsTracker tracker;
  for (const double x : {4.0, 4.5, 5.0}) (void)take(tracker, flight(8.0, steps), x);
  return tracker;
}

/// A cloud in which no staircase was found.
void look(StairsTracker& tracker, const perception::StairsCheck& check, double x) {
  StairsTracker::Checks checks;
  for (const StairsTracker::Tracked& track : tracker.all()) checks[track.id] = check;
  tracker.take({}, {x, 2.5, 0.0}, checks);
}

constexpr perception::StairsCheck kThrough{.through = 200, .on = 10};

TEST(StairsTracker, AnEndThatIsLevelFromTwoPlacesIsNoStep) {
  StairsTracker tracker = confirmed_one(7);
  look(tracker, {.top = Riser::level}, 10.0);
  EXPECT_EQ(tracker.confirmed()[0].stairs.steps, 7) << "one place may be wrong";
  look(tracker, {.top = Riser::level}, 10.1);
  EXPECT_EQ(tracker.confirmed()[0].stairs.steps, 7) << "as good as the same place";
  look(tracker, {.top = Riser::level}, 10.4);
  EXPECT_EQ(tracker.confirmed()[0].stairs.steps, 6);
  EXPECT_TRUE(tracker.confirmed()[0].top_known);
  EXPECT_FALSE(tracker.confirmed()[0].foot_known);
  EXPECT_EQ(take(tracker, flight(8.0, 7), 10.8), 1U);
  EXPECT_EQ(tracker.confirmed()[0].stairs.steps, 6) << "it stays away";
}

TEST(StairsTracker, ACheckIsOfTheStepsThatWereKnownBeforeItsCloud) {
  StairsTracker tracker = confirmed_one(5);
  const std::uint64_t id = tracker.confirmed()[0].id;
  tracker.take(std::array{flight(8.0, 6)}, {10.0, 2.5, 0.0},
               {{id, {.top = Riser::there, .above = Riser::level}}});
  EXPECT_EQ(tracker.confirmed()[0].stairs.steps, 6);
  tracker.take(std::array{flight(8.0, 6)}, {10.5, 2.5, 0.0}, {{id, {.top = Riser::level}}});
  EXPECT_EQ(tracker.confirmed()[0].stairs.steps, 5) << "the sixth is level";
}

TEST(StairsTracker, ALowestStepThatIsLevelGoesAsWell) {
  StairsTracker tracker = confirmed_one(7);
  for (const double x : {6.0, 6.5}) look(tracker, {.foot = Riser::level}, x);
  const StairsTracker::Tracked found = tracker.confirmed().at(0);
  EXPECT_EQ(found.stairs.steps, 6);
  EXPECT_NEAR(found.stairs.foot.x(), 8.3, 0.01);
  EXPECT_NEAR(found.stairs.foot.z(), 0.3, 0.01);
  EXPECT_TRUE(found.foot_known);
}

TEST(StairsTracker, AStepThatWasSeenAsOftenStays) {
  StairsTracker tracker = confirmed_one(6);
  for (const double x : {5.5, 6.0, 6.5}) look(tracker, {.top = Riser::there}, x);
  for (const double x : {7.0, 7.5, 8.0}) look(tracker, {.top = Riser::level}, x);
  EXPECT_EQ(tracker.confirmed()[0].stairs.steps, 6);
}

TEST(StairsTracker, IsGoneWhenRaysPassThroughFromThreePlaces) {
  StairsTracker tracker = confirmed_one();
  const auto id = tracker.confirmed()[0].id;
  for (const double x : {5.5, 6.0, 6.1, 6.2}) look(tracker, kThrough, x);
  EXPECT_TRUE(tracker.take_withdrawn().empty());
  look(tracker, kThrough, 6.5);
  EXPECT_EQ(tracker.take_withdrawn(), std::vector{id});
  EXPECT_TRUE(tracker.confirmed().empty());
  EXPECT_TRUE(tracker.take_withdrawn().empty()) << "once";
}

TEST(StairsTracker, IsNotGoneWhenItIsSeenMeanwhile) {
  StairsTracker tracker = confirmed_one();
  for (const double x : {5.5, 6.0}) look(tracker, kThrough, x);
  EXPECT_EQ(take(tracker, flight(), 6.5), 1U);
  for (const double x : {7.0, 7.5}) look(tracker, kThrough, x);
  look(tracker, {.through = 50, .on = 50}, 8.0);  // Half of it shows.
  for (const double x : {8.5, 9.0}) look(tracker, kThrough, x);
  EXPECT_EQ(tracker.confirmed().size(), 1U);
}

TEST(StairsTracker, IsBounded) {
  StairsTracker tracker;
  for (int n = 0; n < 1000; ++n) (void)take(tracker, flight(10.0 * n), 10.0 * n - 2.0);
  for (const double x : {1.0, 2.0, 3.0}) (void)take(tracker, flight(), x);
  EXPECT_EQ(tracker.confirmed().size(), 1U);
}

}  // namespace
}  // namespace adit::agent
