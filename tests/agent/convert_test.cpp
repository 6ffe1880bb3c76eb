// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/radio/convert.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/command/parse.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "robot_agent/supervisor/health_message.hpp"

namespace adit::agent {
namespace {

template <class T>
std::size_t encoded(const T& sample) {
  std::vector<std::uint8_t> bytes;
  wire::encode(sample, bytes);
  return bytes.size();
}

// Whatever its sender made of a text, the answer fits its topic: else it would never be sent.
TEST(Convert, LongTextsFitTheirTopics) {
  const std::string name(32, 'n');
  Answer answer{};
  answer.station = std::string(400, 's');
  answer.text = std::string(10'000, 'x');
  answer.holder = name;
  const auto ack = to_radio(answer, name);
  EXPECT_LE(encoded(ack), wire::topics::kAcknowledgement.max_bytes);
  EXPECT_THAT(ack.text(), testing::EndsWith("..."));

  const Notice notice{name, Severity::warning, "mode_refused", Reason::mode_unknown,
                      std::string(10'000, 'x')};
  EXPECT_LE(encoded(to_radio(notice, name)), wire::topics::kNotification.max_bytes);

  ComponentRow part{};
  part.name = name;
  part.text = std::string(10'000, 'x');
  EXPECT_LE(encoded(to_radio(std::vector<ComponentRow>(8, part), name)), wire::topics::kHealth.max_bytes);
}

TEST(Convert, ARouteOfAnyLengthFitsItsTopic) {
  const std::string name(32, 'n');
  Answer answer{};
  answer.station = answer.holder = name;
  answer.route = PlannedRoute{.length = 120.5, .unknown_length = 3.0, .corners = 100'000, .points = {}};
  answer.route->points.resize(40, {1.0, 2.0, 3.0});
  const auto ack = to_radio(answer, name);
  EXPECT_LE(encoded(ack), wire::topics::kAcknowledgement.max_bytes);
  ASSERT_EQ(ack.route().size(), 1U);
  EXPECT_EQ(ack.route()[0].points().size(), 3 * PlannedRoute::kMaxCorners);
  EXPECT_EQ(ack.route()[0].corners(), 65535);
  EXPECT_EQ(ack.route()[0].points()[5], 3.0F);
  EXPECT_TRUE(to_radio(Answer{}, name).route().empty());
}

TEST(Convert, AFollowedRouteOfAnyLengthFitsItsTopic) {
  const std::string name(32, 'n');
  FollowedRoute route{.goal_id = 7, .corners = 100'000, .points = {}, .unknown = 2};
  for (int i = 0; i < 40; ++i) route.points.emplace_back(3.0 * i, -1.25, 0.5);
  radio::Route sent = to_radio(route, name);
  EXPECT_LE(encoded(sent), wire::topics::kRoute.max_bytes);
  EXPECT_EQ(sent.corners(), 65535);
  ASSERT_EQ(sent.points().size(), 3 * (FollowedRoute::kMaxCorners - 1));
  EXPECT_EQ(sent.from()[1], -1.25F);
  EXPECT_EQ(sent.points()[3], 60);
  route.points[2].x() = 1e9;
  sent = to_radio(route, name);
  EXPECT_EQ(sent.points().size(), 3U) << "no corner beyond one that does not fit";
  EXPECT_EQ(to_radio(FollowedRoute{}, name).corners(), 0);
}

// A name that is cut must not become the valid name of another station.
TEST(Convert, AreasOfAnySizeFitTheirTopics) {
  const std::string name(32, 'n');
  BehaviourView view{};
  view.mode = "smart_joystick";
  view.convoy.assign(8, name);
  view.exploration.state = ExplorationState::exploring;
  for (int i = 10; i < 26; ++i) {
    nav::Area area{.name = std::string(30, 'a') + std::to_string(i), .kind = nav::AreaKind::keep_out};
    for (int k = 0; k < 16; ++k)
      area.corners.emplace_back(20 * std::cos(k * M_PI / 8), 20 * std::sin(k * M_PI / 8));
    ASSERT_TRUE(view.areas.add(nav::checked(area).value()));
  }
  const auto state = to_radio(view, std::vector<ModeOption>(16, {"smart_joystick", Reason::stopped}), name);
  EXPECT_LE(encoded(state), wire::topics::kBehaviour.max_bytes);
  ASSERT_EQ(state.areas().size(), 16U);
  EXPECT_EQ(state.areas()[3].corners().size(), 32U);
  EXPECT_EQ(state.areas()[3].kind(), radio::AREA_KEEP_OUT);
  EXPECT_EQ(state.areas()[3].corners()[0], 20.0F);

  const std::string corner = " -1234.567 1234.567";
  std::string line = "area r1 add " + name + " keep_out";
  for (int k = 0; k < 16; ++k) line += corner;
  const auto request = command::parse(line + " --z -1 2.5 --weight 3");
  ASSERT_TRUE(request) << request.error().text;
  const command::Payload payload = command::pack(*request);
  radio::Command command;
  command.robot(name);
  command.station(name);
  command.kind(radio::CMD_AREA_ADD);
  command.words(payload.words);
  command.numbers(payload.numbers);
  command.options(payload.options);
  EXPECT_LE(encoded(command), wire::topics::kCommand.max_bytes);
  const Command read = from_radio(command, {});
  EXPECT_FALSE(read.invalid) << read.invalid->text;
  EXPECT_EQ(read.request.numbers("X Y").size(), 32U);
  EXPECT_EQ(read.request.numbers("--z"), (std::vector<double>{-1, 2.5}));
  EXPECT_EQ(read.request.number("--weight"), 3.0);
}

TEST(Convert, OverlongNamesAreBoundedAndStayInvalid) {
  radio::Command command;
  command.station(std::string(200, 'n'));
  const Sender from = from_radio(command, {}).from;
  EXPECT_LE(from.name.size(), 32u);
  EXPECT_FALSE(valid_name(from.name));
  radio::Capabilities capabilities;
  capabilities.name(std::string(200, 'n'));
  EXPECT_FALSE(valid_name(from_radio(capabilities, {}).name));
  command.station(std::string(32, 'n'));
  EXPECT_EQ(from_radio(command, {}).from.name, std::string(32, 'n'));
}

TEST(Convert, ShortTextsStay) {
  Answer answer{};
  answer.station = "op1";
  answer.text = "locked by op2";
  const auto ack = to_radio(answer, "r1");
  EXPECT_EQ(ack.station(), "op1");
  EXPECT_EQ(ack.text(), "locked by op2");
}

TeamBeacon a_beacon() {
  TeamBeacon beacon{.robot = "r2", .start = 5, .seq = 3, .pose = {300, -200, 1}, .z = 0.5};
  beacon.mode = "waypoint";
  beacon.holder = "op1";
  beacon.convoy = ConvoyPart{7, 8, 1, false, true, 3.25, 1.5, 4, 9, {}};
  for (int i = 0; i < 8; ++i) beacon.convoy->points.push_back({300 + 0.5 * i, -200.0, 0.5});
  beacon.rank = 3;
  beacon.yields = true;
  beacon.ask = YieldAsk{{"r3", "r4"}, "r2", 0.8, {{300, -200}, {303, -200}, {303, -190}}};
  beacon.answer = YieldAnswer{"r1", true, Reason::none, {301, -202}};
  return beacon;
}

TEST(Convert, ABeaconArrivesAsItWasSentAndFitsItsTopic) {
  const TeamBeacon sent = a_beacon();
  const auto read = from_radio(to_radio(sent));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->robot, "r2");
  EXPECT_EQ(read->convoy->first, 9u);
  ASSERT_EQ(read->convoy->points.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_LT((read->convoy->points[i] - sent.convoy->points[i]).norm(), 0.01);
  EXPECT_EQ(read->answer, sent.answer);
  EXPECT_EQ(read->rank, 3);
  EXPECT_TRUE(read->yields);
  ASSERT_TRUE(read->ask);
  EXPECT_EQ(read->ask->to, sent.ask->to);
  EXPECT_LT((read->ask->route.back() - sent.ask->route.back()).norm(), 0.01);
  TeamBeacon longest = sent;
  longest.ask->to.assign(YieldAsk::kRobots, std::string(32, 'n'));
  longest.ask->root = longest.answer->root = std::string(32, 'n');
  longest.ask->route.assign(YieldAsk::kPoints, {300, -200});
  longest.robot = longest.holder = longest.mode = std::string(32, 'n');
  EXPECT_LE(encoded(to_radio(longest)), wire::topics::kTeam.max_bytes);
  TeamBeacon usual = sent;
  usual.ask.reset();
  usual.answer.reset();
  EXPECT_LE(encoded(to_radio(usual)), 220u) << "what BeaconRate counts on, less the headers";
  TeamBeacon far = sent;
  far.convoy->points[3].x() += 400.0;
  EXPECT_EQ(from_radio(to_radio(far))->convoy->points.size(), 3u) << "the rest would be misnumbered";
}

TEST(Convert, MalformedBeaconsAreRefused) {
  const radio::TeamBeacon good = to_radio(a_beacon());
  ASSERT_TRUE(from_radio(good));
  const auto refused = [&](const auto& spoil) {
    radio::TeamBeacon bad = good;
    spoil(bad);
    return !from_radio(bad);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused([&](auto& b) { b.pose()[0] = nan; }));
  EXPECT_TRUE(refused([&](auto& b) { b.pose()[2] = 1e30f; }));
  EXPECT_TRUE(refused([&](auto& b) { b.speed()[1] = nan; }));
  EXPECT_TRUE(refused([&](auto& b) { b.convoy()[0].along(nan); }));
  EXPECT_TRUE(refused([&](auto& b) { b.robot("r 2"); }));
  EXPECT_TRUE(refused([&](auto& b) { b.robot(std::string(64, 'r')); }));
  EXPECT_TRUE(refused([&](auto& b) { b.holder("op\n1"); }));
  EXPECT_TRUE(refused([&](auto& b) { b.mode(std::string(64, 'm')); }));
  EXPECT_TRUE(refused([&](auto& b) { b.convoy().resize(64, b.convoy()[0]); }));
  EXPECT_TRUE(refused([&](auto& b) { b.convoy()[0].points().resize(27); }));
  EXPECT_TRUE(refused([&](auto& b) { b.convoy()[0].points().resize(4); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].to().resize(64, "r3"); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].to().clear(); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].root("r 1"); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].width(nan); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].width(0.0f); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].route().resize(3); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask()[0].route().resize(26); }));
  EXPECT_TRUE(refused([&](auto& b) { b.ask().resize(2, b.ask()[0]); }));
  EXPECT_TRUE(refused([&](auto& b) { b.answer()[0].place()[1] = nan; }));
  EXPECT_TRUE(refused([&](auto& b) { b.answer()[0].root(""); }));
}

TEST(Convert, CommandsAreReadByTheCommandTable) {
  radio::Command sample;
  sample.robot("r1");
  for (const command::CommandInfo& row : command::table()) {
    if (row.runs != command::Runs::robot) continue;
    const command::Request typed = command::parse(row.example).value();
    const command::Payload payload = command::pack(typed);
    sample.kind(static_cast<radio::CommandKind>(payload.number));
    sample.words(payload.words);
    sample.numbers(payload.numbers);
    sample.options(payload.options);
    std::vector<std::uint8_t> bytes;
    wire::encode(sample, bytes);
    radio::Command received;
    ASSERT_TRUE(wire::decode(bytes, received)) << row.name;
    const Command read = from_radio(received, {});
    EXPECT_FALSE(read.invalid) << row.name;
    EXPECT_EQ(read.request.verb, typed.verb) << row.name;
  }
}

TEST(Convert, ACommandThatIsNotUnderstoodSaysWhy) {
  radio::Command sample;
  sample.kind(static_cast<radio::CommandKind>(200));
  EXPECT_EQ(from_radio(sample, {}).invalid->reason, Reason::unknown_command);
  sample.kind(radio::CMD_GOTO);
  sample.numbers({1.0, std::nan("")});
  EXPECT_EQ(from_radio(sample, {}).invalid->reason, Reason::out_of_range);
  sample.kind(radio::CMD_STOP);
  EXPECT_EQ(from_radio(sample, {}).request.verb, command::verb("stop"));
}

TEST(Convert, CapabilitiesNameTheSteepestSlope) {
  Platform platform{};
  platform.max_slope = 1.0;
  EXPECT_NEAR(to_radio(platform, "r1", {}, 1, ModeTable::shipped()).slope(), 0.785, 1e-3);
}

TEST(Convert, AStationsPlaceIsTakenWhereItSaysAPossibleOne) {
  radio::Capabilities said;
  said.name("op1");
  said.kind(radio::AGENT_STATION);
  said.place({1.0F, 2.0F, 0.5F});
  EXPECT_FALSE(from_radio(said, {}).place) << "it has none";
  said.placed(true);
  EXPECT_EQ(from_radio(said, {}).place, Eigen::Vector3d(1.0, 2.0, 0.5));
  said.place({std::numeric_limits<float>::quiet_NaN(), 2.0F, 0.5F});
  EXPECT_FALSE(from_radio(said, {}).place);
  said.place({1.0F, 2.0F, 0.5F});
  said.kind(radio::AGENT_ROBOT);
  EXPECT_FALSE(from_radio(said, {}).place) << "a robot's state says where it is";
}

}  // namespace
}  // namespace adit::agent
