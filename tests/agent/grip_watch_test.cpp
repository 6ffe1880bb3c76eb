// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/grip_watch.hpp"

#include <gmock/gmock.h>

namespace adit::agent {
namespace {

using Event = GripWatch::Event;

/// Ten poses a second for some seconds, moving on by `speed`, m/s; the events.
struct Drive {
  std::vector<Event> drive(double seconds, bool slips, double speed) {
    std::vector<Event> events;
    for (int n = 0; n < static_cast<int>(10 * seconds); ++n) {
      now += 100ms;
      at.x() += 0.1 * speed;
      if (const Event event = watch.note(slips, at, now); event != Event::none) events.push_back(event);
    }
    return events;
  }
  GripWatch watch{};
  Time now{};
  Eigen::Vector3d at{0, 0, 0};
};

TEST(GripWatch, TellsOnceOfASlipThatLasts) {
  Drive robot;
  EXPECT_TRUE(robot.drive(0.9, true, 0.5).empty());
  EXPECT_TRUE(robot.drive(10, false, 0.5).empty());
  EXPECT_EQ(robot.drive(20, true, 0.5), std::vector{Event::slips}) << "it moves on";
  EXPECT_TRUE(robot.drive(1, false, 0.5).empty());
  EXPECT_TRUE(robot.drive(5, true, 0.5).empty()) << "the same slip";
  EXPECT_TRUE(robot.drive(4, false, 0.5).empty());
  EXPECT_EQ(robot.drive(5, true, 0.5), std::vector{Event::slips});
}

TEST(GripWatch, WheelsThatTurnWhileTheBodyStandsAreStuck) {
  Drive robot;
  EXPECT_EQ(robot.drive(4.9, true, 0.01), std::vector{Event::slips});
  EXPECT_EQ(robot.drive(0.5, true, 0.0), std::vector{Event::stuck});
  EXPECT_EQ(robot.drive(10.1, true, 0.01), (std::vector{Event::stuck, Event::stuck}));
  EXPECT_TRUE(robot.drive(30, false, 0.0).empty()) << "it stands, and its wheels do, too";
}

TEST(GripWatch, OnlyTheTimeInWhichItSlipsCounts) {
  Drive robot;
  for (int n = 0; n < 3; ++n) {
    EXPECT_TRUE(robot.drive(0.3, true, 0.0).empty());
    EXPECT_TRUE(robot.drive(2, false, 0.0).empty());
  }
  EXPECT_EQ(robot.drive(3, true, 0.0), std::vector{Event::slips});
  EXPECT_TRUE(robot.drive(2.5, false, 0.0).empty());
  EXPECT_TRUE(robot.drive(1, true, 0.0).empty()) << "4.5 s so far";
  EXPECT_EQ(robot.drive(1, true, 0.0), std::vector{Event::stuck});
}

TEST(GripWatch, AGapBetweenTwoScansCountsAsThreeScansAtMost) {
  Drive robot;
  std::vector<Event> events;
  for (int n = 0; n < 16; ++n) {
    robot.now += 2s;
    events.push_back(robot.watch.note(true, robot.at, robot.now));
  }
  EXPECT_THAT(events, testing::Each(testing::AnyOf(Event::none, Event::slips))) << "15 gaps of 0.3 s";
  EXPECT_THAT(events, testing::Contains(Event::slips).Times(1));
}

TEST(GripWatch, WhatSlippedBeforeAModeBeganDoesNotCountAgainstIt) {
  Drive robot;
  EXPECT_EQ(robot.drive(4.5, true, 0.0), std::vector{Event::slips});
  robot.watch.begin_mode();
  EXPECT_TRUE(robot.drive(4.5, true, 0.0).empty()) << "the same slip";
  EXPECT_EQ(robot.drive(1, true, 0.0), std::vector{Event::stuck});
}

}  // namespace
}  // namespace adit::agent
