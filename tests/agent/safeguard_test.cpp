// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "robot_agent/safeguard/battery_return.hpp"
#include "robot_agent/safeguard/battery_watch.hpp"
#include "robot_agent/safeguard/link_loss.hpp"

namespace adit::agent {
namespace {

class LinkLossTest : public testing::Test {
 protected:
  LinkLoss::Step at(Duration time, bool autonomous = true, bool arrived = false) {
    now = Time{1h} + time;
    return loss.tick({held, autonomous, arrived, heard, place}, now);
  }
  void hear(Duration time, double x) {
    heard = Time{1h} + time;
    place = Eigen::Vector2d(x, 0);
    EXPECT_FALSE(at(time).lost);
  }
  static LinkLossParams with(OnLoss action) {
    LinkLossParams p;
    p.action = action;
    p.after = 10s;
    p.start = {-1, -1};
    return p;
  }
  LinkLoss loss{with(OnLoss::back)};
  bool held{true};
  Time heard{Time{1h}}, now{};
  std::optional<Eigen::Vector2d> place{Eigen::Vector2d(0, 0)};
};

TEST_F(LinkLossTest, IsReportedOnceAfterItsDelay) {
  EXPECT_FALSE(at(9900ms).lost);
  EXPECT_TRUE(at(10s).lost);
  EXPECT_FALSE(at(11s).lost);
  EXPECT_EQ(at(20s).silence, 20s);
  heard = Time{1h} + 21s;
  EXPECT_TRUE(at(21s).found);
  EXPECT_FALSE(at(22s).found);
}

TEST_F(LinkLossTest, WithoutAHolderNoLinkIsLost) {
  held = false;
  EXPECT_FALSE(at(100s).lost);
}

TEST_F(LinkLossTest, ContinuesWhereThatIsConfigured) {
  loss = LinkLoss(with(OnLoss::go_on));
  const auto step = at(10s);
  EXPECT_TRUE(step.lost);
  EXPECT_FALSE(step.hold);
  EXPECT_FALSE(step.go_to);
}

TEST_F(LinkLossTest, HoldsOnce) {
  loss = LinkLoss(with(OnLoss::hold));
  EXPECT_FALSE(at(9s).hold);
  EXPECT_TRUE(at(10s).hold);
  EXPECT_FALSE(at(11s).hold) << "whoever is at the robot may set it going";
}

TEST_F(LinkLossTest, GoesBackToTheLastPlaceWithLink) {
  hear(2s, 5);
  place = Eigen::Vector2d(12, 0);
  EXPECT_FALSE(at(11s).go_to);
  const auto step = at(12s);
  ASSERT_TRUE(step.go_to);
  EXPECT_EQ(*step.go_to, Eigen::Vector2d(5, 0));
  EXPECT_FALSE(at(13s).go_to) << "once";
}

TEST_F(LinkLossTest, GoesOnToTheStartWhenNobodyIsHeardThere) {
  hear(2s, 5);
  ASSERT_TRUE(at(12s).go_to);
  EXPECT_FALSE(at(30s).go_to);
  EXPECT_FALSE(at(31s, true, true).go_to);
  EXPECT_FALSE(at(39s, true, true).go_to);
  const auto step = at(41s, true, true);
  ASSERT_TRUE(step.go_to);
  EXPECT_EQ(*step.go_to, Eigen::Vector2d(-1, -1));
  EXPECT_FALSE(at(80s, true, true).go_to);
}

TEST_F(LinkLossTest, GoesToTheStartWhenTheHolderWasNeverHeardSince) {
  place.reset();
  const auto step = at(10s);
  ASSERT_TRUE(step.go_to);
  EXPECT_EQ(*step.go_to, Eigen::Vector2d(-1, -1));
}

TEST_F(LinkLossTest, ARefusedStepIsAskedForAgain) {
  hear(2s, 5);
  ASSERT_TRUE(at(12s).go_to);
  loss.refused(now);
  EXPECT_FALSE(at(12900ms).go_to);
  EXPECT_TRUE(at(13s).go_to);
  EXPECT_FALSE(at(14s).go_to);
}

TEST_F(LinkLossTest, MovesNoRobotThatHolds) {
  hear(2s, 5);
  EXPECT_FALSE(at(12s, false).go_to);
  EXPECT_FALSE(at(60s, false).go_to);
}

TEST_F(LinkLossTest, BeginsAnewWithTheNextLoss) {
  hear(2s, 5);
  ASSERT_TRUE(at(12s).go_to);
  hear(20s, 6);
  const auto step = at(30s);
  EXPECT_TRUE(step.lost);
  ASSERT_TRUE(step.go_to);
  EXPECT_EQ(*step.go_to, Eigen::Vector2d(6, 0));
}

TEST(BatteryReturn, PausesLongerAfterEachRefusalUpToABound) {
  BatteryReturn back;
  const BatteryReturn::Inputs in{.autonomous = true, .nearly_empty = true, .requests = 7};
  Time now{1h};
  back.begin(7, now);
  std::vector<double> pauses;
  Time last = now;
  for (int refusals = 0; refusals < 8; now += 1s) {
    if (!back.due(in, now)) continue;
    pauses.push_back(seconds(now - last));
    last = now;
    EXPECT_EQ(back.refused(Reason::terrain_stale, now), refusals == 0);
    ++refusals;
  }
  EXPECT_THAT(pauses, testing::ElementsAre(0, 1, 2, 4, 8, 16, 30, 30));
  EXPECT_TRUE(back.refused(Reason::goal_unreachable, now)) << "another reason";
}

TEST(BatteryReturn, AnOverruledReturnIsNotStored) {
  BatteryReturn back;
  back.begin(7, Time{1h});
  EXPECT_TRUE(back.pending(7));
  EXPECT_FALSE(back.pending(8)) << "the holder requested something since, and no tick saw it yet";
}

TEST(BatteryReturn, EndsWithItsCauseOrByTheHolder) {
  const BatteryReturn::Inputs same{.autonomous = true, .nearly_empty = true, .requests = 7};
  for (const auto& end : {BatteryReturn::Inputs{.autonomous = false, .nearly_empty = true, .requests = 7},
                          BatteryReturn::Inputs{.autonomous = true, .nearly_empty = false, .requests = 7},
                          BatteryReturn::Inputs{.autonomous = true, .nearly_empty = true, .requests = 8}}) {
    BatteryReturn back;
    back.begin(7, Time{1h});
    ASSERT_TRUE(back.due(same, Time{1h}));
    EXPECT_FALSE(back.due(end, Time{1h}));
    EXPECT_FALSE(back.due(same, Time{2h})) << "it does not begin again by itself";
  }
}

TEST(BatteryWatch, ReportsEachThresholdOnce) {
  BatteryWatch watch({});
  EXPECT_EQ(watch.update(0.31), std::nullopt);
  EXPECT_EQ(watch.update(0.30), BatteryLevel::warning);
  EXPECT_EQ(watch.update(0.32), std::nullopt);
  EXPECT_EQ(watch.update(0.29), std::nullopt) << "it wavers";
  EXPECT_EQ(watch.update(0.20), BatteryLevel::low);
  EXPECT_EQ(watch.update(0.09), BatteryLevel::last);
  EXPECT_EQ(watch.update(0.01), std::nullopt);
}

TEST(BatteryWatch, ASuddenFallIsTheLowestThreshold) {
  BatteryWatch watch({});
  EXPECT_EQ(watch.update(0.05), BatteryLevel::last);
}

TEST(BatteryWatch, ReportsAgainAfterACharge) {
  BatteryWatch watch({});
  EXPECT_EQ(watch.update(0.1), BatteryLevel::last);
  EXPECT_EQ(watch.update(1.0), std::nullopt);
  EXPECT_EQ(watch.level(), BatteryLevel::good);
  EXPECT_EQ(watch.update(0.3), BatteryLevel::warning);
}

TEST(BatteryWatch, AnUnknownChargeReportsNothing) {
  BatteryWatch watch({});
  EXPECT_EQ(watch.update(-1), std::nullopt);
  EXPECT_EQ(watch.update(std::nan("")), std::nullopt);
  EXPECT_EQ(watch.level(), BatteryLevel::good);
}

TEST(BatteryWatch, ARestartRepeatsNoReport) {
  BatteryWatch watch({});
  watch.restore(BatteryLevel::low);
  EXPECT_EQ(watch.update(0.15), std::nullopt);
  EXPECT_EQ(watch.update(0.05), BatteryLevel::last);
}

}  // namespace
}  // namespace adit::agent
