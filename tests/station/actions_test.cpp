// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/action.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "adit/authority.h"
#include "adit/robot.h"
#include "basestation/report/json.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;

constexpr Id kAskingId{1};

/// A fleet of one robot, fed with its authority and modes.
class Actions : public testing::Test {
 protected:
  Actions() { behave("r1", Reason::none); }

  void behave(const std::string& robot, Reason waypoint, const std::string& mode = "hold") {
    radio::BehaviourState sample;
    sample.robot(robot);
    sample.mode(mode);
    const auto option = [&](const char* option_name, Reason reason) {
      radio::ModeOption row;
      row.mode(option_name);
      row.available(reason == Reason::none);
      row.reason(static_cast<std::uint16_t>(reason));
      sample.modes().push_back(row);
    };
    option("hold", Reason::none);
    option("manual", Reason::joystick_stale);
    option("smart_joystick", Reason::terrain_stale);
    option("waypoint", waypoint);
    fleet_.hear(sample, {.received = Time(1s)});
  }

  void own(const std::string& robot, const std::string& holder, Id id, bool locked = false,
           const std::vector<std::string>& stops = {}) {
    radio::AuthorityStatus sample;
    sample.robot(robot);
    sample.holder(holder);
    sample.holder_id(id);
    sample.locked(locked);
    for (const std::string& stop : stops) {
      radio::Stopper row;
      row.station(stop);
      row.station_id(stop == "op1" ? kAskingId : Id{2});
      sample.stops().push_back(row);
    }
    fleet_.hear(sample, {.received = Time(1s)});
  }

  Action action(const std::string& command, const std::vector<std::string>& robots = {"r1"}) {
    std::vector<const Robot*> selection;
    for (const std::string& robot : robots) selection.push_back(fleet_.robot(robot));
    for (const Action& row : actions(selection))
      if (row.command == command) return row;
    ADD_FAILURE() << "no row " << command;
    return {};
  }

  Fleet fleet_{"op1", kAskingId};
};

TEST_F(Actions, OfAFreeRobotOnlyTakeAndStopAreValid) {
  own("r1", "", {});
  EXPECT_TRUE(action("take").valid);
  EXPECT_TRUE(action("stop").valid);
  for (const char* command : {"release", "lock", "unlock", "grant", "mode hold", "drive", "goto", "teleop",
                              "reset", "restart", "policy"})
    EXPECT_EQ(action(command).reason, Reason::nobody_holds) << command;
}

TEST_F(Actions, LockedByAnother) {
  own("r1", "op2", {2}, true);
  EXPECT_EQ(action("take").reason, Reason::locked);
  EXPECT_THAT(action("take").text, testing::HasSubstr("op2"));
  EXPECT_EQ(action("goto").reason, Reason::not_holder);
  own("r1", "op2", {2}, false);
  EXPECT_TRUE(action("take").valid);
}

TEST_F(Actions, TheHoldersNameWithAnotherIdIsNotTheHolder) {
  own("r1", "op1", {5});
  EXPECT_EQ(action("release").reason, Reason::not_holder);
}

TEST_F(Actions, TheHolderSeesTheReasonsOfTheModes) {
  own("r1", "op1", kAskingId);
  EXPECT_TRUE(action("release").valid);
  EXPECT_TRUE(action("mode hold").valid);
  EXPECT_TRUE(action("mode manual").valid) << "the station brings the stick";
  EXPECT_TRUE(action("drive").valid);
  EXPECT_EQ(action("mode smart_joystick").reason, Reason::terrain_stale);
  behave("r1", Reason::none, "smart_joystick");
  EXPECT_EQ(action("drive").reason, Reason::terrain_stale);
}

TEST_F(Actions, GotoBringsItsOwnGoal) {
  own("r1", "op1", kAskingId);
  behave("r1", Reason::goal_missing);
  EXPECT_EQ(action("mode waypoint").reason, Reason::goal_missing);
  EXPECT_TRUE(action("goto").valid);
  behave("r1", Reason::stopped);
  EXPECT_EQ(action("goto").reason, Reason::stopped);
}

TEST_F(Actions, ResetDependsOnWhoStopped) {
  own("r1", "op1", kAskingId);
  EXPECT_TRUE(action("reset").valid);
  own("r1", "op1", kAskingId, false, {"op1", "op2"});
  EXPECT_TRUE(action("reset").valid);
  own("r1", "op1", kAskingId, false, {"op2"});
  EXPECT_EQ(action("reset").reason, Reason::stop_of_another);
}

TEST_F(Actions, ALostRobotCanOnlyBeStopped) {
  own("r1", "op1", kAskingId);
  fleet_.check(Time(60s));
  EXPECT_TRUE(action("stop").valid);
  EXPECT_EQ(action("take").reason, Reason::no_answer);
  EXPECT_EQ(action("goto").reason, Reason::no_answer);
}

TEST_F(Actions, OfASelectionEachRobotMustAccept) {
  own("r1", "op1", kAskingId);
  behave("r2", Reason::none);
  own("r2", "op2", {2});
  EXPECT_TRUE(action("take", {"r1", "r2"}).valid);
  EXPECT_FALSE(action("goto", {"r1", "r2"}).valid);
  EXPECT_EQ(action("goto", {"r1", "r2"}).robot, "r2");
}

TEST_F(Actions, HomeAsksForWaypointAndPoseForHold) {
  own("r1", "op1", kAskingId);
  behave("r1", Reason::goal_missing);
  EXPECT_TRUE(action("home").valid);
  EXPECT_TRUE(action("pose").valid);
  behave("r1", Reason::none, "waypoint");
  EXPECT_TRUE(action("home").valid);
  EXPECT_EQ(action("pose").reason, Reason::wrong_mode);
}

TEST_F(Actions, SayWhatACommandTakesAndHowDangerousItIs) {
  own("r1", "op1", kAskingId);
  const RobotView* robot = fleet_.robot("r1");
  const nlohmann::json rows = actions_json(actions({robot}));
  const auto row = [&](const char* id) -> const nlohmann::json& {
    return *std::ranges::find_if(rows, [&](const nlohmann::json& any) { return any["id"] == id; });
  };
  const nlohmann::json &grant = row("grant"), &go_to = row("goto"), &stop = row("stop"),
                       &waypoint = row("mode_waypoint");
  EXPECT_EQ(grant["id"], "grant");
  EXPECT_EQ(grant["label"], "Grant");
  EXPECT_EQ(go_to["id"], "goto");
  EXPECT_EQ(go_to["label"], "Go to");
  EXPECT_EQ(waypoint["id"], "mode_waypoint");
  EXPECT_EQ(waypoint["label"], "Waypoint");
  EXPECT_TRUE(waypoint["arguments"].empty()) << "its mode is chosen";
  EXPECT_EQ(go_to["arguments"][0]["minimum"], -1e4);
  EXPECT_EQ(go_to["arguments"][0]["maximum"], 1e4);
  EXPECT_EQ(grant["danger"], "high");
  EXPECT_EQ(grant["robots_max"], 1);
  EXPECT_EQ(grant["arguments"][0]["name"], "OPERATOR");
  EXPECT_EQ(go_to["danger"], "some");
  EXPECT_EQ(go_to["arguments"].size(), 3U);
  EXPECT_EQ(go_to["arguments"][0]["unit"], "m");
  EXPECT_EQ(go_to["arguments"][2]["least"], 0);
  EXPECT_EQ(go_to["options"][0]["name"], "--wait");
  EXPECT_EQ(stop["danger"], "none");
  EXPECT_EQ(stop["robots_max"], 64);
  EXPECT_EQ(stop["robots_min"], 1);
  EXPECT_TRUE(stop["all_robots"]);
  EXPECT_FALSE(waypoint["all_robots"]) << "`mode all waypoint` is refused";
  EXPECT_TRUE(row("mode_hold")["all_robots"]);
  EXPECT_FALSE(row("yield")["all_robots"]) << "`yield all on` is refused";
  EXPECT_EQ(row("yield")["all_only"], "off");
}

}  // namespace
}  // namespace adit::station
