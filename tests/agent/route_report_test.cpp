// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/telemetry/route_report.hpp"

#include <gtest/gtest.h>

namespace adit::agent {
namespace {

contract::Route along(double from, double to, std::uint32_t unknown = 0) {
  return {.goal_id = 1, .corners = 3, .points = {{from, 0, 0}, {5, 0, 0}, {to, 5, 0}}, .unknown = unknown};
}

TEST(RouteReport, NothingIsSentWhileTheRouteIsUnchanged) {
  RouteReport report;
  Time now{};
  EXPECT_TRUE(report.due(along(0, 5), now));
  for (double x = 0.1; x < 4.9; x += 0.1) EXPECT_FALSE(report.due(along(x, 5), now += 100ms)) << x;
}

TEST(RouteReport, AnotherWayIsSentAtMostOnceASecond) {
  RouteReport report;
  Time now{};
  EXPECT_TRUE(report.due(along(0, 5), now));
  EXPECT_FALSE(report.due(along(0, 9), now + 500ms));
  EXPECT_TRUE(report.due(along(0, 9), now + 1s));
  EXPECT_FALSE(report.due(along(0, 5), now + 2s, 4.0)) << "a thin link waits longer";
  EXPECT_TRUE(report.due(along(0, 5), now + 5s, 4.0));
}

TEST(RouteReport, AnotherGoalIsSentAtOnceAndTheEndWithinASecond) {
  RouteReport report;
  const Time now{};
  EXPECT_FALSE(report.due({}, now)) << "stations expect none";
  EXPECT_TRUE(report.due(along(0, 5), now));
  contract::Route other = along(0, 5);
  other.goal_id = 2;
  EXPECT_TRUE(report.due(other, now));
  EXPECT_FALSE(report.due({}, now));
  EXPECT_TRUE(report.due({}, now + 1s));
  EXPECT_FALSE(report.due({}, now + 10s));
}

TEST(RouteReport, ARouteThatIsLostAndFoundAgainAndAgainIsSentOnceASecond) {
  RouteReport report;
  int sent = 0;
  for (int i = 0; i < 100; ++i)
    sent += report.due(i % 2 == 0 ? along(0, 5) : contract::Route{}, Time(i * 100ms)) ? 1 : 0;
  EXPECT_LE(sent, 10);
}

TEST(RouteReport, NewlySeenGroundIsSent) {
  RouteReport report;
  Time now{};
  EXPECT_TRUE(report.due(along(0, 5, 0b11), now));
  EXPECT_FALSE(report.due(along(1, 5, 0b11), now += 2s));
  EXPECT_TRUE(report.due(along(1, 5, 0b10), now += 2s));
  EXPECT_TRUE(report.due(along(1, 5, 0b00), now += 2s));
  EXPECT_FALSE(report.due(along(1, 5, 0b00), now += 2s));
}

}  // namespace
}  // namespace adit::agent
