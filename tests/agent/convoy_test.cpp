// SPDX-License-Identifier: Apache-2.0
// A robot's place in a convoy: whom it follows, when it moves, and what it sends to the others.
#include "robot_agent/convoy/convoy.hpp"

#include <gmock/gmock.h>

#include "core/exec/virtual_runtime.hpp"

namespace adit::agent {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kLength = 0.6;  // m

/// The view of one robot of a convoy; the others are beacons.
class ConvoyTest : public testing::Test {
 protected:
  ConvoyTest() {
    for (int i = 1; i <= 4; ++i) {
      Peer peer{};
      peer.name = "r" + std::to_string(i);
      peer.participant = {static_cast<std::uint8_t>(i)};
      peer.length = kLength;
      peer.max_speed = 2.0;
      peers.put(peer, now);
    }
  }
  static ConvoyOrder order(std::vector<std::string> robots, std::uint64_t id = 7) {
    return {id, std::move(robots), 1.5, NAN};
  }
  Convoy make(const std::string& robot) {
    return Convoy({robot, kLength, 2.0}, {peers, [this] { return std::optional(place); },
                                          [this](Severity, const std::string& code, Reason,
                                                 const std::string&) { reported.push_back(code); }});
  }
  /// A beacon of a robot arrives.
  void say(const std::string& robot, const std::optional<ConvoyPart>& part, double vx = 0.0) {
    TeamBeacon beacon{};
    beacon.robot = robot;
    if (part) beacon.pose.x = part->along;
    beacon.seq = ++seq;
    beacon.twist.vx = vx;
    beacon.convoy = part;
    EXPECT_EQ(peers.hear_beacon(beacon, {static_cast<std::uint8_t>(robot[1] - '0')}, now), BeaconFault::none);
  }
  /// The part of a leader that drove `along` metres of the x axis.
  static ConvoyPart leader(const ConvoyOrder& of, double along) {
    ConvoyPart part{of.convoy, of.hash(), 0, false, true, along};
    const auto newest = static_cast<std::uint32_t>(along / nav::Trail::kSpacing);
    part.first = newest >= 7 ? newest - 7 : 0;
    for (std::uint32_t n = part.first; n <= newest; ++n) part.points.push_back({0.5 * n, 0, 0});
    return part;
  }
  void pass(Convoy& convoy, Duration time) {
    for (Duration t{}; t < time; t += 50ms) {
      now += 50ms;
      convoy.tick(now);
    }
  }

  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("m", 0s)};
  std::shared_ptr<Executor> strand{machine->strand("s")};
  PeerTable peers{*strand};
  Time now{Duration{1h}};
  Eigen::Vector3d place{-2.0, 0, 0};
  std::uint32_t seq{};
  std::vector<std::string> reported{};
};

TEST_F(ConvoyTest, RefusesMalformedOrders) {
  Convoy convoy = make("r2");
  EXPECT_EQ(convoy.start(order({"r2"})).reason(), Reason::bad_argument) << "one robot";
  EXPECT_EQ(convoy.start(order({"r1", "r2", "r1"})).reason(), Reason::bad_argument) << "twice";
  EXPECT_EQ(convoy.start(order({"r1", "r3"})).reason(), Reason::bad_argument) << "another's";
  EXPECT_EQ(convoy.start(order({"r1", "r2", "r3", "r4", "r5", "r6", "r7", "r8", "r9"})).reason(),
            Reason::bad_argument)
      << "too many";
  ASSERT_TRUE(convoy.start(order({"r1", "r2"})));
  EXPECT_EQ(convoy.start(order({"r2", "r1"}, 8)).reason(), Reason::bad_argument) << "a ring";
  EXPECT_TRUE(convoy.start(order({"r1", "r3", "r2"}, 9))) << "the same leader, another order";
}

TEST_F(ConvoyTest, FollowsOnlyAPredecessorWithTheSameConvoyAndOrder) {
  Convoy convoy = make("r2");
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  pass(convoy, 1s);
  EXPECT_FALSE(convoy.target()) << "nobody spoke";
  say("r1", leader(order({"r1", "r2"}, 8), 3.0));
  pass(convoy, 100ms);
  EXPECT_FALSE(convoy.target()) << "another convoy";
  say("r3", leader(mine, 3.0));
  pass(convoy, 100ms);
  EXPECT_FALSE(convoy.target()) << "a stranger";
  ConvoyPart other = leader(mine, 3.0);
  other.order_hash = order({"r1", "r3", "r2"}).hash();
  say("r1", other);
  pass(convoy, 100ms);
  EXPECT_FALSE(convoy.target());
  EXPECT_FALSE(convoy.order_agrees());
  say("r1", leader(mine, 3.0));
  pass(convoy, 100ms);
  ASSERT_TRUE(convoy.target());
  EXPECT_TRUE(convoy.order_agrees());
  EXPECT_EQ(convoy.state(), Convoy::State::following);
  EXPECT_GT(convoy.speed_limit(true), 0.0);
}

TEST_F(ConvoyTest, StopsAtTheGapBehindAPredecessorThatStands) {
  Convoy convoy = make("r2");
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  say("r1", leader(mine, 6.0));
  place.x() = 4.0;
  pass(convoy, 100ms);
  EXPECT_FALSE(convoy.target()) << "6 - 0.6 - 1.5 = 3.9: it stands near enough";
  EXPECT_EQ(convoy.state(), Convoy::State::waiting);
  place.x() = 2.0;
  say("r1", leader(mine, 6.0));
  pass(convoy, 100ms);
  ASSERT_TRUE(convoy.target());
  // The place lies behind the robot ahead; what stops it at the gap is its speed.
  EXPECT_LT(convoy.target()->x(), 6.0 - kLength);
  for (const double error : {1.2, 0.8, 0.5}) {
    place.x() = 3.9 - error;
    pass(convoy, 50ms);
    EXPECT_NEAR(convoy.speed_limit(true), std::sqrt(2 * 0.8 * error), 0.01);
  }
  place.x() = 3.6;
  pass(convoy, 50ms);
  EXPECT_FALSE(convoy.target());
}

// The robot ahead stands where the path begins, and this one waits behind it. Estimates of both differ a
// little each time, and a place that changes never gets a plan: the follower stood there for good.
TEST_F(ConvoyTest, APlaceBeforeTheBeginningOfThePathStaysAsItIs) {
  Convoy convoy = make("r2");
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  place.x() = -4.0;
  say("r1", leader(mine, 0.6), 0.3);
  pass(convoy, 50ms);
  ASSERT_TRUE(convoy.target());
  const Eigen::Vector3d first = *convoy.target();
  EXPECT_GT(first.x(), -3.0);
  for (int i = 0; i < 20; ++i) {
    say("r1", leader(mine, 0.6 + (i % 2 == 0 ? 0.01 : -0.01)), 0.3);
    pass(convoy, 50ms);
    ASSERT_TRUE(convoy.target());
    EXPECT_EQ(*convoy.target(), first);
  }
}

TEST_F(ConvoyTest, ARobotThatStandsOnThePathIsPassedWithRoom) {
  Convoy convoy = make("r3");
  const ConvoyOrder mine = order({"r1", "r3"});
  ASSERT_TRUE(convoy.start(mine));
  ConvoyPart stranger = leader(order({"r2", "r4"}, 8), 3.0);
  say("r2", stranger);  // It stands at 3.
  place.x() = 1.0;
  for (int i = 0; i < 3; ++i) {
    say("r1", leader(mine, 9.0), 0.5);
    pass(convoy, 50ms);
  }
  ASSERT_TRUE(convoy.target());
  EXPECT_GT(convoy.target()->x(), 3.0 + kLength + 0.8);
}

// The maps of two robots drift apart: here the leader's path leads through this robot's wall.
TEST_F(ConvoyTest, DrivesBesideAPathThatLeadsThroughAnObstacle) {
  double wall = -5.0;
  Convoy convoy({"r2", kLength, 2.0}, {peers, [this] { return std::optional(place); }, [](const auto&...) {},
                                       [&wall](const Eigen::Vector2d& at) { return at.y() > wall; }});
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  place = {1.0, 0.5, 0};
  say("r1", leader(mine, 3.0), 1.0);
  pass(convoy, 50ms);
  say("r1", leader(mine, 6.0), 1.0);
  pass(convoy, 50ms);
  ASSERT_TRUE(convoy.target());
  EXPECT_EQ(convoy.target()->y(), 0.0);
  wall = 0.3;
  place.x() = 3.0;
  pass(convoy, 50ms);
  say("r1", leader(mine, 9.0), 1.0);
  pass(convoy, 50ms);
  ASSERT_TRUE(convoy.target());
  EXPECT_NEAR(convoy.target()->y(), 0.6, 1e-6);
  convoy.target_refused();
  pass(convoy, 50ms);
  EXPECT_NEAR(convoy.target()->y(), 0.6, 1e-6) << "0.3 would not be free";
  convoy.target_refused();
  wall = -5.0;
  pass(convoy, 50ms);
  EXPECT_NEAR(convoy.target()->y(), -0.3, 1e-6) << "the third place";
  place.x() = 5.5;
  say("r1", leader(mine, 12.0), 1.0);
  pass(convoy, 50ms);
  ASSERT_TRUE(convoy.target());
  EXPECT_EQ(convoy.target()->y(), 0.0) << "2 m later it is back on the path";
}

TEST_F(ConvoyTest, AnOrderMayArriveBeforeTheFirstBeacon) {
  Convoy convoy = make("r2");
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  pass(convoy, 11s);
  EXPECT_TRUE(convoy.leader_known(now));
  EXPECT_FALSE(convoy.target());
  EXPECT_EQ(convoy.hindrance(now), "r2 does not hear r1");
  pass(convoy, 2s);
  EXPECT_FALSE(convoy.leader_known(now)) << "the mode pauses, and shows why";
  say("r1", leader(mine, 3.0));
  pass(convoy, 100ms);
  EXPECT_TRUE(convoy.leader_known(now));
  EXPECT_TRUE(convoy.target());
  EXPECT_EQ(convoy.hindrance(now), "");
}

TEST_F(ConvoyTest, StatesWhyItDoesNotFollow) {
  Convoy convoy = make("r2");
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  say("r1", std::nullopt);
  pass(convoy, 100ms);
  EXPECT_EQ(convoy.hindrance(now), "r1 does not say that it is in this convoy");
  ConvoyPart nowhere = leader(mine, 3.0);
  nowhere.points.clear();
  say("r1", nowhere);
  pass(convoy, 100ms);
  EXPECT_EQ(convoy.hindrance(now), "the path of r1 is not known yet");
  ConvoyPart far = leader(mine, 30.0);
  say("r1", leader(mine, 3.0));
  pass(convoy, 100ms);
  EXPECT_EQ(convoy.hindrance(now), "");
  far.points.clear();
  say("r1", far);
  pass(convoy, 100ms);
  EXPECT_EQ(convoy.hindrance(now), "a part of the path of r1 is not known yet");
}

TEST_F(ConvoyTest, ARobotFarFromThePathDrivesToIt) {
  Convoy convoy = make("r2");
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  place = {0.5, 5.0, 0};
  say("r1", leader(mine, 4.0), 1.0);
  pass(convoy, 200ms);
  EXPECT_EQ(convoy.state(), Convoy::State::forming);
  ASSERT_TRUE(convoy.target());
  EXPECT_NEAR(convoy.target()->y(), 0.0, 1e-6);
  EXPECT_LE(convoy.speed_limit(true), 0.7);
}

// Restarts can leave two members with different paths: points of one never fit the other.
TEST_F(ConvoyTest, APathThatEndedIsReplacedByTheNextOne) {
  Convoy convoy = make("r2");
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  place.x() = 2.0;
  say("r1", leader(mine, 3.0), 0.5);
  pass(convoy, 100ms);
  for (int i = 0; i < 30; ++i) {
    ConvoyPart other = leader(mine, 1004.0);
    for (Eigen::Vector3d& point : other.points) point.x() -= 1000.0;
    say("r1", other, 0.5);
    pass(convoy, 200ms);
  }
  EXPECT_EQ(convoy.part(2)->points.back().x(), 4.0);
  EXPECT_EQ(convoy.hindrance(now), "");
}

TEST_F(ConvoyTest, SkipsARobotThatLeftAndWaitsWhenTheLeaderLeft) {
  Convoy convoy = make("r3");
  const ConvoyOrder mine = order({"r1", "r2", "r3"});
  ASSERT_TRUE(convoy.start(mine));
  ConvoyPart second = leader(mine, 3.0);
  second.index = 1;
  say("r1", leader(mine, 3.0));
  say("r2", second);
  pass(convoy, 100ms);
  EXPECT_THAT(convoy.order(), ElementsAre("r1", "r2", "r3"));
  EXPECT_FALSE(convoy.target() && convoy.target()->x() > 1.0) << "behind r2";
  second.left = true;
  say("r2", second);
  pass(convoy, 100ms);
  EXPECT_THAT(convoy.order(), ElementsAre("r1", "r3"));
  say("r1", leader(mine, 6.0));
  place.x() = 2.5;
  pass(convoy, 100ms);
  ASSERT_TRUE(convoy.target()) << "behind r1";
  EXPECT_GT(convoy.target()->x(), 3.0);
  // r2 says that it is back: a peer does not extend a convoy.
  second.left = false;
  say("r2", second);
  pass(convoy, 100ms);
  EXPECT_THAT(convoy.order(), ElementsAre("r1", "r3"));
  say("r1", std::nullopt);
  pass(convoy, 100ms);
  EXPECT_FALSE(convoy.target());
  EXPECT_FALSE(convoy.leader_known(now));
  EXPECT_EQ(convoy.state(), Convoy::State::ended);
}

TEST_F(ConvoyTest, ASilentPredecessorIsFollowedToTheEndOfThePathAndThenWaitedFor) {
  Convoy convoy = make("r2");
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  for (int i = 0; i < 3; ++i) {
    say("r1", leader(mine, 6.0), 1.0);
    pass(convoy, 200ms);
  }
  place.x() = 1.0;
  pass(convoy, 2s);
  EXPECT_EQ(convoy.state(), Convoy::State::lost);
  ASSERT_TRUE(convoy.target());
  EXPECT_LE(convoy.speed_limit(true), 0.5);
  EXPECT_THAT(reported, ElementsAre("convoy_lost")) << "once";
  EXPECT_TRUE(convoy.leader_known(now));
  pass(convoy, 10s);
  EXPECT_FALSE(convoy.leader_known(now)) << "the mode pauses";
  say("r1", leader(mine, 6.0));
  pass(convoy, 100ms);
  EXPECT_TRUE(convoy.leader_known(now));
  EXPECT_EQ(convoy.state(), Convoy::State::following);
}

TEST_F(ConvoyTest, TheLeaderRecordsItsPathAndSendsWhatAFollowerLacks) {
  Convoy convoy = make("r1");
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  for (double x = 0.0; x <= 10.0; x += 0.05) {
    place.x() = x;
    pass(convoy, 50ms);
  }
  const auto newest = convoy.part(2);
  ASSERT_TRUE(newest);
  EXPECT_NEAR(newest->along, 10.0, 0.1);
  EXPECT_NEAR(newest->points.back().x(), 10.0, 0.51);
  EXPECT_EQ(newest->points.size(), ConvoyPart::kPoints);
  ConvoyPart second{mine.convoy, mine.hash(), 1, false, true, 1.0, 2.0, 4};
  say("r2", second);
  pass(convoy, 50ms);
  EXPECT_EQ(convoy.part(3)->first, 4u) << "every second beacon carries what r2 lacks";
  EXPECT_EQ(convoy.part(4)->first, newest->first);
}

TEST_F(ConvoyTest, TheLeaderDrivesNoFasterThanTheSlowestAndWaitsForALongGap) {
  Convoy convoy = make("r1");
  const ConvoyOrder mine = order({"r1", "r2"});
  ASSERT_TRUE(convoy.start(mine));
  pass(convoy, 50ms);
  EXPECT_EQ(convoy.speed_limit(false), 2.0) << "r2's platform";
  ConvoyPart second{mine.convoy, mine.hash(), 1, false, true, 1.0, 7.0, 4};
  say("r2", second, 0.4);
  pass(convoy, 100ms);
  EXPECT_NEAR(convoy.speed_limit(false), 0.4, 1e-6);
  second.left = true;
  say("r2", second);
  pass(convoy, 100ms);
  EXPECT_TRUE(std::isinf(convoy.speed_limit(false))) << "it is alone";
  EXPECT_THAT(convoy.order(), ElementsAre("r1"));
}

TEST_F(ConvoyTest, TheLeaderWaitsForAMemberThatNeverSpoke) {
  Convoy convoy = make("r1");
  ASSERT_TRUE(convoy.start(order({"r1", "r2"})));
  pass(convoy, 4s);
  EXPECT_EQ(convoy.speed_limit(false), 2.0);
  pass(convoy, 2s);
  EXPECT_NEAR(convoy.speed_limit(false), 0.3, 1e-6);
  pass(convoy, 20s);
  EXPECT_THAT(reported, ElementsAre("convoy_split"));
}

TEST_F(ConvoyTest, ARestartedLeaderWhosePathNobodyKnowsBeginsAnotherOne) {
  const ConvoyOrder mine = order({"r1", "r2"});
  Convoy convoy = make("r1");
  convoy.set_role(Convoy::Role{mine, 0, false});
  for (double x = 0.0; x < 6.0; x += 0.025) {
    place.x() = x;
    pass(convoy, 50ms);
  }
  const auto part = convoy.part(2);
  ASSERT_FALSE(part->points.empty());
  EXPECT_GT(part->first, 60000u) << "not the numbers of the former path";
  EXPECT_TRUE(part->placed);
  EXPECT_NEAR(part->points.back().x(), 6.0, 0.6);
  ConvoyPart second{mine.convoy, mine.hash(), 1, false, false, 0.0, -1.0, 0};
  say("r2", second);
  pass(convoy, 50ms);
  EXPECT_NEAR(convoy.part(3)->points.front().x(), 0.0, 0.1) << "also where it was before";
}

TEST_F(ConvoyTest, ARestartedLeaderGoesOnWithThePathThatItsFollowerKnows) {
  const ConvoyOrder mine = order({"r1", "r2"});
  Convoy convoy = make("r1");
  convoy.set_role(Convoy::Role{mine, 0, false});
  place.x() = 6.2;
  pass(convoy, 1s);
  EXPECT_TRUE(convoy.part(2)->points.empty()) << "it waits for a follower that knows the path";
  ConvoyPart second = leader(mine, 6.0);
  second.index = 1;
  say("r2", second);
  pass(convoy, 100ms);
  place.x() = 7.1;
  pass(convoy, 100ms);
  EXPECT_EQ(convoy.part(2)->first + convoy.part(2)->points.size(), 15u) << "two points more than r2 knows";
}

TEST_F(ConvoyTest, ARobotThatLeftAnnouncesThatAndStops) {
  Convoy convoy = make("r2");
  const ConvoyOrder mine = order({"r1", "r2"});
  EXPECT_EQ(convoy.leave().reason(), Reason::not_in_convoy);
  ASSERT_TRUE(convoy.start(mine));
  say("r1", leader(mine, 3.0));
  pass(convoy, 100ms);
  ASSERT_TRUE(convoy.target());
  ASSERT_TRUE(convoy.leave());
  pass(convoy, 100ms);
  EXPECT_FALSE(convoy.target());
  EXPECT_TRUE(convoy.part(1)->left);
  EXPECT_THAT(convoy.order(), IsEmpty());
  EXPECT_EQ(convoy.leave().reason(), Reason::not_in_convoy);
}

}  // namespace
}  // namespace adit::agent
