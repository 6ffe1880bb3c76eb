// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/motion_guard.hpp"

#include <gmock/gmock.h>

namespace adit::agent {
namespace {

const Facts kAllConditions{
    false, true, true, true,
    true,  true, true, true,
    true,  true, true, {"in_convoy", "leader_known", "order_agrees", "yield_allowed", "in_the_way"}};

/// A party that may request the mode.
Commander requester(const ModeRow& row) {
  return row.commanded_by.holder ? Commander::holder : Commander::agent;
}

class Guard : public testing::Test {
 protected:
  const ModeRow& row(std::string_view name) const { return *table.find(name); }
  Decision runs(std::string_view name) const { return {table.find(name), true, Reason::none}; }
  Decision pauses(std::string_view name) const { return {table.find(name), false, Reason::none}; }

  const ModeTable& table = ModeTable::shipped();
  MotionGuard guard{table};
};

TEST_F(Guard, PassesNothingThatWasNotAdmitted) {
  for (const ModeRow& each : table.rows()) {
    const Decision d = guard.judge({&each, true, Reason::none}, kAllConditions);
    EXPECT_EQ(d.mode->name, "hold");
  }
}

TEST_F(Guard, AdmitsWhenEveryConditionHolds) {
  for (const ModeRow& each : table.rows()) {
    EXPECT_EQ(guard.admit(each, requester(each), kAllConditions), Reason::none);
    EXPECT_EQ(&guard.admitted(), &each);
    EXPECT_TRUE(guard.judge(runs(each.name), kAllConditions).runs);
  }
}

TEST_F(Guard, RefusesAnEntryOffCentre) {
  Facts pushed = kAllConditions;
  pushed.stick_centred = false;
  EXPECT_EQ(guard.admit(row("manual"), Commander::holder, pushed), Reason::stick_not_centred);
  EXPECT_EQ(guard.admitted().name, "hold");
  ASSERT_EQ(guard.admit(row("manual"), Commander::holder, kAllConditions), Reason::none);
  EXPECT_EQ(guard.admit(row("manual"), Commander::holder, pushed), Reason::none) << "it goes on already";
  EXPECT_EQ(guard.admit(row("smart_joystick"), Commander::holder, pushed), Reason::stick_not_centred);
}

TEST_F(Guard, OnlyTheHolderCommandsManualModes) {
  for (const char* mode : {"manual", "smart_joystick", "external"})
    EXPECT_EQ(guard.admit(row(mode), Commander::agent, kAllConditions), Reason::not_holder) << mode;
  EXPECT_EQ(guard.admit(row("waypoint"), Commander::agent, kAllConditions), Reason::none);
}

TEST_F(Guard, EveryLastingConditionIsAskedInEveryTick) {
  const auto fails = [](const Condition& c) {
    for (bool Facts::*fact :
         {&Facts::driver_alive, &Facts::localised, &Facts::terrain_fresh, &Facts::stick_fresh,
          &Facts::stick_present, &Facts::stick_centred, &Facts::goal_known, &Facts::goal_free,
          &Facts::program_fresh, &Facts::map_fresh}) {
      Facts f = kAllConditions;
      f.*fact = false;
      if (!c.holds(f)) return f;
    }
    for (const std::string_view fact : kAllConditions.also) {
      Facts f = kAllConditions;
      std::erase(f.also, fact);
      if (!c.holds(f)) return f;
    }
    Facts stopped = kAllConditions;
    stopped.stopped = true;
    return stopped;
  };
  for (const ModeRow& each : table.rows())
    for (const Condition& c : each.conditions) {
      if (c.entry_only()) continue;
      guard.hold();
      ASSERT_EQ(guard.admit(each, requester(each), kAllConditions), Reason::none);
      const Decision d = guard.judge(runs(each.name), fails(c));
      EXPECT_FALSE(d.runs) << each.name << " " << c.leaf;
      EXPECT_EQ(d.reason, c.reason);
      const bool ends = c.scope == Scope::terminal || each.on_failure == OnFailure::falls_to_hold;
      EXPECT_EQ(d.mode->name, ends ? "hold" : each.name) << c.leaf;
      // What ended needs a request; what paused goes on.
      EXPECT_EQ(guard.judge(runs(each.name), kAllConditions).mode->name, ends ? "hold" : each.name);
    }
}

TEST_F(Guard, TheTreeCanAskForLess) {
  ASSERT_EQ(guard.admit(row("waypoint"), Commander::holder, kAllConditions), Reason::none);
  EXPECT_FALSE(guard.judge(pauses("waypoint"), kAllConditions).runs);
  EXPECT_TRUE(guard.judge(runs("waypoint"), kAllConditions).runs);
  EXPECT_EQ(guard.judge(runs("hold"), kAllConditions).mode->name, "hold");
  EXPECT_EQ(guard.judge(runs("waypoint"), kAllConditions).mode->name, "hold") << "that was the end of it";
}

TEST_F(Guard, TheTreeCannotAskForAnotherMode) {
  ASSERT_EQ(guard.admit(row("manual"), Commander::holder, kAllConditions), Reason::none);
  const Decision d = guard.judge(runs("waypoint"), kAllConditions);
  EXPECT_EQ(d.mode->name, "hold");
  EXPECT_EQ(d.reason, Reason::tree_refused);
}

TEST_F(Guard, AManualModeCannotPause) {
  ASSERT_EQ(guard.admit(row("manual"), Commander::holder, kAllConditions), Reason::none);
  EXPECT_EQ(guard.judge(pauses("manual"), kAllConditions).mode->name, "hold");
  EXPECT_EQ(guard.judge(runs("manual"), kAllConditions).mode->name, "hold");
}

TEST_F(Guard, ManualModesAndConvoysEndWithTheirHolder) {
  for (const ModeRow& each : table.rows()) {
    ASSERT_EQ(guard.admit(each, requester(each), kAllConditions), Reason::none);
    const bool ends = each.name == "manual" || each.name == "smart_joystick" ||
                      each.name == "convoy_follow" || each.name == "get_out";
    EXPECT_EQ(guard.holder_changed(), ends) << each.name;
    EXPECT_EQ(guard.admitted().name, ends ? "hold" : each.name);
  }
}

TEST_F(Guard, ARestartReadmitsOnlyWhatPauses) {
  for (const ModeRow& each : table.rows()) {
    guard.readmit(each);
    EXPECT_EQ(guard.admitted().name, each.on_failure == OnFailure::pauses ? each.name : "hold");
  }
}

}  // namespace
}  // namespace adit::agent
