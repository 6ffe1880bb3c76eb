// SPDX-License-Identifier: Apache-2.0
#include "core/contract/command.hpp"

#include <gmock/gmock.h>

#include "adit/command.h"
#include "core/command/parse.hpp"
#include "core/wire/topics.hpp"
#include "tests/contract/random_samples.hpp"

namespace adit::contract {

static void randomize(RandomSamples& random, radio::Command& out) {
  random.any(out.robot(), out.station(), out.station_id(), out.epoch(), out.seq(), out.kind(), out.words(),
             out.numbers(), out.options());
  if (random.random().chance(0.7)) out.kind(static_cast<radio::CommandKind>(random.random().below(24)));
}
static void randomize(RandomSamples& random, radio::Joystick& out) {
  random.any(out.robot(), out.station_id(), out.epoch(), out.seq(), out.echo(), out.vx(), out.vy(), out.wz());
}
static void randomize(RandomSamples& random, radio::PlannedRoute& out) {
  random.any(out.length(), out.unknown_length(), out.corners(), out.points());
  if (random.random().chance(0.7)) out.points().resize(3 * random.random().below(30), 1.5F);
}
static void randomize(RandomSamples& random, radio::Acknowledgement& out) {
  random.any(out.robot(), out.station(), out.station_id(), out.seq(), out.accepted(), out.reason(),
             out.text(), out.holder(), out.epoch(), out.route());
}

namespace {

command::Payload payload_of(const Command& command) { return command::pack(command.request); }

/// A message with the arguments of a typed line.
Command typed(RandomSamples& random, const command::Request& request) {
  Command out{.robot = random.name(), .station = random.name(), .request = request};
  random.any(out.station_id, out.epoch.start, out.epoch.counter, out.seq);
  return out;
}

void expect_same(const Command& read, const Command& sent) {
  EXPECT_EQ(read.robot, sent.robot);
  EXPECT_EQ(read.station, sent.station);
  EXPECT_EQ(read.station_id, sent.station_id);
  EXPECT_EQ(read.epoch, sent.epoch);
  EXPECT_EQ(read.seq, sent.seq);
  EXPECT_EQ(read.request.verb, sent.request.verb);
  const command::Payload a = payload_of(read), b = payload_of(sent);
  EXPECT_EQ(a.words, b.words);
  EXPECT_EQ(a.numbers, b.numbers);
  EXPECT_EQ(a.options, b.options);
}

TEST(ContractCommand, EveryCommandComesBackAsItWasAndFitsItsTopic) {
  for_each_seed([](RandomSamples& random) {
    for (const command::CommandInfo& row : command::table()) {
      if (row.runs != command::Runs::robot) continue;
      const Command sent = typed(random, command::parse(row.example).value());
      const Command read = decode(through_cdr(encode(sent), wire::topics::kCommand));
      EXPECT_FALSE(read.invalid) << row.name;
      expect_same(read, sent);
    }
  });
}

TEST(ContractCommand, AnySampleIsBoundedAndWhatIsTakenComesBack) {
  int taken = 0;
  for_any<radio::Command>([&taken](const radio::Command& sample) {
    const Command read = decode(sample);
    EXPECT_LE(read.robot.size(), kMaxName);
    EXPECT_LE(read.station.size(), kMaxName);
    EXPECT_EQ(command::valid_name(read.station), command::valid_name(sample.station()));
    if (read.invalid) return;
    ++taken;
    expect_same(decode(through_cdr(encode(read))), read);
  });
  EXPECT_GT(taken, 0);
}

TEST(ContractCommand, TheLongestAreaFitsItsTopic) {
  const std::string name(kMaxName, 'n');
  std::string line = "area r1 add " + name + " keep_out";
  for (int k = 0; k < 16; ++k) line += " -1234.567 1234.567";
  const auto request = command::parse(line + " --z -1 2.5 --weight 3");
  ASSERT_TRUE(request) << request.error().text;
  const Command sent{.robot = name, .station = name, .request = *request};
  const Command read = decode(through_cdr(encode(sent), wire::topics::kCommand));
  EXPECT_FALSE(read.invalid) << read.invalid->text;
  EXPECT_EQ(read.request.numbers("X Y").size(), 32U);
  EXPECT_EQ(read.request.numbers("--z"), (std::vector<double>{-1, 2.5}));
  EXPECT_EQ(read.request.number("--weight"), 3.0);
}

// A name that is cut must not become the valid name of another station.
TEST(ContractCommand, AnOverlongNameIsBoundedAndStaysInvalid) {
  radio::Command sample;
  sample.station(std::string(200, 'n'));
  EXPECT_EQ(decode(sample).station.size(), kMaxName);
  EXPECT_FALSE(command::valid_name(decode(sample).station));
  sample.station(std::string(kMaxName, 'n'));
  EXPECT_EQ(decode(sample).station, std::string(kMaxName, 'n'));
}

TEST(ContractCommand, ACommandThatIsNotUnderstoodSaysWhy) {
  radio::Command sample;
  sample.kind(static_cast<radio::CommandKind>(200));
  EXPECT_EQ(decode(sample).invalid->reason, Reason::unknown_command);
  sample.kind(radio::CMD_GOTO);
  sample.numbers({1.0, std::nan("")});
  EXPECT_EQ(decode(sample).invalid->reason, Reason::out_of_range);
  sample.kind(radio::CMD_STOP);
  EXPECT_EQ(decode(sample).request.verb, command::verb("stop"));
}

TEST(ContractCommand, AJoystickSampleComesBackAsItWas) {
  for_each_seed([](RandomSamples& random) {
    Joystick sent{.robot = random.name()};
    random.any(sent.station_id, sent.epoch.start, sent.epoch.counter, sent.seq, sent.echo);
    for (double* speed : {&sent.twist.vx, &sent.twist.vy, &sent.twist.wz})
      *speed = static_cast<float>(random.number(3.0));
    EXPECT_EQ(decode(through_cdr(encode(sent), wire::topics::kJoystick)), sent);
  });
  for_any<radio::Joystick>([](const radio::Joystick& sample) {
    const Joystick read = decode(sample);
    EXPECT_LE(read.robot.size(), kMaxName);
    EXPECT_EQ(read.echo, sample.echo());
  });
}

TEST(ContractCommand, AnAnswerComesBackAsItWasAndFitsItsTopic) {
  for_each_seed([](RandomSamples& random) {
    Acknowledgement sent{.robot = random.name(), .station = random.name(), .holder = random.name()};
    random.any(sent.station_id, sent.seq, sent.epoch.start, sent.epoch.counter);
    const bool accepted = random.random().chance(0.5);
    if (!accepted) {
      sent.reason = static_cast<Reason>(1 + random.random().below(65535));
      sent.text = random.name() + " is locked by " + random.name();
    } else {
      PlannedRoute& route = sent.route.emplace();
      route.length = static_cast<float>(random.number(1e3));
      route.unknown_length = 0.5;
      route.corners = random.random().below(65536);
      route.points.resize(random.random().below(PlannedRoute::kMaxCorners + 1), {1.5, -2.0, 0.25});
    }
    const auto read = decode(through_cdr(encode(sent), wire::topics::kAcknowledgement));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->robot, sent.robot);
    EXPECT_EQ(read->station, sent.station);
    EXPECT_EQ(read->station_id, sent.station_id);
    EXPECT_EQ(read->seq, sent.seq);
    EXPECT_EQ(read->reason, sent.reason);
    EXPECT_EQ(read->accepted(), accepted);
    EXPECT_EQ(read->text, sent.text);
    EXPECT_EQ(read->holder, sent.holder);
    EXPECT_EQ(read->epoch, sent.epoch);
    ASSERT_EQ(read->route.has_value(), sent.route.has_value());
    if (!sent.route) return;
    EXPECT_EQ(read->route->length, sent.route->length);
    EXPECT_EQ(read->route->unknown_length, sent.route->unknown_length);
    EXPECT_EQ(read->route->corners, sent.route->corners);
    EXPECT_EQ(read->route->points, sent.route->points);
  });
}

// Whatever its sender made of a text, the answer fits its topic: else it would never be sent.
TEST(ContractCommand, AnAnswerOfAnyLengthFitsItsTopic) {
  const std::string name(kMaxName, 'n');
  Acknowledgement answer{.robot = name, .station = std::string(400, 's'), .text = std::string(10'000, 'x')};
  answer.holder = name;
  EXPECT_THAT(through_cdr(encode(answer), wire::topics::kAcknowledgement).text(), testing::EndsWith("..."));
  answer.text.clear();
  answer.route = PlannedRoute{.length = 120.5, .unknown_length = 3.0, .corners = 100'000};
  answer.route->points.resize(40, {1.0, 2.0, 3.0});
  const auto sample = through_cdr(encode(answer), wire::topics::kAcknowledgement);
  ASSERT_EQ(sample.route().size(), 1U);
  EXPECT_EQ(sample.route()[0].points().size(), 3 * PlannedRoute::kMaxCorners);
  EXPECT_EQ(sample.route()[0].corners(), 65535);
  EXPECT_EQ(sample.route()[0].points()[5], 3.0F);
  EXPECT_TRUE(encode(Acknowledgement{}).route().empty());
}

TEST(ContractCommand, AnyAnswerIsBounded) {
  int taken = 0, routes = 0;
  for_any<radio::Acknowledgement>([&](const radio::Acknowledgement& sample) {
    const auto read = decode(sample);
    EXPECT_EQ(read.has_value(),
              command::valid_name(sample.robot()) && (sample.accepted() || sample.reason() != 0));
    if (!read) return;
    ++taken;
    EXPECT_EQ(read->accepted(), sample.accepted());
    EXPECT_LE(read->station.size(), kMaxName);
    EXPECT_TRUE(is_clean(read->text, kMaxText));
    EXPECT_TRUE(is_clean(read->holder, kMaxName));
    if (!read->route) return;
    ++routes;
    EXPECT_TRUE(read->accepted());
    EXPECT_TRUE(finite(read->route->length, read->route->unknown_length));
    EXPECT_LE(read->route->points.size(), PlannedRoute::kMaxCorners);
    for (const Eigen::Vector3d& point : read->route->points) EXPECT_TRUE(finite(point.x(), point.y()));
  });
  EXPECT_GT(taken, 0);
  EXPECT_GT(routes, 0);
}

}  // namespace
}  // namespace adit::contract
