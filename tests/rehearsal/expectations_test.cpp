// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/expectations.hpp"

#include <gtest/gtest.h>

namespace adit::sim {
namespace {

/// A scenario with one expectation, and evidence to be set by hand.
struct Case {
  explicit Case(Expectation e) {
    scenario.robots = {{"r1", "wheeled", {}}};
    scenario.duration = 60s;
    scenario.expectations = {std::move(e)};
    expectations.emplace(scenario);
    evidence.word = [this](const std::string&) -> const RobotWord& { return word; };
    evidence.pose = [this](const std::string&) { return pose; };
    evidence.collisions = [this](const std::string&) { return collisions; };
    evidence.caused = [this](const std::string&) { return caused; };
  }
  ExpectationResult finish() { return expectations->finish(evidence, report).at(0); }

  Scenario scenario{};
  std::optional<Expectations> expectations{};
  Evidence evidence{};
  RobotWord word{};
  Pose2 pose{};
  int collisions{}, caused{};
  RunReport report{};
};

using When = Expectation::When;

TEST(Expectations, AtIsJudgedAtThatInstantOnly) {
  Case c({When::at, 10s, StateExpectation{"r1", "waypoint", "op1", false, {}}, 1, ""});
  c.word.mode = "hold";
  c.expectations->judge(9s, c.evidence);
  c.word = {"waypoint", {1, 1, "op1", {}, false}, false, true};
  c.expectations->judge(10s, c.evidence);
  c.word = {};
  c.expectations->judge(11s, c.evidence);
  EXPECT_TRUE(c.finish().ok);
}

TEST(Expectations, ReportsEveryDifference) {
  Case c({When::at, 10s, StateExpectation{"r1", "waypoint", "", true, true}, 1, ""});
  c.word = {"hold", {1, 1, "op2", {}, false}, false, true};
  c.expectations->judge(10s, c.evidence);
  EXPECT_EQ(c.finish().found, "mode is hold, holder is op2, it is not locked, it is not stopped");
}

TEST(Expectations, AStationHasSoManyFindings) {
  Case c({When::by, 10s, FindingsExpectation{"op1", 2}, 1, ""});
  c.expectations->judge(1s, c.evidence);
  c.evidence.findings["op1"] = 1;
  c.expectations->judge(2s, c.evidence);
  c.evidence.findings["op1"] = 2;
  c.expectations->judge(3s, c.evidence);
  EXPECT_TRUE(c.finish().ok);
}

TEST(Expectations, ReportsAStationThatIsDeadOrListsOthers) {
  Case c({When::at, 10s, FindingsExpectation{"op1", 2}, 1, ""});
  c.expectations->judge(10s, c.evidence);
  EXPECT_EQ(c.finish().found, "the station does not run");
  Case d({When::at, 10s, FindingsExpectation{"op1", 2}, 1, ""});
  d.evidence.findings["op1"] = 3;
  d.expectations->judge(10s, d.evidence);
  EXPECT_FALSE(d.finish().ok);
  EXPECT_EQ(d.finish().found, "it has 3");
}

TEST(Expectations, AStationHasSoManyWholePhotos) {
  Case c({When::by, 10s, FindingsExpectation{"op1", 2, 1}, 1, ""});
  c.evidence.findings["op1"] = 2;
  c.expectations->judge(2s, c.evidence);
  c.evidence.photos["op1"] = 1;
  c.expectations->judge(3s, c.evidence);
  EXPECT_TRUE(c.finish().ok);
  Case d({When::at, 10s, FindingsExpectation{"op1", 2, 1}, 1, ""});
  d.evidence.findings["op1"] = 2;
  d.evidence.photos["op1"] = 2;
  d.expectations->judge(10s, d.evidence);
  EXPECT_FALSE(d.finish().ok);
  EXPECT_EQ(d.finish().found, "it has 2 whole photos");
}

TEST(Expectations, ARobotGivesAReason) {
  Case c({When::by, 10s, ReasonExpectation{"r1", Reason::blocked}, 1, ""});
  bool said = false;
  c.evidence.reported = [&](const std::string& robot, Reason reason) {
    return said && robot == "r1" && reason == Reason::blocked;
  };
  c.expectations->judge(1s, c.evidence);
  EXPECT_FALSE(c.expectations->all_settled());
  said = true;
  c.expectations->judge(2s, c.evidence);
  EXPECT_TRUE(c.finish().ok);
}

TEST(Expectations, ARobotWithAGoalMakesProgress) {
  const auto found = [](double speed, bool goal, bool stopped) {
    Case c({When::always, {}, ProgressExpectation{5s, {"r1"}}, 1, ""});
    c.word.drives_to_goal = goal;
    c.word.stopped = stopped;
    for (int n = 0; n < 100; ++n) {
      c.pose.x = 0.1 * speed * n;
      c.expectations->judge(n * 100ms, c.evidence);
    }
    return c.finish().found;
  };
  EXPECT_EQ(found(0.1, true, false), "");
  EXPECT_EQ(found(0.0, false, false), "") << "without a goal it may stand";
  EXPECT_EQ(found(0.0, true, true), "") << "and so when it was stopped";
  EXPECT_EQ(found(0.05, true, false), "r1 stays at 0.00 0.00 from 0.0 s on");
}

TEST(Expectations, AreSettledOnceEachThatHasATimeIs) {
  Case c({When::by, 10s, NearExpectation{"r1", 3.0, 4.0, 0.5}, 1, ""});
  c.scenario.expectations.push_back({When::always, {}, NoCollision{}, 2, ""});
  c.expectations.emplace(c.scenario);
  c.expectations->judge(1s, c.evidence);
  EXPECT_FALSE(c.expectations->all_settled());
  c.pose = {3.2, 4.1, 0.0};
  c.expectations->judge(2s, c.evidence);
  EXPECT_TRUE(c.expectations->all_settled());
  c.scenario.expectations.push_back({When::always, {}, AtLeast{"distance", 1.0}, 3, ""});
  c.expectations.emplace(c.scenario);
  c.expectations->judge(2s, c.evidence);
  EXPECT_FALSE(c.expectations->all_settled()) << "the distance is counted until the end";
  Case none({When::always, {}, NoCollision{}, 1, ""});
  EXPECT_FALSE(none.expectations->all_settled()) << "nothing says when";
}

TEST(Expectations, ByHoldsWhenItWasSoOnceBefore) {
  Case c({When::by, 10s, NearExpectation{"r1", 3.0, 4.0, 0.5}, 1, ""});
  c.pose = {3.2, 4.1, 0.0};
  c.expectations->judge(5s, c.evidence);
  c.pose = {};
  c.expectations->judge(10s, c.evidence);
  EXPECT_TRUE(c.finish().ok);
}

TEST(Expectations, PlaceAndStateMustHoldTogether) {
  const StateExpectation both{"r1", "waypoint", {}, {}, {}, NearExpectation{"r1", 3.0, 4.0, 0.5}};
  Case c({When::by, 10s, both, 1, ""});
  c.pose = {3.0, 4.0, 0.0};
  c.word.mode = "hold";
  c.expectations->judge(5s, c.evidence);
  c.pose = {};
  c.word.mode = "waypoint";
  c.expectations->judge(10s, c.evidence);
  EXPECT_FALSE(c.finish().ok);
  EXPECT_EQ(c.finish().found, "at 0.00 0.00, 5.00 m away");
}

TEST(Expectations, ByFailsWhenItComesLater) {
  Case c({When::by, 10s, NearExpectation{"r1", 3.0, 4.0, 0.5}, 1, ""});
  c.expectations->judge(5s, c.evidence);
  c.expectations->judge(10s, c.evidence);
  c.pose = {3.0, 4.0, 0.0};
  c.expectations->judge(11s, c.evidence);
  EXPECT_FALSE(c.finish().ok);
  EXPECT_EQ(c.finish().found, "at 0.00 0.00, 5.00 m away");
}

TEST(Expectations, LastAnswerOfAnOperator) {
  Case c({When::at, 10s, AnswerExpectation{"op2", Reason::locked}, 1, ""});
  c.evidence.last_answer["op2"] = Reason::locked;
  c.expectations->judge(10s, c.evidence);
  EXPECT_TRUE(c.finish().ok);
}

TEST(Expectations, NoAnswerIsNotTheAnswerExpected) {
  Case c({When::at, 10s, AnswerExpectation{"op2", Reason::none}, 1, ""});
  c.expectations->judge(10s, c.evidence);
  EXPECT_FALSE(c.finish().ok);
}

TEST(Expectations, ExploredAndDrivenAgainAreThoseOfTheTruth) {
  const std::vector<Box> room{
      {-0.3, 0, 0, 6, 0, 3}, {10, 10.3, 0, 6, 0, 3}, {0, 10, -0.3, 0, 0, 3}, {0, 10, 6, 6.3, 0, 3}};
  const ExplorationRobot robot{{}, {5, 3, 0}};
  ExplorationRecord record(
      ExplorationTruth::create(std::make_shared<World>(make_box_world(room, 0, 3).value()),
                               std::span(&robot, 1))
          .value(),
      1);
  Case c({When::by, 10s, ExploredExpectation{0.5, {}, {}}, 1, ""});
  c.evidence.exploration = &record;
  c.evidence.index = [](const std::string&) { return std::size_t{0}; };
  c.expectations->judge(1s, c.evidence);
  EXPECT_EQ(c.finish().found, "explored 0.0 %");
  const Pose3 pose = Pose3::level(robot.start, 0);
  record.add(1, std::span(&pose, 1));
  c.expectations->judge(2s, c.evidence);
  EXPECT_TRUE(c.finish().ok) << c.finish().found;

  Case again({When::at, 10s, RepeatExpectation{0.1}, 1, ""});
  again.evidence.exploration = &record;
  again.expectations->judge(10s, again.evidence);
  EXPECT_TRUE(again.finish().ok);
}

TEST(Expectations, JudgesAMapByItsShareAndItsErrors) {
  Case both({When::by, 10s, MapExpectation{"op1", 0.9, 0.03}, 1, ""});
  both.expectations->judge(5s, both.evidence);
  EXPECT_EQ(both.finish().found, "op1 has no map");
  MapJudgement map{.share = 0.95, .wrong_occupied = 0.01, .wrong_free = 0.05};
  both.evidence.map = [&map](const std::string&) { return map; };
  both.expectations->judge(6s, both.evidence);
  EXPECT_EQ(both.finish().found, "op1 has no map") << "judging takes long: every 5 s";
  both.expectations->judge(10s, both.evidence);
  EXPECT_EQ(both.finish().found, "wrong are 1.0 % of the occupied and 5.0 % of the free voxels");
  map.wrong_free = 0.0;
  Case better({When::by, 10s, MapExpectation{"op1", 0.9, 0.03}, 1, ""});
  better.evidence.map = both.evidence.map;
  better.expectations->judge(5s, better.evidence);
  EXPECT_TRUE(better.finish().ok) << better.finish().found;
  // Of an empty map nothing is wrong: that is judged at the end alone.
  Case wrong({When::by, 10s, MapExpectation{"op1", {}, 0.03}, 1, ""});
  wrong.evidence.map = both.evidence.map;
  wrong.expectations->judge(5s, wrong.evidence);
  EXPECT_FALSE(wrong.finish().ok);
  wrong.expectations->judge(10s, wrong.evidence);
  EXPECT_TRUE(wrong.finish().ok);
}

TEST(Expectations, StatedPosesAreWithinTheirLimit) {
  Case c({When::always, 0s, PoseWithinExpectation{0.3, {"r1"}}, 1, ""});
  Pose2 truth{1, 0, 0};
  RobotWord word;
  word.pose = Pose3::level({1.2, 0, 0}, 0.0);
  word.pose_sent = 1s;
  c.evidence.pose = [&truth](const std::string&) { return truth; };
  c.evidence.word = [&word](const std::string&) -> const RobotWord& { return word; };
  c.expectations->judge(1s, c.evidence);
  truth.x = 2.0;
  c.expectations->judge(2s, c.evidence);
  EXPECT_TRUE(c.finish().ok) << "said before it drove on: " << c.finish().found;
  word.pose_sent = 3s;
  truth.x = 2.01;
  c.expectations->judge(3s, c.evidence);
  EXPECT_EQ(c.finish().found, "r1 was 0.80 m from where it said at 3 s");
}

TEST(Expectations, CollisionFailsAtTheEnd) {
  Case c({When::always, 0s, NoCollision{}, 1, ""});
  EXPECT_TRUE(c.finish().ok);
  c.collisions = 1;
  EXPECT_FALSE(c.finish().ok);
}

TEST(Expectations, CausedCollisionsAreThoseOfTheRobotAlone) {
  Case c({When::always, 0s, NoCollision{true}, 1, ""});
  c.collisions = 1;
  EXPECT_TRUE(c.finish().ok) << "somebody walked into it";
  c.caused = 1;
  EXPECT_FALSE(c.finish().ok);
}

TEST(Expectations, Counts) {
  Case c({When::always, 0s, AtLeast{"refusals", 20}, 1, ""});
  c.report.commands.refused = 19;
  EXPECT_FALSE(c.finish().ok);
  c.report.commands.refused = 20;
  EXPECT_TRUE(c.finish().ok);
}

TEST(Expectations, DistanceIsThatOfEveryRobot) {
  Case c({When::always, 0s, AtLeast{"distance", 15}, 1, ""});
  c.report.robots["r1"].distance = 16.0;
  c.report.robots["r2"].distance = 14.0;
  EXPECT_FALSE(c.finish().ok);
}

TEST(Expectations, RunThatEndsBeforeIsAFailure) {
  Case c({When::at, 10s, AnswerExpectation{"op2", Reason::none}, 1, ""});
  EXPECT_EQ(c.finish().found, "the run ended before");
}

// The outline of r1 is 0.6 x 0.5 m.
TEST(Expectations, AlwaysInsideAppliesToTheCompleteOutline) {
  Case c({When::always, 0s, PlaceExpectation{true, {0, 0, 4, 4}, {"r1"}}, 1, ""});
  c.pose = {3.6, 2, 0};
  c.expectations->judge(1s, c.evidence);
  EXPECT_TRUE(c.finish().ok);
  c.pose = {3.71, 2, 0};
  c.expectations->judge(2s, c.evidence);
  c.pose = {1, 1, 0};
  c.expectations->judge(3s, c.evidence);
  const ExpectationResult result = c.finish();
  EXPECT_FALSE(result.ok);
  EXPECT_EQ(result.found, "r1 at 3.71 2.00 at 2 s");
}

TEST(Expectations, AlwaysOutsideAppliesToTheCompleteOutline) {
  for (const auto& [pose, ok] : {std::pair{Pose2{4.31, 2, 0}, true},
                                 {Pose2{4.29, 2, 0}, false},
                                 {Pose2{2, 2, 0}, false},
                                 {Pose2{4.2, 4.2, M_PI / 4}, false},
                                 {Pose2{4.3, 4.3, M_PI / 4}, true}}) {
    Case c({When::always, 0s, PlaceExpectation{false, {0, 0, 4, 4}, {"r1"}}, 1, ""});
    c.pose = pose;
    c.expectations->judge(1s, c.evidence);
    EXPECT_EQ(c.finish().ok, ok) << pose.x << " " << pose.y;
  }
}

}  // namespace
}  // namespace adit::sim
