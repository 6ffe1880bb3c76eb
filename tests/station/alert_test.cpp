// SPDX-License-Identifier: Apache-2.0
// What needs the operator, and until when.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "basestation/alert/queue.hpp"
#include "core/time/random.hpp"

namespace adit::station {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

std::string content(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The first groups of all matches.
std::set<std::string> matches(const std::string& text, const char* pattern) {
  const std::regex expression(pattern);
  std::set<std::string> out;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), expression); it != std::sregex_iterator();
       ++it)
    out.insert((*it)[1]);
  return out;
}

TEST(AlertTable, HasOneRowForEachCodeThatOperatorsCanRead) {
  const std::string page = content(fs::path(ADIT_SOURCE_DIR) / "docs/operators.md");
  const std::string table = page.substr(page.find("## Notifications"));
  std::set<std::string> documented;
  for (const std::string& cell : matches(table, "\n\\| (`[^|]*) \\|"))
    for (const std::string& code : matches(cell, "`([a-z_]+)`")) documented.insert(code);
  ASSERT_GT(documented.size(), 50U);
  std::set<std::string> rows;
  for (const AlertRow& row : alert_table()) {
    EXPECT_TRUE(rows.insert(std::string(row.code)).second) << row.code << " has two rows";
    EXPECT_TRUE(documented.contains(std::string(row.code))) << row.code << " is not in docs/operators.md";
    EXPECT_TRUE(row.closed_by.empty() || alert_row(row.closed_by)) << row.closed_by << " is no code";
  }
  for (const std::string& code : documented) EXPECT_TRUE(rows.contains(code)) << code << " has no priority";
}

TEST(AlertTable, HasARowForEachCodeThatAProgramSends) {
  std::set<std::string> sent;
  for (const char* folder : {"robot_agent", "basestation"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ADIT_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".cpp") continue;
      const std::string text = content(entry.path());
      for (const char* pattern : {"Severity::[a-z]+,\\s*\"([a-z_]+)\"", "\\.code = \"([a-z_]+)\""})
        sent.merge(matches(text, pattern));
    }
  ASSERT_GT(sent.size(), 30U);
  for (const std::string& code : sent) EXPECT_TRUE(alert_row(code)) << code << " has no row";
}

/// A world of robots r1, r2, ... of this operator, and a queue.
class AlertQueueTest : public testing::Test {
 protected:
  AlertQueueTest() {
    for (int i = 1; i <= 5; ++i) {
      Robot& robot = world_.robots.emplace_back();
      robot.name = "r" + std::to_string(i);
      robot.mine = true;
      robot.mode = "waypoint";
    }
  }
  Robot& r(int number) { return world_.robots[static_cast<std::size_t>(number) - 1]; }
  Priority say(const std::string& robot, const std::string& code, bool mine = true) {
    return queue_.add({{.code = code, .text = robot + " " + code, .robot = robot}, 0, 0.0, mine}, world_,
                      now_);
  }
  void pass(double seconds) {
    now_ += seconds;
    queue_.update(world_, now_);
  }
  std::vector<std::string> shown() const {
    std::vector<std::string> out;
    for (const Alert& alert : queue_.shown(now_)) {
      std::string text = alert.code;
      for (const std::string& robot : alert.robots) text += " " + robot;
      out.push_back(alert.count > 1 ? text + " x" + std::to_string(alert.count) : text);
    }
    return out;
  }

  World world_{};
  AlertQueue queue_{};
  double now_{1000.0};
};

TEST_F(AlertQueueTest, TheMostUrgentAndThenTheOldestComesFirst) {
  say("r1", "blocked");
  now_ += 1;
  say("r2", "blocked");
  now_ += 1;
  EXPECT_EQ(say("r3", "stopped"), Priority::act);
  EXPECT_THAT(shown(), ElementsAre("stopped r3", "blocked r1", "blocked r2"));
  EXPECT_EQ(say("r1", "arrived"), Priority::log);
}

TEST_F(AlertQueueTest, WithinAPriorityTheGreatestRiskComesFirst) {
  say("r1", "explore_ended");
  say("r2", "blocked");
  say("r3", "odometry_jumped");
  say("r4", "store_failing");
  say("r5", "stopped");
  say("r4", "rival_writer");
  EXPECT_THAT(shown(), ElementsAre("rival_writer r4", "stopped r5", "odometry_jumped r3", "blocked r2",
                                   "explore_ended r1", "store_failing r4"));
}

TEST_F(AlertQueueTest, ARobotThatHasNothingToDoIsNews) {
  EXPECT_EQ(say("r1", "idle"), Priority::know);
  pass(60.0);
  EXPECT_TRUE(shown().empty());
}

TEST_F(AlertQueueTest, WhatTheStateShowsNeedsNoNotification) {
  r(1).lost = true;
  r(2).stopped = true;
  r(2).stops = {"op2"};
  r(3).mode = "hold";
  r(3).reason = Reason::driver_silent;  // It ended its mode by itself.
  r(4).troubles = {"planner FAILED"};
  r(5).troubles = {"inputs up"};
  pass(0.0);
  EXPECT_TRUE(shown().empty());
  pass(AlertQueue::kSettles);
  EXPECT_THAT(shown(),
              ElementsAre("stopped r2", "driver_lost r3", "lost r1", "component_failed r4", "inputs r5"));
  for (int i = 1; i <= 5; ++i) {
    r(i) = {};
    r(i).name = "r" + std::to_string(i);
    r(i).mine = true;
  }
  pass(0.1);
  EXPECT_TRUE(shown().empty());
}

TEST_F(AlertQueueTest, AnAlertOfARobotThatNobodyHoldsEndsWithItsCause) {
  r(1).stopped = true;
  r(1).stops = {"op2"};
  say("r1", "stopped");
  pass(1.0);
  r(1).mine = false;
  pass(10.0);
  EXPECT_THAT(shown(), ElementsAre("stopped r1"));
  r(1).stopped = false;
  r(1).stops.clear();
  pass(0.1);
  EXPECT_TRUE(shown().empty());
  r(1).reason = Reason::blocked;
  pass(10.0);
  pass(10.0);
  EXPECT_TRUE(shown().empty()) << "the state alone is no concern of this operator";
}

TEST_F(AlertQueueTest, AStateThatComesAfterTheNotificationConfirmsIt) {
  say("r1", "component_failed");
  for (int i = 0; i < 6; ++i) pass(0.2);  // The health report was lost, and is repeated.
  EXPECT_THAT(shown(), ElementsAre("component_failed r1"));
  const std::uint64_t id = queue_.shown(now_)[0].id;
  r(1).troubles = {"planner FAILED"};
  pass(0.2);
  pass(60.0);
  ASSERT_EQ(shown().size(), 1U);
  EXPECT_EQ(queue_.shown(now_)[0].id, id);
  EXPECT_EQ(queue_.shown(now_)[0].text, "r1 component_failed");
  r(1).troubles.clear();
  pass(0.2);
  EXPECT_TRUE(shown().empty());
  say("r2", "component_failed");
  pass(AlertQueue::kEvidence);
  EXPECT_TRUE(shown().empty()) << "the state never showed it";
}

TEST_F(AlertQueueTest, WhatTheRobotsStateDoesNotCarryStaysUntilItWasSeen) {
  r(1).mode = "manual";
  r(1).moving_allowed = true;
  EXPECT_EQ(say("r1", "tilted"), Priority::act);
  for (int i = 0; i < 60; ++i) pass(1.0);
  EXPECT_THAT(shown(), ElementsAre("tilted r1"));
}

TEST_F(AlertQueueTest, ANotificationWithAnotherReasonThanTheStatesStays) {
  r(1).goal_state = GoalState::blocked;
  r(1).reason = Reason::blocked;
  pass(0.0);
  pass(3.0);
  const std::uint64_t id = queue_.shown(now_)[0].id;
  queue_.later(id, now_);
  queue_.add({{.code = "yield_refused", .reason = Reason::yield_refused, .robot = "r1"}, 0, 0.0, true},
             world_, now_);
  for (int i = 0; i < 50; ++i) pass(0.2);
  EXPECT_THAT(shown(), ElementsAre("yield_refused r1")) << "it is shown again, in place of the state's";
  EXPECT_EQ(queue_.shown(now_)[0].id, id);
}

TEST_F(AlertQueueTest, ReasonsThatAlternateAreOneAlert) {
  for (int i = 0; i < 40; ++i) {
    r(1).reason = i % 2 == 0 ? Reason::blocked : Reason::start_in_collision;
    pass(0.3);
  }
  ASSERT_EQ(shown().size(), 1U);
  EXPECT_EQ(queue_.shown(now_)[0].id, 1U);
}

TEST_F(AlertQueueTest, AStopWhoseStopperIsNotKnownYetMayBeOnesOwn) {
  world_.station = "op1";
  r(1).stopped = true;
  pass(0.0);
  pass(AlertQueue::kSettles);
  EXPECT_TRUE(shown().empty());
  r(1).stops = {"op1"};
  pass(10.0);
  EXPECT_TRUE(shown().empty());
}

TEST_F(AlertQueueTest, AShortConditionIsNoAlert) {
  for (int i = 0; i < 10; ++i) {
    r(1).reason = i % 2 == 0 ? Reason::terrain_stale : Reason::none;
    pass(0.4);
  }
  EXPECT_TRUE(shown().empty());
}

TEST_F(AlertQueueTest, WhatTheOperatorDidIsNoAlert) {
  world_.station = "op1";
  r(1).stopped = true;
  r(1).stops = {"op1"};
  r(1).reason = Reason::stopped;
  r(2).mode = "hold";
  r(2).reason = Reason::not_holder;  // It came to this operator in hold.
  r(3).goal_state = GoalState::reached;
  r(3).moving_allowed = true;
  r(4).mode = "hold";
  r(5).mode = "convoy_follow";
  r(5).moving_allowed = true;
  r(5).convoy = {"r4", "r5"};
  for (int i = 0; i < 200; ++i) pass(1.0);
  EXPECT_TRUE(shown().empty());
}

TEST_F(AlertQueueTest, AnotherReasonIsAnotherAlert) {
  r(1).reason = Reason::blocked;
  say("r1", "blocked");
  queue_.add({{.code = "blocked", .reason = Reason::blocked, .robot = "r1"}, 0, 0.0, true}, world_, now_);
  pass(1.0);
  EXPECT_THAT(shown(), ElementsAre("blocked r1 x2"));
  r(1).reason = Reason::odometry_jumped;
  pass(0.1);
  pass(AlertQueue::kSettles);
  EXPECT_THAT(shown(), ElementsAre("odometry_jumped r1"));
}

TEST_F(AlertQueueTest, ARobotThatIsLostKeepsItsAlertsUntilItsStateIsKnownAgain) {
  r(1).stopped = true;
  r(1).stops = {"op2"};
  say("r1", "stopped");
  pass(1.0);
  queue_.see(queue_.shown(now_)[0].id);
  r(1).lost = true;
  r(1).age = 3.0;
  pass(3.0);
  pass(AlertQueue::kSettles);
  EXPECT_THAT(shown(), ElementsAre("stopped r1", "lost r1"));
  r(1).lost = r(1).stopped = false;
  r(1).stops.clear();
  r(1).age = 0.0;
  pass(0.1);
  EXPECT_TRUE(shown().empty());
}

TEST_F(AlertQueueTest, TheSameIsCountedInOneRow) {
  r(1).reason = Reason::blocked;
  for (int i = 0; i < 4; ++i) {
    say("r1", "blocked");
    pass(10.0);
  }
  EXPECT_THAT(shown(), ElementsAre("blocked r1 x4"));
}

TEST_F(AlertQueueTest, AHungComponentThatEndsItsAgentIsOneRowInEitherOrder) {
  say("r1", "escalated");
  say("r1", "component_hung");
  EXPECT_THAT(shown(), ElementsAre("escalated r1"));
  say("r2", "component_hung");
  say("r2", "escalated");
  say("r3", "component_hung");
  EXPECT_THAT(shown(), ElementsAre("escalated r1", "escalated r2", "component_hung r3"));
  r(1).troubles = r(3).troubles = {"planner hung"};
  pass(AlertQueue::kTogether + 1.0);
  say("r1", "component_hung");
  EXPECT_THAT(shown(), ElementsAre("escalated r1", "escalated r2", "component_hung r3", "component_hung r1"))
      << "a component that hangs later is another matter";
  queue_.add({{.severity = Severity::warning, .robot = "r3"}, 0, 0.0, true}, world_, now_);
  EXPECT_EQ(queue_.size(), 5U) << "a notification without a code is part of nothing";
}

TEST_F(AlertQueueTest, AnOwnCommandThatIsRefusedIsNoAlert) {
  EXPECT_EQ(say("r1", "mode_refused"), Priority::log);
  EXPECT_TRUE(shown().empty());
}

TEST_F(AlertQueueTest, ARobotThatAnotherOperatorTookNeedsNothingHere) {
  r(1).stopped = true;
  r(1).stops = {"op2"};
  say("r1", "stopped");
  pass(1.0);
  EXPECT_THAT(shown(), ElementsAre("stopped r1"));
  r(1).mine = false;
  pass(1.0);
  EXPECT_THAT(shown(), ElementsAre("stopped r1")) << "no operator has it: it may be anybody's";
  r(1).holder = "op2";
  pass(1.0);
  EXPECT_TRUE(shown().empty());
}

TEST_F(AlertQueueTest, ARobotThatWasTakenAwayIsUrgentUntilItWasSeen) {
  r(1).mine = false;
  r(1).holder = "op2";
  say("r2", "lock_lapsed");
  EXPECT_EQ(say("r1", "taken"), Priority::act);
  EXPECT_EQ(say("r3", "released"), Priority::know) << "it was given away";
  pass(60.0);
  EXPECT_THAT(shown(), ElementsAre("taken r1", "lock_lapsed r2"));
}

TEST_F(AlertQueueTest, EndsWhenItsCauseIsGone) {
  r(1).reason = Reason::blocked;
  say("r1", "blocked");
  pass(1.0);
  EXPECT_THAT(shown(), ElementsAre("blocked r1"));
  r(1).reason = Reason::none;
  pass(1.0);
  EXPECT_THAT(shown(), ElementsAre());

  r(2).lost = true;
  say("r2", "lost");
  pass(1.0);
  EXPECT_THAT(shown(), ElementsAre("lost r2"));
  say("r2", "back");
  pass(0.1);
  EXPECT_THAT(shown(), ElementsAre()) << "also by a state that is older";
  r(2).lost = false;

  r(3).stopped = true;
  r(3).stops = {"op2"};
  say("r3", "stopped");
  pass(60.0);
  EXPECT_THAT(shown(), ElementsAre("stopped r3"));
  r(3).stopped = false;
  r(3).stops.clear();
  pass(1.0);
  EXPECT_THAT(shown(), ElementsAre());
}

TEST_F(AlertQueueTest, AStateThatIsOlderThanTheNotificationEndsNothing) {
  r(1).age = 5.0;  // The robot's state does not show yet that it is blocked.
  say("r1", "blocked");
  pass(1.0);
  EXPECT_THAT(shown(), ElementsAre("blocked r1"));
}

TEST_F(AlertQueueTest, WhatIsLostByHandIsUrgent) {
  EXPECT_EQ(say("r1", "lost"), Priority::soon);
  r(2).mode = "manual";
  EXPECT_EQ(say("r2", "lost"), Priority::act);
  EXPECT_EQ(say("r2", "joystick_lost"), Priority::act);
}

TEST_F(AlertQueueTest, ManyRobotsWithOneCodeAreOneRow) {
  for (int i = 1; i <= 4; ++i) {
    r(i).lost = true;
    say("r" + std::to_string(i), "lost");
    now_ += 1.0;
  }
  EXPECT_THAT(shown(), ElementsAre("lost r1 r2 r3 r4 x4"));
  say("r2", "back");
  EXPECT_THAT(shown(), ElementsAre("lost r1 r3 r4 x4"));
  for (const int i : {1, 2, 3, 4}) r(i).lost = false;
  pass(1.0);
  EXPECT_THAT(shown(), ElementsAre());
}

TEST_F(AlertQueueTest, ThoseThatComeSlowlyStayApart) {
  for (int i = 1; i <= 3; ++i) {
    r(i).lost = true;
    say("r" + std::to_string(i), "lost");
    now_ += AlertQueue::kTogether + 1.0;
  }
  EXPECT_EQ(shown().size(), 3U);
}

TEST_F(AlertQueueTest, WhatNoStateShowsStaysUntilItIsSeen) {
  say("r1", "lock_lapsed");
  pass(1000.0);
  ASSERT_EQ(shown().size(), 1U);
  queue_.see(queue_.shown(now_)[0].id);
  pass(1.0);
  EXPECT_THAT(shown(), ElementsAre());
}

TEST_F(AlertQueueTest, LaterHidesAnAlertForFiveMinutesOrUntilItComesAgain) {
  r(1).reason = Reason::blocked;
  say("r1", "blocked");
  queue_.later(queue_.shown(now_)[0].id, now_);
  pass(299.0);
  EXPECT_THAT(shown(), ElementsAre());
  pass(2.0);
  EXPECT_THAT(shown(), ElementsAre("blocked r1"));
  queue_.later(queue_.shown(now_)[0].id, now_);
  say("r1", "blocked");
  EXPECT_THAT(shown(), ElementsAre("blocked r1 x2"));
}

TEST_F(AlertQueueTest, WhatConcernsAnotherOperatorIsNoAlert) {
  EXPECT_EQ(say("r1", "stopped", false), Priority::log);
  EXPECT_THAT(shown(), ElementsAre());
}

TEST_F(AlertQueueTest, ACodeOfALaterVersionCountsByItsLevel) {
  EXPECT_EQ(
      queue_.add({{.severity = Severity::info, .code = "of_a_later_version"}, 0, 0.0, true}, world_, now_),
      Priority::know);
  EXPECT_EQ(
      queue_.add({{.severity = Severity::error, .code = "of_a_later_version"}, 0, 0.0, true}, world_, now_),
      Priority::soon);
}

TEST_F(AlertQueueTest, AFloodStaysBoundedAndKeepsWhatIsUrgent) {
  r(1).stopped = true;
  say("r1", "stopped");
  for (int i = 0; i < 10'000; ++i) {
    say("x" + std::to_string(i), "lock_lapsed");
    now_ += 10.0;
  }
  EXPECT_LE(queue_.size(), AlertQueue::kMaxAlerts);
  EXPECT_EQ(shown().front(), "stopped r1");
}

}  // namespace
}  // namespace adit::station
