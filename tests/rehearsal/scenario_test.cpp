// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "sim/rehearsal/scenario_file.hpp"

namespace adit::sim {
namespace {

constexpr const char* kGood = R"(world: {boxes: [[0, 1, 5, 6, 0, 2]], floor: 0, ceiling: 3}
duration: 120
link: mesh_500k
lidar: planar
robots:
  - {id: r1, platform: wheeled, pose: [1, 0, 0]}
  - {id: r2, platform: legged, pose: [4, 0, 1.5]}
basestations:
  - {id: op1, pose: [0, 0]}
  - {id: op2, pose: [0, 1]}
script:
  - {at: 3, by: op1, do: goto r1 12 0.5}
  - {at: 2, by: op1, do: take r1}
faults:
  - {at: 20, crash: r1}
  - {at: 30, cut: [op1, r1], for: 10}
  - {at: 31, degrade: [op1, r1], loss: 0.3, for: 10}
  - {at: 32, forge: [op1, r1], for: 3}
expect:
  - {at: 10, robot: r1, mode: waypoint, holder: op1, locked: false, stopped: false}
  - {at: 12, by_operator: op2, refused: locked}   # told
  - {by: 60, robot: r1, near: [12, 0.5, 0.5]}
  - {always: no_collision}
  - {commands_at_least: 2}
)";

std::string with(const std::string& what, const std::string& instead) {
  std::string text = kGood;
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), instead);
}

TEST(Scenario, ReadsFindingsAndSafeguardsOfRobots) {
  std::string text = with("crash: r1", "finds: \"a rope\", robot: r2, importance: 7, photo: 40");
  const std::string robot = "pose: [4, 0, 1.5]";
  text.replace(text.find(robot), robot.size(), robot + ", on_link_loss: return, link_loss_after: 4");
  const std::string answer = "by_operator: op2, refused: locked";
  text.replace(text.find(answer), answer.size(), "by_operator: op2, findings: 3, photos: 1");
  const auto s = parse_scenario(text, "b.yaml");
  ASSERT_TRUE(s.ok()) << s.error().text;
  const auto& find = std::get<Find>(s->faults[0].what);
  EXPECT_EQ(find.kind, "a rope");
  EXPECT_EQ(find.robot, "r2");
  EXPECT_EQ(find.importance, 7);
  EXPECT_EQ(find.photo, 40);
  EXPECT_EQ(to_yaml(s->faults[0]), "{at: 20.000, finds: \"a rope\", robot: r2, importance: 7, photo: 40}");
  EXPECT_EQ(s->robots[0].settings.safeguards.link_loss.action, agent::OnLoss::go_on);
  EXPECT_EQ(s->robots[0].settings.safeguards.link_loss.after, Duration(10s));
  EXPECT_EQ(s->robots[1].settings.safeguards.link_loss.action, agent::OnLoss::back);
  EXPECT_EQ(s->robots[1].settings.safeguards.link_loss.after, Duration(4s));
  const auto& expected = std::get<FindingsExpectation>(s->expectations[1].what);
  EXPECT_EQ(expected.by, "op2");
  EXPECT_EQ(expected.findings, 3u);
  EXPECT_EQ(expected.photos, std::optional<std::size_t>(1));
}

TEST(Scenario, ReadsEveryKey) {
  const auto s = parse_scenario(kGood, "a/b.yaml");
  ASSERT_TRUE(s.ok()) << s.error().text;
  EXPECT_EQ(s->name, "b");
  EXPECT_EQ(s->duration, Duration(120s));
  EXPECT_DOUBLE_EQ(s->link.bandwidth, 500e3);
  EXPECT_EQ(s->lidar, LidarKind::planar);
  ASSERT_EQ(s->robots.size(), 2U);
  EXPECT_EQ(s->robots[1].platform, "legged");
  EXPECT_DOUBLE_EQ(s->robots[1].pose.yaw, 1.5);
  ASSERT_EQ(s->script.size(), 2U);
  EXPECT_EQ(s->script[0].command, "take r1") << "lines are sorted by time";
  ASSERT_EQ(s->faults.size(), 4U);
  EXPECT_EQ(std::get<DegradeLink>(s->faults[2].what).loss, 0.3);
  ASSERT_EQ(s->expectations.size(), 5U);
  EXPECT_EQ(std::get<AnswerExpectation>(s->expectations[1].what).refused, Reason::locked);
  EXPECT_EQ(s->expectations[1].text, "{at: 12, by_operator: op2, refused: locked}");
  EXPECT_EQ(s->expectations[1].line, 21);
}

TEST(Scenario, PlaceAndStateInOneExpectation) {
  const auto s = parse_scenario(with("near: [12, 0.5, 0.5]", "near: [12, 0.5, 0.5], mode: hold"), "b.yaml");
  ASSERT_TRUE(s.ok()) << s.error().text;
  const auto& state = std::get<StateExpectation>(s->expectations[2].what);
  EXPECT_EQ(state.mode, "hold");
  ASSERT_TRUE(state.near.has_value());
  EXPECT_DOUBLE_EQ(state.near->x, 12.0);
}

TEST(Scenario, PeopleYieldByDefault) {
  const auto s = parse_scenario(
      with("expect:",
           "people:\n  - {path: [[0, 1], [2, 1]]}\n  - {path: [[0, 1], [2, 1]], speed: 1.2, yields: "
           "false}\nexpect:"),
      "b.yaml");
  ASSERT_TRUE(s.ok()) << s.error().text;
  ASSERT_EQ(s->people.size(), 2u);
  EXPECT_TRUE(s->people[0].yields);
  EXPECT_EQ(s->people[0].speed, 1.5);
  EXPECT_FALSE(s->people[1].yields);
  EXPECT_EQ(s->people[1].speed, 1.2);
}

TEST(Scenario, AlwaysNoCollisionIsForAllOrForCausedContacts) {
  const auto all = parse_scenario(kGood, "b.yaml");
  const auto caused = parse_scenario(with("no_collision", "no_collision_caused"), "b.yaml");
  ASSERT_TRUE(all.ok() && caused.ok());
  EXPECT_FALSE(std::get<NoCollision>(all->expectations[3].what).caused);
  EXPECT_TRUE(std::get<NoCollision>(caused->expectations[3].what).caused);
}

TEST(Scenario, EveryModeThereIsMayBeExpected) {
  for (const char* mode :
       {"hold", "manual", "smart_joystick", "waypoint", "external", "explore", "convoy_follow", "get_out"}) {
    const auto s = parse_scenario(with("mode: waypoint", std::string("mode: ") + mode), "b.yaml");
    ASSERT_TRUE(s.ok()) << s.error().text;
    EXPECT_EQ(std::get<StateExpectation>(s->expectations[0].what).mode, mode);
  }
}

TEST(Scenario, YesAndNoAreTrueAndFalse) {
  const auto s = parse_scenario(with("locked: false, stopped: false", "locked: yes, stopped: no"), "b.yaml");
  ASSERT_TRUE(s.ok()) << s.error().text;
  const auto& state = std::get<StateExpectation>(s->expectations[0].what);
  EXPECT_EQ(state.locked, true);
  EXPECT_EQ(state.stopped, false);
}

TEST(Scenario, NoHolderMayBeWrittenInSeveralWays) {
  for (const char* nobody : {"nobody", "none", "\"\"", "null", "~"}) {
    const auto s = parse_scenario(with("holder: op1", std::string("holder: ") + nobody), "b.yaml");
    ASSERT_TRUE(s.ok()) << s.error().text;
    EXPECT_EQ(std::get<StateExpectation>(s->expectations[0].what).holder, "") << nobody;
  }
}

TEST(Scenario, RandomScriptAndOwnLink) {
  std::string text = with("link: mesh_500k", "link: {bandwidth: 1e6, latency: 0.02, loss: 0.2}");
  text += "random_script: {commands: 120, from: 5, to: 55, verbs: [take, stop]}\n";
  const auto s = parse_scenario(text, "b.yaml");
  ASSERT_TRUE(s.ok()) << s.error().text;
  EXPECT_DOUBLE_EQ(s->link.loss, 0.2);
  ASSERT_TRUE(s->random.has_value());
  EXPECT_EQ(s->random->robots, (std::vector<std::string>{"r1", "r2"}));
}

TEST(Scenario, EveryFaultIsWrittenAsItIsRead) {
  const std::vector<std::string> faults{
      "{at: 1.000, crash: r1}",
      "{at: 1.500, crash: op1}",
      "{at: 2.000, crash: r1/command}",
      "{at: 3.000, hang: r2/planner}",
      "{at: 4.000, cut: [op1, r1], for: 2.000}",
      "{at: 5.000, cut: [r1, op1], one_way: true, for: 2.000}",
      "{at: 6.000, degrade: [op1, r1], loss: 0.300, for: 2.000}",
      "{at: 6.500, degrade: [op1, r1], loss: 0.300, delay: 0.250, for: 2.000}",
      "{at: 7.000, partition: [[op1, r1], [r2]], for: 2.000}",
      "{at: 8.000, reorder: [op1, r1], chance: 0.500, by: 0.400, for: 2.000}",
      "{at: 9.000, duplicate: [op1, r1], chance: 0.500, for: 2.000}",
      "{at: 10.000, clock_jump: {op1: 3.000, r1: 0.250}}",
      "{at: 11.000, sensor_silent: r1, sensor: odometry, for: 2.000}",
      "{at: 11.500, sensor_silent: r1, sensor: lidar, for: 2.000}",
      "{at: 12.000, stuck: r1, for: 2.000}",
      "{at: 13.000, stuck: [op1, r1], for: 2.000}",
      "{at: 14.000, disk_full: r1, for: 2.000}",
      "{at: 15.000, forge: [op1, r1], for: 2.000}",
      "{at: 16.000, steers: r1, velocity: [0.500, 0.000, -0.250], for: 2.000}",
      "{at: 17.000, odometry_reset: r1}",
      "{at: 18.000, twin: r1, for: 2.000}",
      "{at: 19.000, slip: r1, wheels: [1.500, -0.250], for: 2.000}",
      "{at: 20.000, turn_slip: r1, share: 0.500, for: 2.000}",
      "{at: 21.000, driver_clock: r1, jump: 3600.000, sensor: lidar, for: 2.000}",
      "{at: 22.000, driver_clock: r2, jump: -10.000, sensor: odometry}",
      "{at: 23.000, driver_clock: r2, jump: 1600000000.000, sensor: lidar}",
      "{at: 24.000, no_stamp: r1, sensor: odometry, for: 2.000}",
      "{at: 24.500, no_stamp: r1, sensor: lidar}",
      "{at: 25.000, driver_restart: r1, origin: [1.000, -2.000, 3.000]}",
      "{at: 26.000, close: [1.000, 1.200, -0.500, 0.500, 0.000, 2.000], for: 2.000}"};
  std::string all;
  for (const std::string& fault : faults) all += "  - " + fault + "\n";
  const auto s = parse_scenario(with("  - {at: 20, crash: r1}\n", all), "b.yaml");
  ASSERT_TRUE(s.ok()) << s.error().text;
  for (std::size_t i = 0; i < faults.size(); ++i) EXPECT_EQ(to_yaml(s->faults[i]), faults[i]);
}

std::string swept(std::string text) { return text.replace(text.find("lidar: planar"), 13, "lidar: full"); }

TEST(Scenario, FaultsOfSweepsAreWrittenAsTheyAreRead) {
  const std::vector<std::string> faults{
      "{at: 1.000, lose_columns: r1, share: 0.010, time: zero, for: 2.000}",
      "{at: 2.000, lose_columns: r1, share: 0.010, time: nan, for: 2.000}",
      "{at: 3.000, lose_columns: r1, share: 0.500, time: wrapped, for: 2.000}",
      "{at: 4.000, lose_columns: r1, share: 1.000, time: kept, for: 2.000}",
      "{at: 5.000, cover: r2, for: 2.000}",
      "{at: 6.000, driver_clock: r2, jump: 1.000, sensor: imu}",
      "{at: 7.000, no_stamp: r2, sensor: imu}",
      "{at: 8.000, sensor_silent: r2, sensor: imu, for: 2.000}"};
  std::string all;
  for (const std::string& fault : faults) all += "  - " + fault + "\n";
  const auto s = parse_scenario(swept(with("  - {at: 20, crash: r1}\n", all)), "b.yaml");
  ASSERT_TRUE(s.ok()) << s.error().text;
  for (std::size_t i = 0; i < faults.size(); ++i) EXPECT_EQ(to_yaml(s->faults[i]), faults[i]);
}

TEST(Scenario, FaultsOfSweepsSayWhatIsExpected) {
  const std::array<std::pair<std::string, std::string>, 3> wrong{
      std::pair<std::string, std::string>{"share: 0.1, time: tea, for: 3", "wrapped"},
      {"share: 1.1, for: 3", "(0, 1]"},
      {"share: 0.1", "'for'"}};
  for (const auto& [rest, expected] : wrong) {
    const auto s = parse_scenario(swept(with("crash: r1", "lose_columns: r1, " + rest)), "b.yaml");
    ASSERT_FALSE(s.ok()) << rest;
    EXPECT_EQ(s.error().text.find("b.yaml:15: "), 0U) << s.error().text;
    EXPECT_NE(s.error().text.find(expected), std::string::npos) << s.error().text;
  }
}

TEST(Scenario, SensorsOfARobotTakeThePlaceOfItsPlatforms) {
  const std::string two =
      "pose: [1, 0, 0], sensors: {lidar: [{x: 0.5, y: 0, z: 0.4}, "
      "{x: -0.5, y: 0, z: 0.6, yaw: 3.1, topic: rear, frame: rear, rings: 8}], imu: {x: 0, y: 0, z: 0.1}}";
  const auto s = parse_scenario(swept(with("pose: [1, 0, 0]", two)), "b.yaml");
  ASSERT_TRUE(s.ok()) << s.error().text;
  const Platform& platform = s->robots[0].settings.platform;
  ASSERT_EQ(platform.all_lidars().size(), 2U);
  EXPECT_EQ(platform.lidar_height, 0.4);
  EXPECT_EQ(platform.all_lidars()[1].topic, "rear");
  EXPECT_EQ(platform.all_lidars()[1].rings, 8);
  EXPECT_TRUE(platform.imu.has_value());
  EXPECT_EQ(s->robots[1].settings.platform.all_lidars().size(), 1U);
  const auto wrong = parse_scenario(
      swept(with("pose: [1, 0, 0]", "pose: [1, 0, 0], sensors: {lidar: {x: 0.5, y: 0, z: -1}}")), "b.yaml");
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().text.find("b.yaml:6: "), 0U) << wrong.error().text;
  const auto planar = parse_scenario(with("pose: [1, 0, 0]", two), "b.yaml");
  ASSERT_FALSE(planar.ok());
  EXPECT_NE(planar.error().text.find("lidar: full"), std::string::npos) << planar.error().text;
}

TEST(Scenario, DustIsOfTheWorldAndNeedsSingleBeams) {
  const auto dusty = swept(with("ceiling: 3}", "ceiling: 3, dust: 0.05}"));
  EXPECT_EQ(parse_scenario(dusty, "b.yaml")->world.dust, 0.05);
  EXPECT_EQ(parse_scenario(swept(with("duration: 120", "dust: 0.2\nduration: 120")), "b.yaml")->world.dust,
            0.2);
  const auto twice = parse_scenario(dusty + "dust: 0.1\n", "b.yaml");
  ASSERT_FALSE(twice.ok());
  EXPECT_NE(twice.error().text.find("expected dust in one place"), std::string::npos) << twice.error().text;
}

struct Bad {
  const char* name;
  const char* what;
  const char* instead;
  int line;
  const char* message;  ///< A part of the message.
};

class BadScenario : public testing::TestWithParam<Bad> {};

TEST_P(BadScenario, NamesFileLineAndExpectedValue) {
  const Bad& bad = GetParam();
  const auto s = parse_scenario(with(bad.what, bad.instead), "bad.yaml");
  ASSERT_FALSE(s.ok());
  const std::string& text = s.error().text;
  EXPECT_EQ(text.find("bad.yaml:" + std::to_string(bad.line)), 0U) << text;
  EXPECT_NE(text.find(bad.message), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadScenario,
    testing::Values(
        Bad{"unknown_key", "duration: 120", "duration: 120\nweather: bad", 3, "weather"},
        Bad{"misspelt_key", "link: mesh_500k", "lnik: mesh_500k", 3, "link"},
        Bad{"unknown_key_in_robot", "pose: [1, 0, 0]}", "pose: [1, 0, 0], colour: red}", 6, "colour"},
        Bad{"unknown_key_in_script", "do: take r1}", "do: take r1, loud: yes}", 13, "loud"},
        Bad{"unknown_key_in_expect", "refused: locked}", "refused: locked, why: x}", 21, "why"},
        Bad{"duration_negative", "duration: 120", "duration: -1", 2, "(0, 86400]"},
        Bad{"duration_text", "duration: 120", "duration: long", 2, "number"},
        Bad{"duration_missing", "duration: 120", "", 1, "duration"},
        Bad{"no_world", "world: {boxes: [[0, 1, 5, 6, 0, 2]], floor: 0, ceiling: 3}", "world: {}", 1, "map"},
        Bad{"two_worlds", "world: {boxes:", "world: {map: geb079.bt, boxes:", 1, "one of map"},
        Bad{"missing_map", "world: {boxes: [[0, 1, 5, 6, 0, 2]], floor: 0, ceiling: 3}",
            "world: {map: nowhere.bt}", 1, "nowhere.bt"},
        Bad{"short_box", "[0, 1, 5, 6, 0, 2]", "[0, 1, 5, 6, 0]", 1, "6"},
        Bad{"box_inside_out", "[0, 1, 5, 6, 0, 2]", "[1, 0, 5, 6, 0, 2]", 1, "smaller"},
        Bad{"ceiling_below_floor", "ceiling: 3", "ceiling: -1", 1, "above the floor"},
        Bad{"unknown_link", "link: mesh_500k", "link: string_and_tins", 3, "string_and_tins"},
        Bad{"unknown_platform", "platform: wheeled", "platform: winged", 6,
            "there are: aerial, car, legged, tracked, wheeled"},
        Bad{"unknown_lidar", "lidar: planar", "lidar: round", 4, "planar"},
        Bad{"robot_without_pose", ", pose: [1, 0, 0]", "", 6, "pose"},
        Bad{"robot_twice", "id: r2", "id: r1", 7, "taken"},
        Bad{"robot_badly_named", "id: r2", "id: 'r 2'", 7, "letters"},
        Bad{"robot_named_all", "id: r2", "id: all", 7, "not 'all'"},
        Bad{"station_named_as_robot", "id: op1, pose: [0, 0]", "id: r1, pose: [0, 0]", 9, "taken"},
        Bad{"script_by_nobody", "by: op1, do: take r1", "by: op9, do: take r1", 13, "op9"},
        Bad{"script_unknown_robot", "do: take r1", "do: take r9", 13, "r9"},
        Bad{"script_unknown_verb", "do: take r1", "do: tak r1", 13, "take"},
        Bad{"script_after_the_end", "{at: 2,", "{at: 200,", 13, "120"},
        Bad{"fault_of_nothing", "crash: r1", "crash: r7", 15, "r7"},
        Bad{"fault_of_two_kinds", "crash: r1}", "crash: r1, hang: r2/nav}", 15, "one of"},
        Bad{"fault_in_no_component", "crash: r1", "crash: r1/horn", 15, "planner"},
        Bad{"fault_in_a_stations_component", "crash: r1", "crash: op1/planner", 15, "op1/planner"},
        Bad{"hang_of_a_whole_agent", "crash: r1", "hang: r1", 15, "ROBOT/COMPONENT"},
        Bad{"cut_from_itself", "cut: [op1, r1]", "cut: [r1, r1]", 16, "[A, B]"},
        Bad{"one_way_what", "cut: [op1, r1], for: 10", "cut: [op1, r1], one_way: 3, for: 10", 16, "true"},
        Bad{"delay_negative", "loss: 0.3, for: 10", "loss: 0.3, delay: -1, for: 10", 17, "[0, 10]"},
        Bad{"partition_of_one", "crash: r1", "partition: [[r1, op1]], for: 3", 15, "two groups"},
        Bad{"partition_with_one_in_two", "crash: r1", "partition: [[r1], [op1, r1]], for: 3", 15, "in two"},
        Bad{"partition_of_nobody", "crash: r1", "partition: [[], [op1]], for: 3", 15, "at least one"},
        Bad{"partition_of_strangers", "crash: r1", "partition: [[r1], [r9]], for: 3", 15, "r9"},
        Bad{"partition_for_ever", "crash: r1", "partition: [[r1], [op1]]", 15, "for"},
        Bad{"reorder_without_a_chance", "crash: r1", "reorder: [op1, r1], for: 3", 15, "chance"},
        Bad{"duplicate_above_one", "crash: r1", "duplicate: [op1, r1], chance: 2, for: 3", 15, "[0, 1]"},
        Bad{"clock_back", "crash: r1", "clock_jump: {r1: -3}", 15, "(0, 86400]"},
        Bad{"clock_of_nobody", "crash: r1", "clock_jump: {r9: 3}", 15, "r9"},
        Bad{"clock_of_none", "crash: r1", "clock_jump: {}", 15, "NAME: SECONDS"},
        Bad{"silent_nose", "crash: r1", "sensor_silent: r1, sensor: nose, for: 3", 15, "odometry"},
        Bad{"silent_station", "crash: r1", "sensor_silent: op1, for: 3", 15, "op1"},
        Bad{"stuck_station", "crash: r1", "stuck: op1, for: 3", 15, "op1"},
        Bad{"stuck_three", "crash: r1", "stuck: [op1, r1, r2], for: 3", 15, "[BASESTATION, ROBOT]"},
        Bad{"steers_nothing", "crash: r1", "steers: op1, velocity: [1, 0, 0], for: 3", 15, "op1"},
        Bad{"steers_nowhere", "crash: r1", "steers: r1, velocity: [1, 0], for: 3", 15, "3"},
        Bad{"twin_of_a_station", "crash: r1", "twin: op1, for: 3", 15, "op1"},
        Bad{"odometry_of_a_station", "crash: r1", "odometry_reset: op1", 15, "op1"},
        Bad{"slip_of_a_station", "crash: r1", "slip: op1, wheels: [1, 0], for: 3", 15, "op1"},
        Bad{"slip_of_one_number", "crash: r1", "slip: r1, wheels: [1], for: 3", 15, "2"},
        Bad{"slip_of_a_racer", "crash: r1", "slip: r1, wheels: [3, 0], for: 3", 15, "[-2, 2]"},
        Bad{"slip_for_ever", "crash: r1", "slip: r1, wheels: [1, 0]", 15, "for"},
        Bad{"slip_without_wheels", "crash: r1", "slip: r1, for: 3", 15, "wheels"},
        Bad{"turn_slip_of_more_than_all", "crash: r1", "turn_slip: r1, share: 1.5, for: 3", 15, "(0, 1]"},
        Bad{"turn_slip_of_nothing", "crash: r1", "turn_slip: r1, share: 0, for: 3", 15, "(0, 1]"},
        Bad{"driver_clock_too_far", "crash: r1", "driver_clock: r1, jump: 3e9", 15, "[-2e"},
        Bad{"driver_clock_by_nothing", "crash: r1", "driver_clock: r1, sensor: lidar", 15, "jump"},
        Bad{"driver_clock_of_a_nose", "crash: r1", "driver_clock: r1, jump: 1, sensor: nose", 15, "odometry"},
        Bad{"driver_clock_of_no_imu", "crash: r1", "driver_clock: r1, jump: 1, sensor: imu", 15,
            "lidar: full"},
        Bad{"driver_clock_in_a_station", "crash: r1", "driver_clock: op1, jump: 1", 15, "op1"},
        Bad{"no_stamp_of_no_imu", "crash: r1", "no_stamp: r1, sensor: imu", 15, "lidar: full"},
        Bad{"no_stamp_of_a_nose", "crash: r1", "no_stamp: r1, sensor: nose", 15, "odometry"},
        Bad{"restart_to_two_numbers", "crash: r1", "driver_restart: r1, origin: [1, 2]", 15, "3"},
        Bad{"restart_to_nowhere", "crash: r1", "driver_restart: r1", 15, "origin"},
        Bad{"restart_that_lasts", "crash: r1", "driver_restart: r1, origin: [1, 2, 3], for: 3", 15, "for"},
        Bad{"columns_of_a_planar_lidar", "crash: r1", "lose_columns: r1, share: 0.1, for: 3", 15,
            "lidar: full"},
        Bad{"close_of_five_numbers", "crash: r1", "close: [1, 2, 3, 4, 0], for: 3", 15, "6"},
        Bad{"close_turned_inside_out", "crash: r1", "close: [2, 1, 3, 4, 0, 2], for: 3", 15, "x0 < x1"},
        Bad{"close_for_ever", "crash: r1", "close: [1, 2, 3, 4, 0, 2]", 15, "for"},
        Bad{"cover_of_a_planar_lidar", "crash: r1", "cover: r1, for: 3", 15, "lidar: full"},
        Bad{"full_disk_of_a_station", "crash: r1", "disk_full: op1, for: 3", 15, "op1"},
        Bad{"find_by_nobody", "crash: r1", "finds: artifact", 15, "robot"},
        Bad{"find_by_a_station", "crash: r1", "finds: artifact, robot: op1", 15, "op1"},
        Bad{"find_of_nothing", "crash: r1", "finds: '', robot: r1", 15, "1 to 32"},
        Bad{"find_of_far_too_much", "crash: r1", "finds: 123456789012345678901234567890123, robot: r1", 15,
            "1 to 32"},
        Bad{"find_with_a_huge_photo", "crash: r1", "finds: gas, robot: r1, photo: 257", 15, "256"},
        Bad{"find_with_a_negative_photo", "crash: r1", "finds: gas, robot: r1, photo: -1", 15, "256"},
        Bad{"photos_negative", "by_operator: op2, refused: locked",
            "by_operator: op2, findings: 1, photos: -1", 21, "65536"},
        Bad{"photos_of_no_number", "by_operator: op2, refused: locked",
            "by_operator: op2, findings: 1, photos: all", 21, "photos"},
        Bad{"find_beyond_importance", "crash: r1", "finds: gas, robot: r1, importance: 256", 15, "255"},
        Bad{"on_link_loss", "pose: [1, 0, 0]", "pose: [1, 0, 0], on_link_loss: cry", 6, "continue"},
        Bad{"link_loss_after", "pose: [1, 0, 0]", "pose: [1, 0, 0], link_loss_after: 0", 6, "3600"},
        Bad{"findings_of_nobody", "by_operator: op2, refused: locked", "by_operator: op9, findings: 1", 21,
            "op9"},
        Bad{"findings_negative", "by_operator: op2, refused: locked", "by_operator: op2, findings: -1", 21,
            "65536"},
        Bad{"random_finds", "duration: 120",
            "random_faults: {faults: 3, finds: -1, from: 0, to: 9}\nduration: 120", 2, "1000"},
        Bad{"seed_negative", "duration: 120", "seed: -1\nduration: 120", 2, "0"},
        Bad{"random_faults_unknown", "duration: 120",
            "random_faults: {faults: 3, from: 0, to: 9, kinds: [rain]}\nduration: 120", 2, "clock_jump"},
        Bad{"random_faults_backwards", "duration: 120",
            "random_faults: {faults: 3, from: 9, to: 0}\nduration: 120", 2, "from before to"},
        Bad{"cut_of_one", "cut: [op1, r1]", "cut: [op1]", 16, "[A, B]"},
        Bad{"cut_for_ever", "cut: [op1, r1], for: 10", "cut: [op1, r1]", 16, "for"},
        Bad{"loss_above_one", "loss: 0.3", "loss: 1.3", 17, "[0, 1]"},
        Bad{"expect_unknown_mode", "mode: waypoint", "mode: dance", 20, "waypoint"},
        Bad{"expect_unknown_reason", "refused: locked", "refused: tired", 21, "reason"},
        Bad{"expect_nothing", "mode: waypoint, holder: op1, locked: false, stopped: false", "", 20,
            "expected near"},
        Bad{"expect_no_time", "{at: 12, by_operator", "{by_operator", 21, "one of at"},
        Bad{"near_without_tolerance", "[12, 0.5, 0.5]", "[12, 0.5]", 22, "3"},
        Bad{"explored_too_much", "{always: no_collision}", "{by: 9, explored_at_least: 1.2}", 23, "[0, 1]"},
        Bad{"inside_without_area", "{always: no_collision}", "{always: inside}", 23, "area"},
        Bad{"inside_turned", "{always: no_collision}", "{always: outside, area: [9, 0, 1, 5]}", 23,
            "x0 < x1"},
        Bad{"inside_of_nobody", "{always: no_collision}",
            "{always: inside, area: [0, 0, 1, 5], robots: [r9]}", 23, "r9"},
        Bad{"explored_turned", "{always: no_collision}", "{by: 9, explored_at_least: 1, area: [9, 0, 1, 5]}",
            23, "x0 < x1"},
        Bad{"explored_by_whom", "{always: no_collision}", "{by: 9, explored_at_least: 1, robots: [r9]}", 23,
            "r9"},
        Bad{"map_of_nobody", "{always: no_collision}", "{by: 9, by_operator: op9, map_at_least: 0.9}", 23,
            "op9"},
        Bad{"map_too_right", "{always: no_collision}", "{by: 9, by_operator: op1, map_wrong_at_most: 2}", 23,
            "[0, 1]"},
        Bad{"pose_without_limit", "{always: no_collision}", "{always: pose_within}", 23, "m"},
        Bad{"dust_before_a_planar_lidar", "ceiling: 3}", "ceiling: 3, dust: 0.1}", 1, "lidar: full"},
        Bad{"world_of_dust", "ceiling: 3}", "ceiling: 3, dust: 0.6}", 1, "[0, 0.5]"},
        Bad{"dust_of_half", "duration: 120", "dust: 0.6\nduration: 120", 2, "[0, 0.5]"},
        Bad{"always_what", "no_collision", "happy", 23, "no_collision"},
        Bad{"no_yaml", "robots:", "robots: [", 6, ""}),
    [](const auto& bad_case) { return std::string(bad_case.param.name); });

TEST(Scenario, FileThatIsNotThere) {
  const auto s = load_scenario("/nowhere/at/all.yaml");
  ASSERT_FALSE(s.ok());
  EXPECT_EQ(s.error().reason, Reason::cannot_read);
  EXPECT_NE(s.error().text.find("/nowhere/at/all.yaml"), std::string::npos);
}

}  // namespace
}  // namespace adit::sim
