// SPDX-License-Identifier: Apache-2.0
// Right of way: whom a robot asks, when it makes way, and when it does not move.
#include "robot_agent/right_of_way/right_of_way.hpp"

#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"

namespace adit::agent {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// The view of r2, a robot of 0.6 x 0.4 m in a corridor along the x axis; the others are beacons.
class RightOfWayTest : public testing::Test {
 protected:
  RightOfWayTest() {
    for (int i = 1; i <= 4; ++i) {
      Peer peer{};
      peer.name = "r" + std::to_string(i);
      peer.participant = {static_cast<std::uint8_t>(i)};
      peer.length = 0.6;
      peer.width = 0.4;
      peers.put(peer, now);
    }
    own.pose = Pose2{0.0, 0.0, 0.0};
  }
  RightOfWay make(const std::string& robot = "r2") {
    return RightOfWay({robot, 0.6, 0.4, 1.0, true}, peers,
                      {[this](const nav::Corridor& corridor, const std::string& asker, auto done) {
                         searches.push_back(asker);
                         asked_width = corridor.width;
                         done(clear_place);
                       },
                       [this](Time) -> Result<void> {
                         own.mode = "get_out";
                         return {};
                       },
                       [this](Time) {
                         ++resumed;
                         own.mode = "hold";
                       },
                       [this](Severity, const std::string& code, Reason, const std::string&) {
                         reported.push_back(code);
                       }});
  }
  TeamBeacon beacon(const std::string& robot, double x, std::uint8_t rank) {
    TeamBeacon b{};
    b.robot = robot;
    b.pose = {x, 0.0, 0.0};
    b.rank = rank;
    return b;
  }
  void say(TeamBeacon b) {
    b.seq = ++seq;
    EXPECT_EQ(peers.hear_beacon(b, {static_cast<std::uint8_t>(b.robot[1] - '0')}, now), BeaconFault::none);
  }
  /// r1 wants to pass r2 along the x axis.
  TeamBeacon asker(double x = -5.0, std::uint8_t rank = 3) {
    TeamBeacon b = beacon("r1", x, rank);
    b.ask = YieldAsk{{"r2"}, "r1", 0.8, {{x, 0.0}, {x + 20.0, 0.0}}};
    return b;
  }
  void pass(RightOfWay& way, Duration time, const std::vector<TeamBeacon>& said = {}) {
    for (Duration t{}; t < time; t += 200ms) {
      now += 200ms;
      for (const TeamBeacon& b : said) say(b);
      way.tick(own, now);
    }
  }
  TeamBeacon said(const RightOfWay& way) {
    TeamBeacon b{};
    way.say(b);
    return b;
  }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("m", 0s)};
  std::shared_ptr<Executor> strand{machine->strand("s")};
  PeerTable peers{*strand};
  Time now{Duration{1h}};
  RightOfWay::Own own{};
  std::optional<Eigen::Vector2d> clear_place{Eigen::Vector2d(3.0, 2.0)};
  int resumed{};
  double asked_width{};
  std::uint32_t seq{};
  std::vector<std::string> searches{}, reported{};
};

TEST_F(RightOfWayTest, WithoutPermissionItDoesNotMove) {
  RightOfWay way = make();
  pass(way, 5s, {asker()});
  EXPECT_FALSE(way.clears());
  EXPECT_FALSE(said(way).yields);
  EXPECT_THAT(searches, IsEmpty());
}

TEST_F(RightOfWayTest, MakesWayForOneThatAsksAndResumesWhenItHasPassed) {
  RightOfWay way = make();
  ASSERT_TRUE(way.allow(true, now));
  pass(way, 400ms, {asker()});
  EXPECT_TRUE(way.clears());
  EXPECT_EQ(way.yields_to(), "r1");
  EXPECT_EQ(way.place(), Eigen::Vector2d(3.0, 2.0));
  EXPECT_DOUBLE_EQ(asked_width, 0.8);
  const TeamBeacon answer = said(way);
  ASSERT_TRUE(answer.answer);
  EXPECT_TRUE(answer.answer->clears);
  EXPECT_EQ(answer.rank, 3) << "it speaks with the rank of the robot for which it makes way";
  TeamBeacon passed = beacon("r1", 5.0, 3);
  pass(way, 4s, {passed});
  EXPECT_EQ(resumed, 0);
  pass(way, 1s, {passed});
  EXPECT_EQ(resumed, 1);
  EXPECT_FALSE(way.clears());
  EXPECT_THAT(reported, ElementsAre("made_way"));
}

TEST_F(RightOfWayTest, OneThatIsNotInTheCorridorDoesNotMove) {
  RightOfWay way = make();
  ASSERT_TRUE(way.allow(true, now));
  own.pose = Pose2{0.0, 3.0, 0.0};
  pass(way, 2s, {asker()});
  EXPECT_FALSE(way.clears());
}

TEST_F(RightOfWayTest, TheLowerRankMakesWayAndAmongEqualsTheLaterName) {
  RightOfWay way = make();
  ASSERT_TRUE(way.allow(true, now));
  own.mode = "waypoint";
  own.drives = true;
  own.route = {{0.0, 0.0}, {-20.0, 0.0}};
  pass(way, 1s, {asker(-5.0, 2)});
  EXPECT_FALSE(way.clears()) << "r1 explores, r2 has a goal";
  pass(way, 1s, {asker(-5.0, 3)});
  EXPECT_TRUE(way.clears()) << "both have goals, and r1 comes first";
  RightOfWay first = make("r0");
  TeamBeacon later = asker(-5.0, 3);
  later.ask->to = {"r0"};
  own.mode = "waypoint";
  ASSERT_TRUE(first.allow(true, now));
  pass(first, 1s, {later});
  EXPECT_FALSE(first.clears());
}

TEST_F(RightOfWayTest, ARobotThatCannotMakeWayRefusesAndTheOtherMakesWay) {
  RightOfWay lower = make();
  ASSERT_TRUE(lower.allow(true, now));
  clear_place.reset();
  pass(lower, 400ms, {asker()});
  EXPECT_FALSE(lower.clears());
  ASSERT_TRUE(said(lower).answer);
  EXPECT_FALSE(said(lower).answer->clears);
  EXPECT_EQ(said(lower).answer->root, "r1");

  // The view of r1, which ranks higher: it heard that r3 cannot, and r3 asks it.
  RightOfWay higher = make("r1");
  ASSERT_TRUE(higher.allow(true, now));
  clear_place = Eigen::Vector2d(-3.0, 2.0);
  own.mode = "waypoint";
  own.drives = true;
  TeamBeacon other = beacon("r3", 5.0, 1);
  other.ask = YieldAsk{{"r1"}, "r3", 0.8, {{5.0, 0.0}, {-15.0, 0.0}}};
  pass(higher, 1s, {other});
  EXPECT_FALSE(higher.clears());
  other.answer = YieldAnswer{"r1", false, Reason::yield_refused, {}};
  pass(higher, 1s, {other});
  EXPECT_TRUE(higher.clears());
}

TEST_F(RightOfWayTest, AsksOnlyOneThatMakesWayAndIsOnItsRoute) {
  RightOfWay way = make();
  own.mode = "waypoint";
  own.drives = true;
  own.route = {{0.0, 0.0}, {15.0, 0.0}};
  TeamBeacon before = beacon("r3", 6.0, 1);
  TeamBeacon beside = beacon("r4", 6.0, 1);
  beside.pose.y = 2.0;
  before.yields = beside.yields = true;
  pass(way, 3s, {before, beside});
  ASSERT_TRUE(said(way).ask);
  EXPECT_THAT(said(way).ask->to, ElementsAre("r3"));
  EXPECT_EQ(said(way).ask->root, "r2");
  EXPECT_NEAR(way.speed_limit(), 0.5 * (6.0 - 0.6 - RightOfWay::kDistance), 1e-6);  // Sizes are floats.
  // Until it has passed the place where the other one was, and the one to which it drives.
  before.pose.x = 8.0;
  before.answer = YieldAnswer{"r2", true, Reason::none, {8.0, 1.5}};
  own.pose = Pose2{6.5, 0.0, 0.0};
  own.route = {{6.5, 0.0}, {15.0, 0.0}};
  pass(way, 400ms, {before});
  EXPECT_TRUE(said(way).ask);
  own.pose = Pose2{10.5, 0.0, 0.0};
  own.route = {{10.5, 0.0}, {15.0, 0.0}};
  pass(way, 400ms, {before});
  EXPECT_FALSE(said(way).ask);
}

TEST_F(RightOfWayTest, OneThatMayNotMakeWayIsReportedOnce) {
  RightOfWay way = make();
  own.mode = "waypoint";
  own.drives = true;
  own.route = {{0.0, 0.0}, {15.0, 0.0}};
  pass(way, 8s, {beacon("r3", 3.0, 1)});
  EXPECT_FALSE(said(way).ask);
  EXPECT_THAT(reported, ElementsAre("yield_refused"));
  pass(way, 5s, {beacon("r3", 3.0, 1)});
  EXPECT_THAT(reported, ElementsAre("yield_refused"));
  EXPECT_TRUE(std::isinf(way.speed_limit())) << "the local planner decides whether it can pass";
}

TEST_F(RightOfWayTest, AChainAsksWithTheRankOfTheFirst) {
  RightOfWay way = make();
  ASSERT_TRUE(way.allow(true, now));
  pass(way, 400ms, {asker(-5.0, 6)});
  ASSERT_TRUE(way.clears());
  own.drives = true;
  own.route = {{0.0, 0.0}, {12.0, 0.0}};
  TeamBeacon behind = beacon("r3", 6.0, 3);
  behind.yields = true;
  pass(way, 2s, {asker(-5.0, 6), behind});
  ASSERT_TRUE(said(way).ask);
  EXPECT_THAT(said(way).ask->to, ElementsAre("r3"));
  EXPECT_EQ(said(way).ask->root, "r1");
  EXPECT_EQ(said(way).rank, 6);
}

TEST_F(RightOfWayTest, ThePermissionEndsWithItsHolderAndSleepsAfterAStop) {
  RightOfWay way = make();
  ASSERT_TRUE(way.allow(true, now));
  pass(way, 400ms, {asker()});
  ASSERT_TRUE(way.clears());
  way.stopped();
  own.mode = "hold";
  EXPECT_FALSE(way.clears());
  pass(way, 2s, {asker()});
  EXPECT_FALSE(way.clears()) << "the permission sleeps";
  way.holder_requested();
  pass(way, 400ms, {asker()});
  EXPECT_TRUE(way.clears());
  way.holder_changed();
  own.mode = "hold";
  pass(way, 2s, {asker()});
  EXPECT_FALSE(way.clears());
  EXPECT_FALSE(way.allowed());
}

TEST_F(RightOfWayTest, NothingThatIsRequestedWhileTheRobotIsStoppedMovesItAfterTheReset) {
  RightOfWay way = make();
  ASSERT_TRUE(way.allow(true, now));
  own.stopped = true;
  way.stopped();
  way.holder_requested();
  ASSERT_TRUE(way.allow(true, now));
  own.stopped = false;
  way.reset();
  pass(way, 5s, {asker()});
  EXPECT_FALSE(way.clears()) << "a reset moves nothing";
  EXPECT_TRUE(way.allowed());
  EXPECT_TRUE(way.asleep());
  way.holder_requested();
  pass(way, 400ms, {asker()});
  EXPECT_TRUE(way.clears());
}

TEST_F(RightOfWayTest, AQueuingRobotDoesNotAsk) {
  RightOfWay way = make("r1");
  own.mode = "waypoint";
  own.drives = true;
  own.route = {{0.0, 0.0}, {15.0, 0.0}};
  TeamBeacon ahead = beacon("r2", 4.0, 3);
  ahead.yields = true;
  ahead.ask = YieldAsk{{"r3"}, "r2", 0.8, {{4.0, 0.0}, {20.0, 0.0}}};
  pass(way, 3s, {ahead});
  EXPECT_FALSE(said(way).ask);
}

TEST_F(RightOfWayTest, ARobotWithoutARouterCannotBeAllowed) {
  RightOfWay way({"r2", 0.6, 0.4, 1.0, false}, peers, {});
  EXPECT_EQ(way.allow(true, now).reason(), Reason::not_supported);
  EXPECT_TRUE(way.allow(false, now));
}

}  // namespace
}  // namespace adit::agent
