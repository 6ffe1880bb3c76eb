// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/decider.hpp"

#include <gmock/gmock.h>

#include <random>

#include "tests/folders/folders.hpp"

namespace adit::agent {
namespace {

const std::string kTree = source_folder() + "/config/trees/robot.xml";
const Facts kAllGood{
    false, true, true, true,
    true,  true, true, true,
    true,  true, true, {"in_convoy", "leader_known", "order_agrees", "yield_allowed", "in_the_way"}};

std::unique_ptr<Decider> load() {
  auto decider = Decider::load(kTree);
  if (!decider) ADD_FAILURE() << decider.error().text;
  return std::move(*decider);
}

TEST(Decider, RunsTheModeAskedForWhileItsConditionsHold) {
  const auto decider = load();
  Time now{};
  for (const ModeRow& row : ModeTable::shipped().rows()) {
    const Decision d = decider->decide(row.name, kAllGood, now += 50ms);
    EXPECT_EQ(d.mode->name, row.name);
    EXPECT_TRUE(d.runs);
    EXPECT_EQ(d.reason, Reason::none);
  }
}

// What the tree does when a condition of the table that lasts fails must be what the table says.
TEST(Decider, FollowsTheTableWhenAConditionFails) {
  const auto decider = load();
  const auto spoilt = [](const Condition& c) {
    Facts f = kAllGood;
    f.stopped = true;
    if (!c.holds(f)) return f;
    for (bool Facts::*fact :
         {&Facts::driver_alive, &Facts::localised, &Facts::terrain_fresh, &Facts::stick_fresh,
          &Facts::stick_present, &Facts::stick_centred, &Facts::goal_known, &Facts::goal_free,
          &Facts::program_fresh, &Facts::map_fresh}) {
      f = kAllGood;
      f.*fact = false;
      if (!c.holds(f)) return f;
    }
    for (const std::string_view fact : kAllGood.also) {
      f = kAllGood;
      std::erase(f.also, fact);
      if (!c.holds(f)) return f;
    }
    ADD_FAILURE() << c.leaf << " never fails";
    return f;
  };
  Time now{};
  for (const ModeRow& row : ModeTable::shipped().rows())
    for (const Condition& condition : row.conditions) {
      const Decision d = decider->decide(row.name, spoilt(condition), now += 50ms);
      if (condition.entry_only()) {
        EXPECT_TRUE(d.runs) << row.name << " " << condition.leaf;
        continue;
      }
      EXPECT_EQ(name(d.reason), name(condition.reason)) << row.name;
      const bool pauses = row.on_failure == OnFailure::pauses && condition.scope != Scope::terminal;
      EXPECT_EQ(d.mode->name, pauses ? row.name : "hold") << condition.leaf;
      EXPECT_TRUE(!d.runs || d.mode->name == "hold");
    }
}

// The leaf Mode decides for a mode as the tree that lists the mode's conditions, whatever holds.
TEST(Decider, ModeDecidesAsTheConditionsOneByOne) {
  const auto by_mode = load();
  const auto by_conditions =
      Decider::load_unchecked(source_folder() + "/tests/agent/robot_by_conditions.xml").value();
  std::mt19937_64 random(1);
  std::size_t compared = 0, runs = 0, pauses = 0;
  for (Time now{}; now < Time{Duration{250s}};) {
    Facts f;
    const auto holds = [&] { return random() % 8 != 0; };
    f.stopped = !holds();
    for (bool Facts::*fact :
         {&Facts::driver_alive, &Facts::localised, &Facts::terrain_fresh, &Facts::stick_fresh,
          &Facts::stick_present, &Facts::stick_centred, &Facts::goal_known, &Facts::goal_free,
          &Facts::program_fresh, &Facts::map_fresh})
      f.*fact = holds();
    for (const std::string_view fact : kAllGood.also)
      if (holds()) f.also.push_back(fact);
    if (!holds()) f.unlocalised = Reason::localisation_lost;
    now += 50ms;
    for (const ModeRow& row : ModeTable::shipped().rows()) {
      if (!by_conditions->installed(row)) continue;
      const Decision a = by_mode->decide(row.name, f, now), b = by_conditions->decide(row.name, f, now);
      EXPECT_EQ(a.mode, b.mode) << row.name;
      EXPECT_EQ(a.runs, b.runs) << row.name;
      EXPECT_EQ(name(a.reason), name(b.reason)) << row.name;
      ++compared;
      runs += b.runs && b.mode == &row;
      pauses += !b.runs;
    }
  }
  EXPECT_EQ(compared, 40'000U);
  EXPECT_GT(runs, 10'000U);
  EXPECT_GT(pauses, 3'000U);
}

TEST(Decider, UnknownRequestHolds) {
  const auto decider = load();
  EXPECT_EQ(decider->decide("fly", kAllGood, Time{}).mode->name, "hold");
}

TEST(Decider, MissingFileAndBrokenTreesAreErrors) {
  EXPECT_FALSE(Decider::load("/nowhere/robot.xml"));
  const auto with = [](const std::string& body) {
    return Decider::load_text("<root BTCPP_format=\"4\" main_tree_to_execute=\"T\"><BehaviorTree ID=\"T\">" +
                              body + "</BehaviorTree></root>");
  };
  EXPECT_FALSE(with("<Fallback><Fly/></Fallback>"));
  EXPECT_FALSE(with("<Fallback><Run/></Fallback>"));
}

TEST(Decider, RefusedTreeHoldsWithTheReason) {
  const auto decider = Decider::refused({Reason::cannot_read, "robot.xml: no such file"});
  EXPECT_EQ(decider->refusal(), "robot.xml: no such file");
  const Decision d = decider->decide("waypoint", kAllGood, Time{});
  EXPECT_EQ(d.mode->name, "hold");
  EXPECT_FALSE(d.runs);
  EXPECT_EQ(d.reason, Reason::tree_refused);
}

TEST(Decider, TreeThatFailsHolds) {
  const auto decider = Decider::load_unchecked(source_folder() + "/tests/rehearsal/hostile_trees/fails.xml");
  ASSERT_TRUE(decider) << decider.error().text;
  const Decision d = (*decider)->decide("manual", kAllGood, Time{});
  EXPECT_EQ(d.mode->name, "hold");
  EXPECT_FALSE(d.runs);
  EXPECT_EQ(d.reason, Reason::internal);
}

}  // namespace
}  // namespace adit::agent
