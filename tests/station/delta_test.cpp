// SPDX-License-Identifier: Apache-2.0
// Differences between worlds lead to the same world as a complete one.
#include "basestation/model/delta.hpp"

#include <gmock/gmock.h>

#include "basestation/model/json.hpp"
#include "core/time/random.hpp"

namespace adit::station {
namespace {

using nlohmann::json;

/// A fleet that changes a little with each step.
class Fiction {
 public:
  explicit Fiction(std::uint64_t seed) : random_(seed) {
    world_.station = "op1";
    world_.stations.push_back({.name = "op1", .self = true});
    for (int i = 1; i <= 5; ++i) join();
  }
  const World& step() {
    const double passed = 0.01 + random_.uniform();
    world_.at += passed;
    for (Robot& robot : world_.robots) robot.age += passed;
    for (auto& [agent, rate] : world_.traffic) rate.age += passed;
    for (std::size_t i = 1; i < world_.stations.size(); ++i) world_.stations[i].age += passed;
    const auto changes = static_cast<int>(random_.uniform() * 4.0);
    for (int i = 0; i < changes; ++i) change();
    return world_;
  }

 private:
  bool now_and_then(double share) { return random_.uniform() < share; }
  void join() {
    const std::string name = "r" + std::to_string(++robots_);
    Robot& robot = world_.robots.emplace_back();
    robot.name = name;
    robot.mode = "hold";
    std::ranges::sort(world_.robots, NaturalOrder{}, &Robot::name);
    world_.traffic[name] = {1.0, 2.0, 0.0};
  }
  void change() {
    if (now_and_then(0.05) && world_.robots.size() < 9) return join();
    Robot& robot =
        world_
            .robots[static_cast<std::size_t>(random_.uniform() * static_cast<double>(world_.robots.size()))];
    if (now_and_then(0.03) && world_.robots.size() > 2) {
      world_.traffic.erase(robot.name);
      std::erase_if(world_.robots, [name = robot.name](const Robot& one) { return one.name == name; });
      return;
    }
    if (now_and_then(0.6)) {  // A state was heard.
      robot.age = 0.01;
      robot.located = true;
      robot.x = static_cast<float>(random_.uniform());
      if (now_and_then(0.3)) robot.battery = static_cast<float>(random_.uniform());
    }
    if (now_and_then(0.2)) {
      robot.goal_state = now_and_then(0.5) ? GoalState::none : GoalState::active;
      robot.goal = {0.0, 0.0, 0.0};
      if (robot.goal_state != GoalState::none) robot.goal = {1.5, 2.5, std::nan("")};
    }
    if (now_and_then(0.2))
      robot.stops = now_and_then(0.5) ? std::vector<std::string>{} : std::vector<std::string>{"op2"};
    if (now_and_then(0.1)) robot.exploration.phase = ExplorationPhase::exploring;
    if (now_and_then(0.1)) robot.exploration = {};
    if (now_and_then(0.1)) world_.commands.accepted += 1;
    if (now_and_then(0.1)) world_.findings = {1, now_and_then(0.5) ? 1U : 0U, world_.findings.changes + 1};
    if (now_and_then(0.1)) {
      if (world_.stations.size() == 1)
        world_.stations.push_back({.name = "op2", .place = std::array{1.0F, 2.0F, 3.0F}});
      else if (now_and_then(0.3))
        world_.stations.pop_back();
      else
        world_.stations[1].age = 0.0;
    }
  }

  Random random_;
  World world_{};
  int robots_{};
};

void expect_same(const World& built, const World& world) {
  ASSERT_EQ(built.robots.size(), world.robots.size());
  for (std::size_t i = 0; i < world.robots.size(); ++i) {
    EXPECT_NEAR(built.robots[i].age, world.robots[i].age, 1e-2);
    Robot same_age = built.robots[i];
    same_age.age = world.robots[i].age;
    EXPECT_EQ(line_of(json_of(same_age)), line_of(json_of(world.robots[i])));
  }
  ASSERT_EQ(built.stations.size(), world.stations.size());
  for (std::size_t i = 0; i < world.stations.size(); ++i) {
    EXPECT_EQ(built.stations[i].name, world.stations[i].name);
    EXPECT_NEAR(built.stations[i].age, world.stations[i].age, 1e-2);
    EXPECT_EQ(built.stations[i].place, world.stations[i].place);
  }
  ASSERT_EQ(built.traffic.size(), world.traffic.size());
  EXPECT_EQ(built.commands, world.commands);
  EXPECT_EQ(built.findings, world.findings);
  EXPECT_EQ(built.at, world.at);
}

/// As it comes from the socket.
json sent(const json& value) { return json::parse(line_of(value)); }

TEST(Delta, LeadsToTheSameWorldWhicheverOnesAreLeftOut) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Fiction fiction(seed);
    Random random(seed + 1000);
    World world = fiction.step();
    WorldBuilder builder;
    ASSERT_TRUE(builder.start(sent(json_of(world))));
    EncodedWorld has = encoded(world);
    for (int i = 0; i < 60; ++i) {
      world = fiction.step();
      if (random.uniform() < 0.5) continue;  // The front end did not read yet.
      EncodedWorld now = encoded(world);
      ASSERT_TRUE(builder.apply(sent(difference(has, now).json)));
      has = std::move(now);
      expect_same(builder.world(), world);
      if (HasFailure()) return;
    }
  }
}

class DeltaTest : public testing::Test {
 protected:
  DeltaTest() {
    before_.robots.resize(2);
    Robot& robot = before_.robots[0];
    robot.name = "r1";
    robot.age = 0.2;
    robot.located = true;
    robot.mode = "hold";
    before_.robots[1].name = "r2";
  }
  Delta after(const World& now) { return difference(encoded(before_), encoded(now)); }
  World before_{.at = 10.0};
};

TEST_F(DeltaTest, TimeAloneIsNoDifference) {
  World now = before_;
  now.at += 5.0;
  for (Robot& robot : now.robots) robot.age += 5.0;
  const Delta delta = after(now);
  EXPECT_EQ(delta.urgency, Urgency::none);
  EXPECT_EQ(delta.json, json({{"at", 15.0}}));
  WorldBuilder builder;
  ASSERT_TRUE(builder.start(json_of(before_)));
  ASSERT_TRUE(builder.apply(delta.json));
  EXPECT_DOUBLE_EQ(builder.world().robots[0].age, 5.2) << "the age goes on";
}

TEST_F(DeltaTest, MotionIsLessUrgentThanWhatAnOperatorActsOn) {
  World now = before_;
  now.at += 0.1;
  now.robots[0].age = 0.0;
  now.robots[0].x = 3.0F;
  now.robots[1].age += 0.1;
  EXPECT_EQ(after(now).urgency, Urgency::motion);
  EXPECT_EQ(after(now).json["robots"].size(), 1U) << "only the robot that moved";
  EXPECT_FALSE(after(now).json["robots"]["r1"].contains("mode"));
  now.robots[0].stops = {"op2"};
  EXPECT_EQ(after(now).urgency, Urgency::change);
}

TEST_F(DeltaTest, RobotsAreInNaturalOrder) {
  WorldBuilder builder;
  before_.robots.emplace_back().name = "r10";
  ASSERT_TRUE(builder.start(json_of(before_)));
  World now = before_;
  now.robots.emplace_back().name = "r3";
  ASSERT_TRUE(builder.apply(after(now).json));
  std::vector<std::string> names;
  for (const Robot& robot : builder.world().robots) names.push_back(robot.name);
  EXPECT_THAT(names, testing::ElementsAre("r1", "r2", "r3", "r10"));
}

TEST_F(DeltaTest, AGoalOnTheGroundIsNotNewEachTime) {
  before_.robots[0].goal_state = GoalState::active;
  before_.robots[0].goal = {1.0, 2.0, std::nan("")};
  EXPECT_EQ(after(before_).urgency, Urgency::none);
}

TEST_F(DeltaTest, WhatDoesNotFitIsRefused) {
  WorldBuilder builder;
  ASSERT_TRUE(builder.start(json_of(before_)));
  for (const char* odd :
       {"5", "{}", R"({"at":"x"})", R"({"at":1,"robots":5})", R"({"at":1,"robots":{"r1":5}})",
        R"({"at":1,"robots":{"r1":{"pose":"x"}}})", R"({"at":1,"head":7})",
        R"({"at":1,"stations":{"op1":{"age":"x"}}})", R"({"at":1,"traffic":{"r1":{"out":true}}})"}) {
    WorldBuilder copy = builder;
    EXPECT_FALSE(copy.apply(json::parse(odd))) << odd;
  }
  EXPECT_FALSE(WorldBuilder().start(json(5)));
}

TEST_F(DeltaTest, TheNewestNoticesAreStored) {
  WorldBuilder builder;
  ASSERT_TRUE(builder.start(json_of(before_)));
  for (std::uint64_t i = 1; i <= 100; ++i) builder.add({{}, i, 1.0});
  EXPECT_EQ(builder.world().notices.size(), 30U);
  EXPECT_EQ(builder.world().notices.back().id, 100U);
  ASSERT_TRUE(builder.apply({{"at", 12.0}}));
  EXPECT_DOUBLE_EQ(builder.world().notices.back().age, 3.0);
}

}  // namespace
}  // namespace adit::station
