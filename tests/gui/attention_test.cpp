// SPDX-License-Identifier: Apache-2.0
// What the window says that needs the operator.
#include <gmock/gmock.h>

#include "basestation/gui/bridge/attention.hpp"
#include "tests/gui/fixture.hpp"

namespace adit::gui {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class AttentionTest : public testing::Test {
 protected:
  AttentionTest() {
    world_.station = "op1";
    world_.stations = {{.name = "op1", .self = true}, {.name = "op2"}};
    for (const char* name : {"r1", "r2", "r3", "r4"}) {
      world_.robots.push_back(mine(robot(name, 0, 0)));
      world_.robots.back().mode = "waypoint";
      world_.robots.back().moving_allowed = true;
      world_.robots.back().goal_state = contract::GoalState::active;
    }
  }
  station::Robot& r(int number) { return world_.robots[static_cast<std::size_t>(number) - 1]; }
  void say(const std::string& robot, const std::string& code, const std::string& text) {
    queue_.add({{.code = code, .text = text, .robot = robot}, 0, 0.0, true}, world_, now_);
  }
  std::vector<Need> needs() {
    queue_.update(world_, now_);
    return needs_of(queue_, world_, now_);
  }
  /// The rows of what the state alone shows.
  std::vector<std::string> settled_lines() {
    queue_.update(world_, now_);
    now_ += station::AlertQueue::kSettles;
    return lines();
  }
  std::vector<std::string> lines() {
    std::vector<std::string> out;
    for (const Need& need : needs()) out.push_back(need.who + ": " + need.text);
    return out;
  }
  void block(int number) {
    r(number).goal_state = contract::GoalState::blocked;
    r(number).reason = Reason::blocked;
    r(number).moving_allowed = false;
  }

  station::World world_{};
  station::AlertQueue queue_{};
  double now_{100.0};
};

TEST_F(AttentionTest, IsEmptyWhileEveryRobotWorks) { EXPECT_THAT(lines(), IsEmpty()); }

TEST_F(AttentionTest, SaysWhatTheNotificationSaidAndSinceWhen) {
  block(1);
  say("r1", "blocked", "every path is blocked");
  now_ += 72;
  EXPECT_THAT(lines(), ElementsAre("r1: every path is blocked"));
  EXPECT_EQ(needs()[0].since, "72 s");
  EXPECT_TRUE(needs()[0].can_wait);
  EXPECT_FALSE(needs()[0].can_see);
  EXPECT_FALSE(needs()[0].urgent);
}

TEST_F(AttentionTest, ARobotOfWhichNoNotificationWasHeardIsFoundByItsState) {
  block(2);
  EXPECT_THAT(settled_lines(), ElementsAre("r2: every path is blocked"));
  const std::string id = needs()[0].id;
  say("r2", "blocked", "the door is closed");
  EXPECT_THAT(lines(), ElementsAre("r2: the door is closed")) << "once, not twice";
  EXPECT_EQ(needs()[0].id, id);
}

TEST_F(AttentionTest, WhatWasPutOffDoesNotComeBackByTheState) {
  block(2);
  say("r2", "blocked", "every path is blocked");
  queue_.later(needs()[0].alert, now_);
  EXPECT_THAT(settled_lines(), IsEmpty());
  now_ += station::AlertQueue::kLater + 1;
  EXPECT_EQ(lines().size(), 1U);
}

TEST_F(AttentionTest, AComponentThatStartsNeedsNothingAndOneThatFailedDoes) {
  r(1).troubles = {"planner starting", "lidar waiting"};
  EXPECT_THAT(settled_lines(), IsEmpty());
  r(1).troubles = {"planner starting", "lidar FAILED"};
  EXPECT_THAT(settled_lines(), ElementsAre("r1: lidar FAILED"));
}

TEST_F(AttentionTest, OnesOwnStopAndRobotsOfOthersNeedNothing) {
  r(1).stopped = true;
  r(1).stops = {"op1"};
  block(3);
  r(3).mine = false;
  r(3).holder = "op2";
  EXPECT_THAT(settled_lines(), IsEmpty());
  r(1).stops = {"op1", "op2"};
  EXPECT_THAT(settled_lines(), ElementsAre("r1: stopped by op1, op2"));
}

TEST_F(AttentionTest, AStopByAnotherIsUrgentUntilSeenAndStaysUntilReset) {
  r(1).stopped = true;
  r(1).stops = {"op2"};
  say("r1", "stopped", "op2 stopped r1");
  EXPECT_TRUE(needs()[0].urgent);
  EXPECT_TRUE(needs()[0].can_see);
  queue_.see(needs()[0].alert);
  EXPECT_FALSE(needs()[0].urgent);
  EXPECT_THAT(lines(), ElementsAre("r1: op2 stopped r1"));
  r(1).stopped = false;
  r(1).stops.clear();
  now_ += 1;
  EXPECT_THAT(lines(), IsEmpty());
}

TEST_F(AttentionTest, WhoAsksForALockedRobotCanBeGrantedIt) {
  r(4).locked = true;
  say("r4", "asked", "op2 asked for r4");
  EXPECT_EQ(needs()[0].grant_line, "grant r4 op2");
  world_.stations[1].lost = true;
  EXPECT_EQ(needs()[0].grant_line, "") << "a station that is not heard takes nothing";
  world_.stations.clear();
  say("r4", "asked", "r9; stop all asked for r4");
  EXPECT_EQ(needs()[0].grant_line, "") << "only a name that is on the air";
}

TEST_F(AttentionTest, ManyRobotsWithOneCauseAreOneRow) {
  for (int i = 1; i <= 4; ++i) {
    r(i).lost = true;
    r(i).age = 3;
    say("r" + std::to_string(i), "lost", "r" + std::to_string(i) + " is lost");
  }
  EXPECT_THAT(lines(), ElementsAre("4 robots: lost: r1, r2, r3, r4"));
}

TEST_F(AttentionTest, AStopOfManyRobotsNamesWhoStoppedThem) {
  for (int i = 1; i <= 4; ++i) {
    r(i).stopped = true;
    r(i).stops = i == 4 ? std::vector<std::string>{"op3", "op2"} : std::vector<std::string>{"op2"};
    say("r" + std::to_string(i), "stopped", "op2 stopped r" + std::to_string(i));
  }
  EXPECT_THAT(lines(), ElementsAre("4 robots: stopped by op2, op3: r1, r2, r3, r4"));
}

}  // namespace
}  // namespace adit::gui
