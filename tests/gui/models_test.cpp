// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "basestation/gui/bridge/action_bar.hpp"
#include "basestation/gui/bridge/card.hpp"
#include "tests/gui/fixture.hpp"

namespace adit::gui {
namespace {

Card card(const std::string& name, double silent = 0.0) {
  const station::World world = ten_robots();
  return card_of(*world.robot(name), 1, silent, 1.0);
}

const BarButton& button(const ActionBar& bar, const std::string& id) {
  for (const BarButton& next : bar.buttons)
    if (next.id == id) return next;
  throw std::runtime_error("no button " + id);
}

const Refusal* refusal(const ActionBar& bar, const std::string& label) {
  for (const Refusal& next : bar.not_now)
    if (next.label.find(label) != std::string::npos) return &next;
  return nullptr;
}

TEST(Card, ADrivingRobotOfMineSaysWhereItDrives) {
  const Card r1 = card("r1");
  EXPECT_EQ(r1.headline, "WAYPOINT");
  EXPECT_EQ(r1.headline_token, Token::ok);
  EXPECT_EQ(r1.holder, "mine");
  EXPECT_EQ(r1.detail, "to 9.0 4.0");
  EXPECT_EQ(r1.goal, "8 m");
  EXPECT_EQ(r1.speed, "0.8 m/s");
  EXPECT_EQ(r1.battery, "82 %");
  EXPECT_EQ(r1.contact, Contact::live);
}

TEST(Card, AStoppedRobotNamesWhoStoppedIt) {
  EXPECT_EQ(card("r2").headline, "STOP");
  EXPECT_EQ(card("r2").detail, "stopped by op2");
  EXPECT_EQ(card("r2").shape, "square");
}

TEST(Card, ARobotOfAnotherOperatorNamesHim) {
  EXPECT_EQ(card("r3").holder, "op2");
  EXPECT_EQ(card("r3").owner, Token::other);
  EXPECT_EQ(card("r8").holder, "op2, locked");
}

TEST(Card, BlockedWaitingAndBrokenRobotsNeedTheOperator) {
  EXPECT_EQ(card("r4").headline, "BLOCKED");
  EXPECT_EQ(card("r6").headline, "EXPLORE WAITS");
  EXPECT_EQ(card("r6").detail, std::string(describe(Reason::terrain_stale)));
  EXPECT_EQ(card("r9").detail, "planner hung");
  EXPECT_EQ(card("r9").short_detail, "one component in trouble");
}

TEST(Card, ALostRobotSaysWhenItWasHeard) {
  EXPECT_EQ(card("r5").headline, "LOST");
  EXPECT_EQ(card("r5").detail, "last heard 47 s ago");
  EXPECT_EQ(card("r5").contact, Contact::lost);
}

TEST(Card, ValuesOfASilentStationAreStale) {
  EXPECT_EQ(card("r7").contact, Contact::stale);
  EXPECT_EQ(card("r1", 5.0).contact, Contact::stale);
  EXPECT_EQ(card("r1", 5.0).age, "5.1 s");
}

TEST(Card, ValuesThatMeanNothingAreADash) {
  station::Robot odd = robot("odd", 0, 0);
  odd.vx = 1e30F;
  odd.battery = std::numeric_limits<float>::quiet_NaN();
  odd.age = std::numeric_limits<double>::infinity();
  const Card card = card_of(odd, 1, 0.0, 1.0);
  EXPECT_EQ(card.speed, "- m/s");
  EXPECT_EQ(card.battery, "-");
  EXPECT_EQ(card.age, "-");
}

TEST(Card, ARobotThatMovesIsNotReady) {
  station::Robot moving = mine(robot("r1", 0, 0));
  EXPECT_EQ(card_of(moving, 1, 0.0, 1.0).detail, "ready");
  moving.vx = 1.0F;
  moving.mode = "smart_joystick";
  EXPECT_EQ(card_of(moving, 1, 0.0, 1.0).detail, "driven by hand");
  moving.mode = "convoy_follow";
  moving.convoy = {"r4", "r1"};
  EXPECT_EQ(card_of(moving, 1, 0.0, 1.0).detail, "follows r4");
  moving.mode = "hold";
  moving.convoy.clear();
  EXPECT_EQ(card_of(moving, 1, 0.0, 1.0).detail, "moves without a goal");
}

TEST(Card, ARobotThatLostItsStickSaysSo) {
  station::Robot lost = mine(robot("r1", 0, 0));
  lost.reason = Reason::joystick_stale;
  for (const char* mode : {"hold", "smart_joystick"}) {
    lost.mode = mode;
    EXPECT_EQ(card_of(lost, 1, 0.0, 1.0).detail, std::string(describe(Reason::joystick_stale))) << mode;
  }
}

TEST(ActionBar, HasEveryPlaceAlwaysInTheSameOrder) {
  const station::World world = ten_robots();
  for (const std::vector<std::string>& selection :
       std::vector<std::vector<std::string>>{{}, {"r1"}, {"r5", "r8"}, {"nobody"}}) {
    const ActionBar bar = bar_of(world, selection);
    ASSERT_EQ(bar.buttons.size(), kSlots.size());
    for (std::size_t i = 0; i < kSlots.size(); ++i) EXPECT_EQ(bar.buttons[i].id, kSlots[i].id);
  }
}

TEST(ActionBar, NamesTheRobotsInTheLine) {
  const ActionBar bar = bar_of(ten_robots(), {"r1", "r4"});
  EXPECT_EQ(button(bar, "mode_hold").line, "mode r1 r4 hold");
  EXPECT_EQ(button(bar, "stop").line, "stop r1 r4");
  EXPECT_EQ(button(bar, "release").line, "release r1 r4");
  EXPECT_EQ(button(bar, "lock").hint, "");
}

TEST(ActionBar, ARobotThatIsNotHeldIsTakenByATapAndAnothersByHolding) {
  EXPECT_EQ(button(bar_of(ten_robots(), {"r7"}), "take").touch, Touch::tap);
  const ActionBar bar = bar_of(ten_robots(), {"r3"});
  EXPECT_EQ(button(bar, "take").touch, Touch::hold);
  EXPECT_EQ(button(bar, "take").hint, "from op2");
  EXPECT_TRUE(button(bar_of(ten_robots(), {"r8"}), "take").robots.empty());  // Locked.
}

TEST(ActionBar, EveryHolderIsNamedFromWhomRobotsAreTaken) {
  station::World world = ten_robots();
  world.robots[7].locked = false;
  world.robots[7].holder = "op3";
  EXPECT_EQ(button(bar_of(world, {"r3", "r8"}), "take").hint, "from op2, op3");
}

TEST(ActionBar, WhatIsNotPossibleSaysWhyAndWhatHelps) {
  const ActionBar free = bar_of(ten_robots(), {"r7"});
  const Refusal* no_holder = refusal(free, "Go to");
  ASSERT_NE(no_holder, nullptr);
  EXPECT_EQ(no_holder->cure_line, "take r7");
  EXPECT_FALSE(no_holder->cure_hold);
  EXPECT_NE(no_holder->label.find("Release"), std::string::npos) << "one row for one reason";

  const ActionBar others = bar_of(ten_robots(), {"r3"});
  const Refusal* held = refusal(others, "Go to");
  ASSERT_NE(held, nullptr);
  EXPECT_EQ(held->cure_line, "take r3");
  EXPECT_TRUE(held->cure_hold);

  const ActionBar stopped = bar_of(ten_robots(), {"r2"});
  const Refusal* stop = refusal(stopped, "Waypoint");
  ASSERT_NE(stop, nullptr);
  EXPECT_EQ(stop->cure_line, "reset r2 --override");
  EXPECT_TRUE(stop->cure_hold);
}

TEST(ActionBar, AStopOfAnotherIsResetByHoldingTheSameButton) {
  const station::World world = ten_robots();
  const ActionBar bar = bar_of(world, {"r2"});  // Mine, stopped by op2.
  const auto reset = std::find_if(bar.buttons.begin(), bar.buttons.end(),
                                  [](const BarButton& button) { return button.id == "reset"; });
  ASSERT_NE(reset, bar.buttons.end());
  EXPECT_EQ(reset->line, "reset r2 --override");
  EXPECT_EQ(reset->touch, Touch::hold);
  EXPECT_EQ(reset->hint, "stop of op2");
}

TEST(ActionBar, AMixedSelectionSaysHowManyWouldObey) {
  const ActionBar bar = bar_of(ten_robots(), {"r1", "r3", "r4"});
  EXPECT_EQ(button(bar, "release").hint, "2/3");
  EXPECT_THAT(button(bar, "release").robots, testing::ElementsAre("r1", "r4"));
}

TEST(ActionBar, CommandsToManyRobotsAreHeld) {
  station::World world;
  std::vector<std::string> all;
  for (const char* name : {"a", "b", "c", "d"}) {
    world.robots.push_back(mine(robot(name, 0, 0)));
    world.robots.back().mode = "waypoint";
    all.emplace_back(name);
  }
  const ActionBar bar = bar_of(world, all);
  EXPECT_EQ(button(bar, "explore").touch, Touch::hold);
  EXPECT_EQ(button(bar, "mode_hold").touch, Touch::tap);
  EXPECT_EQ(button(bar, "stop").touch, Touch::tap);
}

TEST(ActionBar, LockedRobotsAreUnlocked) {
  const ActionBar bar = bar_of(ten_robots(), {"r4"});
  EXPECT_EQ(button(bar, "lock").line, "unlock r4");
  EXPECT_EQ(button(bar, "lock").label, "Unlock");
}

TEST(ActionBarConvoy, IsStartedInTheOrderOfTheSelectionByHolding) {
  const BarButton start = button(bar_of(ten_robots(), {"r4", "r1", "r6"}), "convoy");
  EXPECT_EQ(start.line, "convoy start r4 r1 r6");
  EXPECT_EQ(start.touch, Touch::hold);
  EXPECT_EQ(start.hint, "r4 first");
}

TEST(ActionBarConvoy, SaysWhatIsMissing) {
  const ActionBar one = bar_of(ten_robots(), {"r1"});
  EXPECT_TRUE(button(one, "convoy").robots.empty());
  EXPECT_THAT(refusal(one, "Convoy")->why, testing::HasSubstr("select the leader"));
  const ActionBar mixed = bar_of(ten_robots(), {"r1", "r3"});
  EXPECT_TRUE(button(mixed, "convoy").robots.empty());
  EXPECT_EQ(refusal(mixed, "Convoy")->cure_line, "take r3");
  station::World world = ten_robots();
  world.robots[0].lost = true;
  EXPECT_TRUE(button(bar_of(world, {"r1", "r4"}), "convoy").robots.empty());
  EXPECT_TRUE(button(bar_of(ten_robots(), {}), "convoy").robots.empty());
}

TEST(ActionBarConvoy, IsEndedByItsLeaderAndLeftByAFollower) {
  station::World world = ten_robots();
  for (const int i : {0, 3, 5}) world.robots[static_cast<std::size_t>(i)].convoy = {"r1", "r4", "r6"};
  EXPECT_EQ(button(bar_of(world, {"r1"}), "convoy").line, "convoy stop r1");
  EXPECT_EQ(button(bar_of(world, {"r1", "r4"}), "convoy").label, "End convoy");
  EXPECT_EQ(button(bar_of(world, {"r4", "r6"}), "convoy").line, "peeloff r4 r6");
  EXPECT_EQ(button(bar_of(world, {"r4", "r2"}), "convoy").label, "Convoy") << "r2 is in none";
}

}  // namespace
}  // namespace adit::gui
