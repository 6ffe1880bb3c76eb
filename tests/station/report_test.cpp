// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "adit/discovery.h"
#include "adit/link.h"
#include "adit/robot.h"
#include "basestation/model/json.hpp"
#include "basestation/report/json.hpp"
#include "basestation/report/table.hpp"
#include "basestation/report/text.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

TEST(Table, AlignsTextLeftAndNumbersRight) {
  EXPECT_EQ(table({{"NAME", "N"}, {"a", "1"}, {"long_name", "10.5"}}),
            "NAME          N\n"
            "a             1\n"
            "long_name  10.5\n");
}

TEST(Table, AColumnWithoutAnyNumberIsText) {
  EXPECT_EQ(table({{"HOLDER", "N"}, {"-", "-"}, {"-", "1"}}),
            "HOLDER  N\n"
            "-       -\n"
            "-       1\n");
}

TEST(Table, NumbersWithoutNegativeZero) {
  EXPECT_EQ(fixed(-0.001, 2), "0.00");
  EXPECT_EQ(fixed(-0.01, 2), "-0.01");
  EXPECT_EQ(fixed(std::nan(""), 2), "-");
}

nlohmann::json net_json(const Fleet& fleet, Time now) { return json_of(network_report(fleet, now)); }

radio::Capabilities described() {
  radio::Capabilities sample;
  sample.name("r1");
  sample.kind(radio::AGENT_ROBOT);
  sample.platform("tracked");
  sample.length(0.9F);
  sample.width(0.6F);
  sample.height(0.5F);
  sample.max_speed(1.2F);
  sample.max_turn(1.0F);
  sample.max_acceleration(0.8F);
  sample.step(0.25F);
  sample.slope(0.7854F);
  sample.stairs(true);
  return sample;
}

TEST(Report, StatusSaysHowLargeARobotIsAndWhatItClimbs) {
  Fleet fleet("op1", {1});
  fleet.hear(described(), {.received = Time(1s)});
  const std::string text = status_text(fleet, *fleet.robot("r1"), Time(1s));
  EXPECT_THAT(text, HasSubstr("0.90 x 0.60 x 0.50 m"));
  EXPECT_THAT(text, HasSubstr("1.2 m/s, 1.0 rad/s, 0.8 m/s2, steps of 0.25 m, slopes of 45 degrees, "
                              "climbs stairs"));
  const auto json = json_of(described(*fleet.robot("r1"), Time(1s)));
  EXPECT_FLOAT_EQ(json["size"]["length"].get<float>(), 0.9F);
  EXPECT_FLOAT_EQ(json["size"]["width"].get<float>(), 0.6F);
  EXPECT_FLOAT_EQ(json["size"]["height"].get<float>(), 0.5F);
  EXPECT_FLOAT_EQ(json["max_step"].get<float>(), 0.25F);
  EXPECT_FLOAT_EQ(json["max_slope"].get<float>(), 0.7854F);
  EXPECT_FLOAT_EQ(json["max_acceleration"].get<float>(), 0.8F);
  EXPECT_TRUE(json["climbs_stairs"].get<bool>());
}

TEST(Report, StatusNamesTheAreasOfARobotAndNoMalformedOnes) {
  Fleet fleet("op1", {1});
  radio::BehaviourState sample;
  sample.robot("r1");
  const auto add = [&](const std::string& name, std::vector<float> corners, int kind, float z_min) {
    radio::Area area;
    area.name(name);
    area.kind(static_cast<radio::AreaKind>(kind));
    area.z_min(z_min);
    area.z_max(std::numeric_limits<float>::infinity());
    area.weight(2.5F);
    area.corners(std::move(corners));
    sample.areas().push_back(area);
  };
  const std::vector<float> triangle{0, 0, 4, 0, 4, 4.25F};
  const float anywhere = -std::numeric_limits<float>::infinity(), no_number = std::nanf("");
  add("shaft", triangle, 1, anywhere);
  add("hall", triangle, 2, 1.0F);
  add("no name\n", triangle, 1, anywhere);
  add("no_kind", triangle, 7, anywhere);
  add("no_corners", {0, 0, 1}, 1, anywhere);
  add("no_number", {0, 0, 4, no_number, 4, 4}, 1, anywhere);
  add("no_height", triangle, 1, no_number);
  fleet.hear(sample, {.received = Time(1s)});
  const std::string text = status_text(fleet, *fleet.robot("r1"), Time(1s));
  EXPECT_THAT(text, HasSubstr("  area     shaft keep_out, 0.0 0.0, 4.0 0.0, 4.0 4.2\n"));
  EXPECT_THAT(text, HasSubstr("  area     hall prefer weight 2.5, 0.0 0.0, 4.0 0.0, 4.0 4.2, from z 1.0\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("no_")));
  const auto json = json_of(described(*fleet.robot("r1"), Time(1s)));
  ASSERT_EQ(json["areas"].size(), 2U);
  EXPECT_EQ(json["areas"][0]["kind"], "keep_out");
  EXPECT_EQ(json["areas"][0]["corners"][1][0], 4.0);
  EXPECT_FALSE(json["areas"][0].contains("z_min"));
  EXPECT_EQ(json["areas"][1]["z_min"], 1.0);
}

TEST(Report, StatusSaysThatTheStationBringsTheStick) {
  Fleet fleet("op1", {1});
  radio::BehaviourState sample;
  sample.robot("r1");
  sample.mode("hold");
  for (const auto& [mode, reason] :
       {std::pair{"manual", Reason::joystick_stale}, std::pair{"waypoint", Reason::goal_missing}}) {
    radio::ModeOption row;
    row.mode(mode);
    row.reason(static_cast<std::uint16_t>(reason));
    sample.modes().push_back(row);
  }
  fleet.hear(sample, {.received = Time(1s)});
  const std::string text = status_text(fleet, *fleet.robot("r1"), Time(1s));
  EXPECT_THAT(text, HasSubstr("mode manual          possible\n"));
  EXPECT_THAT(text, HasSubstr("mode waypoint        not now: there is no goal"));
}

TEST(Report, StatusShowsTheNewestNoticesOfTheRobot) {
  Fleet fleet("op1", {1});
  radio::BehaviourState sample;
  sample.robot("r1");
  fleet.hear(sample, {.received = Time(1s)});
  EXPECT_THAT(status_text(fleet, *fleet.robot("r1"), Time(1s)), testing::Not(HasSubstr("notices")));
  for (int n = 1; n <= 7; ++n) fleet.say({.text = "event " + std::to_string(n), .robot = "r1"}, Time(n * 1s));
  fleet.say({.text = "of another robot", .robot = "r2"}, Time(8s));
  const std::string text = status_text(fleet, *fleet.robot("r1"), Time(10s));
  EXPECT_THAT(text, HasSubstr("  notices  3 s ago: event 7\n           4 s ago: event 6\n"));
  EXPECT_THAT(text, HasSubstr("7 s ago: event 3\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("event 2")));
  EXPECT_THAT(text, testing::Not(HasSubstr("of another robot")));
  const auto json = notices_json(fleet, "r1", Time(10s));
  ASSERT_EQ(json.size(), 7u);
  EXPECT_EQ(json.back()["text"], "event 7");
  EXPECT_EQ(notices_json(fleet, "", Time(10s)).size(), 8u);
}

TEST(Report, AModeIsAvailableWhereTheStationWouldEnterIt) {
  RobotView robot;
  robot.options = {{.mode = "manual", .reason = Reason::joystick_stale},
                   {.mode = "smart_joystick", .reason = Reason::stopped},
                   {.mode = "waypoint", .reason = Reason::goal_missing}};
  const auto modes = json_of(described(robot, Time(1s)))["modes"];
  EXPECT_EQ(modes[0]["available"], true) << "the station adds the stick, as its text says";
  EXPECT_EQ(modes[0]["reason"], "none");
  EXPECT_EQ(modes[1]["available"], false);
  EXPECT_EQ(modes[1]["reason"], "stopped");
  EXPECT_EQ(modes[2]["available"], false);
}

TEST(Report, HealthOfSeveralRobotsIsOneTable) {
  RobotView first, second, silent;
  first.name = "r1";
  second.name = "r2";
  silent.name = "r3";
  first.components = second.components = {{.name = "planner", .state = PartState::up, .text = {}}};
  const std::string text = health_text(health_report({&first, &second, &silent}));
  EXPECT_EQ(text.find("COMPONENT"), text.rfind("COMPONENT"));
  EXPECT_THAT(text, HasSubstr("r2     planner"));
  EXPECT_THAT(text, HasSubstr("r3: no health report has been heard\n"));
}

TEST(Report, HealthMarksWhatCannotBeRestarted) {
  RobotView robot;
  robot.name = "r1";
  const auto part = [](const char* name) {
    return ComponentHealth{.name = name, .state = PartState::up, .automatic = true, .text = {}};
  };
  robot.components = {part("planner")};
  EXPECT_THAT(health_text(health_report({&robot})), testing::Not(HasSubstr("no component")));
  robot.components = {part("planner"), part("driver"), part("store")};
  const std::string text = health_text(health_report({&robot}));
  EXPECT_THAT(text, testing::ContainsRegex("planner +up +auto"));
  EXPECT_THAT(text, testing::ContainsRegex("driver +up +- "));
  EXPECT_THAT(text, testing::ContainsRegex("store +up +- "));
  EXPECT_THAT(text, HasSubstr("no component of the agent; restart and policy do not take it"));
  EXPECT_EQ(json_of(health_report({&robot}))["robots"][0]["components"][0]["can_restart"], true);
  EXPECT_EQ(json_of(health_report({&robot}))["robots"][0]["components"][2]["can_restart"], false);
}

TEST(Report, AmountsThatARobotCannotMeanAreNotKnown) {
  Fleet fleet("op1", {1});
  radio::Capabilities sample = described();
  sample.length(std::nanf(""));
  sample.width(-1.0F);
  sample.step(INFINITY);
  sample.slope(std::nanf(""));
  fleet.hear(sample, {.received = Time(1s)});
  const auto json = json_of(described(*fleet.robot("r1"), Time(1s)));
  EXPECT_TRUE(json["size"]["length"].is_null());
  EXPECT_TRUE(json["size"]["width"].is_null());
  EXPECT_EQ(json["max_step"], 0.0);
  EXPECT_TRUE(json["max_slope"].is_null());
  EXPECT_THAT(status_text(fleet, *fleet.robot("r1"), Time(1s)), HasSubstr("size     -\n"));
}

TEST(Report, ListSaysWhereStationsStand) {
  Fleet fleet("op1", {1});
  fleet.stand_at({1.0F, -2.0F, 0.5F});
  radio::Capabilities sample;
  sample.name("op2");
  sample.kind(radio::AGENT_STATION);
  sample.id({2});
  sample.placed(true);
  sample.place({30.0F, 4.0F, 0.0F});
  fleet.hear(sample, {.received = Time(1s)});
  radio::Presence presence;
  presence.name("op2");
  presence.kind(radio::AGENT_STATION);
  presence.id({2});
  fleet.hear(presence, {.received = Time(2s)});
  EXPECT_THAT(list_text(fleet, Time(2s)), HasSubstr("op1 (this one) at 1.0 -2.0 0.5, op2 at 30.0 4.0 0.0\n"));
  const auto stations = list_json(fleet, Time(2s))["stations"];
  EXPECT_EQ(stations[0]["place"], (std::array{1.0F, -2.0F, 0.5F}));
  EXPECT_EQ(stations[1]["place"], (std::array{30.0F, 4.0F, 0.0F}));

  sample.place({std::nanf(""), 0.0F, 0.0F});  // no place
  fleet.hear(sample, {.received = Time(3s)});
  EXPECT_FALSE(fleet.stations().at("op2").place);
  sample.place({30.0F, 4.0F, 0.0F});
  fleet.hear(sample, {.received = Time(4s)});
  presence.id({3});  // another station of that name
  fleet.hear(presence, {.received = Time(5s)});
  EXPECT_FALSE(fleet.stations().at("op2").place);
}

TEST(Report, ListSaysWhoIsThere) {
  Fleet fleet("op1", {1});
  EXPECT_THAT(list_text(fleet, Time(1s)), HasSubstr("no robot has been heard"));
  radio::RobotState state;
  state.robot("r1");
  state.x(3.25F);
  fleet.hear(state, {.received = Time(1s)});
  EXPECT_THAT(list_text(fleet, Time(2s)), HasSubstr("r1"));
  EXPECT_THAT(list_text(fleet, Time(2s)), HasSubstr("op1 (this one)"));
  const auto json = list_json(fleet, Time(2s));
  EXPECT_EQ(json["robots"][0]["robot"], "r1");
  EXPECT_FLOAT_EQ(json["robots"][0]["pose"][0].get<float>(), 3.25F);
  EXPECT_FALSE(json["robots"][0]["lost"].get<bool>());
}

TEST(Report, NetShowsDiscoveryApartAndTheShareOfTheLink) {
  Fleet fleet("op1", {1});
  radio::LinkReport report;
  report.agent("r1");
  report.total_out(625.0F);
  report.discovery_out(125.0F);
  radio::TopicTraffic row;
  row.topic("adit/robot_state");
  row.bytes_out(500.0F);
  report.topics().push_back(row);
  fleet.hear(report, {.received = Time(1s)});
  const std::string text =
      net_text(network_report(fleet, Time(2s)), {.link = "mesh_100k", .bandwidth = 100e3});
  EXPECT_THAT(text, HasSubstr("adit/robot_state"));
  EXPECT_THAT(text, HasSubstr("discovery"));
  EXPECT_THAT(text, HasSubstr("5.0 % of mesh_100k"));
  EXPECT_EQ(net_json(fleet, Time(2s))["agents"][0]["topics"][0]["topic"], "adit/robot_state");
  const auto classes = net_json(fleet, Time(2s))["agents"][0]["classes_out"];
  EXPECT_EQ(classes["state"], 500.0);
  EXPECT_EQ(classes["discovery"], 125.0);
}

TEST(Report, NetShowsWhatTheLinkToEachRobotGives) {
  Fleet fleet("op1", {1});
  radio::Presence robot;
  robot.name("r1");
  robot.kind(radio::AGENT_ROBOT);
  for (const std::uint32_t seq : {1, 2, 4}) {
    robot.seq(seq);
    fleet.hear(robot, {.received = Time(seq * 1s)});
  }
  fleet.said_present(9, Time(3s));
  radio::LinkReport report;
  report.agent("r1");
  radio::PeerLink peer;
  peer.peer("op1");
  peer.number(9);
  peer.held(0.7F);
  peer.lost(0.5F);
  report.peers().push_back(peer);
  radio::PeerLink other;
  other.peer("op2");
  other.lost(0.25F);
  report.peers().push_back(other);
  other.peer("no name\n");
  report.peers().push_back(other);
  fleet.hear(report, {.received = Time(4s)});
  const auto link = net_json(fleet, Time(5s))["links"][0];
  EXPECT_EQ(link["agent"], "r1");
  EXPECT_NEAR(link["lost_from"].get<double>(), 0.25, 1e-6);
  EXPECT_NEAR(link["lost_to"].get<double>(), 0.5, 1e-6);
  EXPECT_NEAR(link["round_trip"].get<double>(), 0.3, 1e-6);
  EXPECT_EQ(net_json(fleet, Time(5s))["agents"][0]["hears"], (nlohmann::json{{"op1", 0.5}, {"op2", 0.25}}));
  EXPECT_THAT(net_text(network_report(fleet, Time(5s)), {}), HasSubstr("ROUND TRIP MS"));
  peer.held(std::nanf(""));
  peer.lost(std::nanf(""));
  report.peers() = {peer};
  fleet.hear(report, {.received = Time(5s)});
  EXPECT_TRUE(net_json(fleet, Time(5s))["links"][0]["lost_to"].is_null());
  EXPECT_TRUE(net_json(fleet, Time(5s))["agents"][0]["hears"].empty());
}

wire::PeerState carried(std::uint64_t out, std::uint64_t in, std::optional<double> signal = {}) {
  return {.peer = {7}, .bytes_out = out, .bytes_in = in, .signal = signal};
}

TEST(Report, NetShowsThroughputQueueSignalAndProfile) {
  Fleet fleet("op1", {1});
  radio::RobotState state;
  state.robot("r1");
  fleet.hear(state, {.sender = {7}, .received = Time(1s)});
  radio::Presence robot;
  robot.name("r1");
  robot.kind(radio::AGENT_ROBOT);
  robot.seq(1);
  fleet.hear(robot, {.sender = {7}, .received = Time(1s)});
  auto link = net_json(fleet, Time(1s))["links"][0];
  for (const char* unknown : {"bytes_from", "bytes_to", "signal", "sender"})
    EXPECT_TRUE(link[unknown].is_null()) << unknown;

  radio::LinkReport report;
  report.agent("r1");
  report.link("mesh_100k");
  report.bandwidth(100e3F);
  report.queue(0.25F);
  report.dropped()[3] = 12;
  report.state_rate(2.5F);
  fleet.hear(report, {.received = Time(2s)});
  fleet.carried({carried(100, 1000)}, Time(2s));
  EXPECT_TRUE(net_json(fleet, Time(2s))["links"][0]["bytes_to"].is_null());  // no time to take it over yet
  fleet.carried({carried(300, 5000, -71.0)}, Time(4s));
  link = net_json(fleet, Time(4s))["links"][0];
  EXPECT_NEAR(link["bytes_to"].get<double>(), 100.0, 1e-9);
  EXPECT_NEAR(link["bytes_from"].get<double>(), 2000.0, 1e-9);
  EXPECT_NEAR(link["signal"].get<double>(), -71.0, 1e-9);
  EXPECT_EQ(link["sender"]["link"], "mesh_100k");
  EXPECT_NEAR(link["sender"]["queue"].get<double>(), 0.25, 1e-6);
  EXPECT_EQ(link["sender"]["dropped"]["state"], 12);
  const std::string text = net_text(network_report(fleet, Time(4s)), {});
  for (const char* part : {"2000", "250", "2.5", "-71", "mesh_100k 100 kbit/s", "r1 dropped", "state 12"})
    EXPECT_THAT(text, HasSubstr(part));
  report.queue(-1.0F);
  report.bandwidth(std::nanf(""));
  fleet.hear(report, {.received = Time(5s)});
  EXPECT_EQ(net_json(fleet, Time(5s))["links"][0]["sender"]["queue"], 0.0);
  fleet.carried({}, Time(6s));  // it left
  EXPECT_TRUE(net_json(fleet, Time(6s))["links"][0]["bytes_to"].is_null());
}

TEST(Report, ARefusalNamesReasonAndHolder) {
  const Answer answer{.robot = "r1", .answered = true, .reason = Reason::not_holder, .holder = "op2"};
  const std::string text = answer_text(answer, "taken");
  EXPECT_THAT(text, HasSubstr("r1: refused: "));
  EXPECT_THAT(text, HasSubstr("(holder: op2)"));
  EXPECT_THAT(text, HasSubstr("[not_holder]"));
  EXPECT_EQ(answer_text({.robot = "r1", .accepted = true}, "taken"), "r1: taken\n");
  const Answer own{
      .robot = "r1", .answered = true, .reason = Reason::goal_missing, .text = "no goal", .holder = "op1"};
  EXPECT_EQ(answer_text(own, "", "op1"), "r1: refused: no goal [goal_missing]\n");
  EXPECT_EQ(answer_text(own, "", "op2"), "r1: refused: no goal (holder: op1) [goal_missing]\n");
}

TEST(Report, NotANumberStaysValidJson) {
  Fleet fleet("op1", {1});
  radio::RobotState state;
  state.robot("r1");
  state.x(std::nanf(""));
  fleet.hear(state, {.received = Time(1s)});
  EXPECT_THAT(list_json(fleet, Time(1s)).dump(), HasSubstr("\"pose\":[null,"));
}

}  // namespace
}  // namespace adit::station
