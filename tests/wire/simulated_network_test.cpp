// SPDX-License-Identifier: Apache-2.0
#include "core/wire/memory/simulated_network.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/robot.h"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "tests/wire/numbered_command.hpp"

namespace adit::wire {
namespace {

/// A machine on the simulated network that keeps what it hears.
struct Machine {
  Machine(VirtualScheduler& scheduler, SimulatedNetwork& network, const std::string& name,
          Duration clock_offset = 0ms)
      : runtime(scheduler.machine(name, clock_offset)),
        strand(runtime->strand("main")),
        wire(network.join(77, name)) {}

  Writer<radio::Command> commands(const std::string& partition) {
    return std::move(Writer<radio::Command>::make(*wire, topics::kCommand, partition)).value();
  }
  void hear_commands(const std::string& partition) {
    readers.push_back(std::move(make_reader(
                                    *wire, topics::kCommand, *strand,
                                    [this](const radio::Command& c, const SampleInfo& info) {
                                      seen.push_back(c.seq());
                                      senders.push_back(info.sender);
                                      received.push_back(info.received);
                                    },
                                    partition))
                          .value());
  }

  std::unique_ptr<Runtime> runtime;
  std::shared_ptr<Executor> strand;
  std::unique_ptr<Participant> wire;
  std::vector<std::unique_ptr<RawReader>> readers{};
  std::vector<std::uint64_t> seen{};
  std::vector<ParticipantId> senders{};
  std::vector<Time> received{};
};

LinkProfile profile(double bandwidth, double latency, double loss) {
  LinkProfile link;
  link.bandwidth = bandwidth;
  link.latency = latency;
  link.loss = loss;
  return link;
}

std::vector<std::uint64_t> up_to(std::uint64_t n) {
  std::vector<std::uint64_t> v;
  for (std::uint64_t i = 1; i <= n; ++i) v.push_back(i);
  return v;
}

TEST(SimulatedNetwork, CarriesASampleWithItsSenderAndTheReceiversClock) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {.link = profile(1e6, 0.05, 0.0)});
  Machine station(scheduler, network, "op1"), robot(scheduler, network, "r1", 1h);
  robot.hear_commands("r1");
  auto writer = station.commands("r1");
  scheduler.run_until(2s);
  ASSERT_EQ(writer.matched(), 1U);
  ASSERT_TRUE(writer.write(numbered_command(1)).ok());
  scheduler.run_until(3s);
  ASSERT_EQ(robot.seen, up_to(1));
  EXPECT_EQ(robot.senders[0], station.wire->id());
  const double delay = seconds(robot.received[0].time_since_epoch() - 1h) - 2.0;
  EXPECT_GT(delay, 0.05);
  EXPECT_LT(delay, 0.06);
}

/// Like the commands' topic, but with a history.
constexpr Topic<radio::Command> kKept{
    {"adit/test_kept", "adit::radio::Command", QosClass::urgent, 16, false, 512}};

TEST(SimulatedNetwork, RepairsReliableSamplesAfterLossAndKeepsTheirOrder) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {.link = profile(1e6, 0.02, 0.3)});
  Machine station(scheduler, network, "op1"), robot(scheduler, network, "r1");
  std::vector<std::uint64_t> seen;
  const auto reader =
      make_reader(*robot.wire, kKept, *robot.strand,
                  [&](const radio::Command& c, const SampleInfo&) { seen.push_back(c.seq()); });
  auto writer = std::move(Writer<radio::Command>::make(*station.wire, kKept)).value();
  scheduler.run_until(10s);
  for (std::uint64_t i = 1; i <= 100; ++i) {
    ASSERT_TRUE(writer.write(numbered_command(i)).ok());
    scheduler.run_until(scheduler.elapsed() + 200ms);
  }
  scheduler.run_until(scheduler.elapsed() + 10s);
  EXPECT_EQ(seen, up_to(100));
}

TEST(SimulatedNetwork, ALostCommandDoesNotHoldUpTheNext) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {.link = profile(1e6, 0.2, 0.0)});
  Machine station(scheduler, network, "op1"), robot(scheduler, network, "r1");
  robot.hear_commands("r1");
  auto writer = station.commands("r1");
  scheduler.run_until(10s);
  ASSERT_TRUE(writer.write(numbered_command(1)).ok());
  scheduler.run_until(11s);
  network.degrade("op1", "r1", 1.0);
  ASSERT_TRUE(writer.write(numbered_command(2)).ok());
  scheduler.run_until(11050ms);
  network.degrade("op1", "r1", std::nullopt);
  ASSERT_TRUE(writer.write(numbered_command(3)).ok());
  scheduler.run_until(11300ms);  // one way, without a round trip of repair
  EXPECT_EQ(robot.seen, (std::vector<std::uint64_t>{1, 3}));
}

TEST(SimulatedNetwork, ReplacedSampleIsNeverSent) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {.link = profile(100e3, 0.01, 0.0)});
  Machine robot(scheduler, network, "r1"), station(scheduler, network, "op1");
  constexpr TopicInfo pieces{"adit/test_pieces", "Piece", QosClass::bulk, 8, false, 1024};
  std::vector<std::uint8_t> seen;
  const auto reader =
      station.wire->make_reader(pieces, "", *station.strand, [&](auto bytes, const SampleInfo&) {
        seen.push_back(bytes[4]);
        return true;
      });
  auto writer = std::move(robot.wire->make_writer(pieces, "")).value();
  scheduler.run_until(5s);
  std::vector<std::uint8_t> piece(340);
  piece[1] = 1;
  for (int i = 0; i < 100; ++i) {
    ++piece[4];
    ASSERT_TRUE(writer->write(piece).ok());  // all at once, a history of eight
  }
  scheduler.run_until(20s);
  // Those that the radio had taken already, then the newest eight.
  ASSERT_GE(seen.size(), 8U);
  EXPECT_LE(seen.size(), 12U);
  EXPECT_EQ(seen.back(), 100);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_LT(robot.wire->counters().total_out, 20000U);
}

TEST(SimulatedNetwork, LosesBestEffortSamplesAndCountsThem) {
  VirtualScheduler scheduler(3);
  SimulatedNetwork network(scheduler, {.link = profile(10e6, 0.01, 0.2)});
  Machine robot(scheduler, network, "r1"), station(scheduler, network, "op1");
  int heard = 0, lost = 0;
  network.set_tap([&](const SampleEvent& frame) { lost += frame.kind == SampleEvent::Kind::lost; });
  auto reader = make_reader(*station.wire, topics::kRobotState, *station.strand,
                            [&](const radio::RobotState&, const SampleInfo&) { ++heard; });
  auto writer = std::move(Writer<radio::RobotState>::make(*robot.wire, topics::kRobotState)).value();
  scheduler.run_until(10s);
  radio::RobotState state;
  state.robot("r1");
  for (int i = 0; i < 1000; ++i) {
    (void)writer.write(state);
    scheduler.run_until(scheduler.elapsed() + 100ms);
  }
  EXPECT_NEAR(heard, 800, 50);
  EXPECT_EQ(heard + lost, 1000);
  const WireCounters counters = station.wire->counters();
  ASSERT_EQ(counters.topics.size(), 1U);
  EXPECT_NEAR(static_cast<double>(counters.topics[0].lost), lost, 3);
  EXPECT_EQ(counters.topics[0].peer, robot.wire->id());
}

TEST(SimulatedNetwork, LateJoinersGetTheStatusOfEachKey) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {.link = profile(1e6, 0.05, 0.1)});
  Machine robot(scheduler, network, "r1");
  auto writer = std::move(Writer<radio::AuthorityStatus>::make(*robot.wire, topics::kAuthority)).value();
  for (int round = 0; round < 3; ++round) {
    for (int key = 0; key < 20; ++key) {
      radio::AuthorityStatus status;
      status.robot("r" + std::to_string(key));
      status.seq(static_cast<std::uint64_t>(round));
      ASSERT_TRUE(writer.write(status).ok());
    }
  }
  scheduler.run_until(30s);
  Machine station(scheduler, network, "op1");
  std::map<std::string, std::vector<std::uint64_t>> heard;
  auto reader = make_reader(
      *station.wire, topics::kAuthority, *station.strand,
      [&](const radio::AuthorityStatus& s, const SampleInfo&) { heard[s.robot()].push_back(s.seq()); });
  scheduler.run_until(45s);
  ASSERT_EQ(heard.size(), 20U);
  for (const auto& [key, seqs] : heard) EXPECT_EQ(seqs, std::vector<std::uint64_t>{2}) << key;
}

TEST(SimulatedNetwork, CommandsAreNotReplayedToLateJoiners) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {});
  Machine station(scheduler, network, "op1");
  auto writer = station.commands("r1");
  ASSERT_TRUE(writer.write(numbered_command(1)).ok());
  scheduler.run_until(1s);
  Machine robot(scheduler, network, "r1");
  robot.hear_commands("r1");
  scheduler.run_until(10s);
  ASSERT_TRUE(writer.write(numbered_command(2)).ok());
  scheduler.run_until(20s);
  EXPECT_EQ(robot.seen, std::vector<std::uint64_t>{2});
}

TEST(SimulatedNetwork, PartitionsAndDomainsKeepApart) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {});
  Machine station(scheduler, network, "op1"), r1(scheduler, network, "r1"), r2(scheduler, network, "r2");
  r1.hear_commands("r1");
  r2.hear_commands("r2");
  auto writer = station.commands("r1");
  auto foreign_wire = network.join(5, "r3");
  scheduler.run_until(3s);
  EXPECT_EQ(writer.matched(), 1U);
  ASSERT_TRUE(writer.write(numbered_command(1)).ok());
  scheduler.run_until(4s);
  EXPECT_EQ(r1.seen, up_to(1));
  EXPECT_TRUE(r2.seen.empty());
  EXPECT_EQ(foreign_wire->counters().total_in, 0U);
}

TEST(SimulatedNetwork, BandwidthIsSharedByAllThatASenderSends) {
  VirtualScheduler scheduler(1);
  LinkProfile link = profile(100e3, 0.0, 0.0);
  link.queue = 10.0;
  SimulatedNetwork network(scheduler, {.link = link});
  Machine station(scheduler, network, "op1"), robot(scheduler, network, "r1");
  robot.hear_commands("r1");
  auto writer = station.commands("r1");
  scheduler.run_until(5s);
  radio::Command big = numbered_command(1);
  big.words({std::string(380, 'x')});
  const std::uint64_t before = station.wire->counters().total_out;
  for (int i = 1; i <= 10; ++i) {
    big.seq(static_cast<std::uint64_t>(i));
    ASSERT_TRUE(writer.write(big).ok());
  }
  scheduler.run_until(7s);
  ASSERT_EQ(robot.seen, up_to(10));
  std::uint64_t bytes = 0;
  for (const auto& count : station.wire->counters().topics) bytes += count.bytes_out;
  const double airtime = static_cast<double>(bytes) * 8 / 100e3;
  EXPECT_GE(bytes, 10U * 450);
  EXPECT_LE(bytes, station.wire->counters().total_out - before);
  EXPECT_NEAR(seconds(robot.received.back().time_since_epoch()) - 5.0, airtime, 0.02);
}

TEST(SimulatedNetwork, UrgentGoesFirstAndOfAStreamTheNewestWins) {
  VirtualScheduler scheduler(1);
  LinkProfile link = profile(20e3, 0.0, 0.0);
  link.queue = 10.0;
  SimulatedNetwork network(scheduler, {.link = link});
  Machine station(scheduler, network, "op1"), robot(scheduler, network, "r1");
  robot.hear_commands("r1");
  std::vector<std::uint64_t> sticks;
  auto reader = make_reader(
      *robot.wire, topics::kJoystick, *robot.strand,
      [&](const radio::Joystick& j, const SampleInfo&) { sticks.push_back(j.seq()); }, "r1");
  auto commands = station.commands("r1");
  auto joystick = std::move(Writer<radio::Joystick>::make(*station.wire, topics::kJoystick, "r1")).value();
  scheduler.run_until(20s);
  radio::Joystick stick;
  stick.robot("r1");
  for (std::uint64_t i = 1; i <= 20; ++i) {
    stick.seq(i);
    (void)joystick.write(stick);
  }
  (void)commands.write(numbered_command(1));
  bool command_first = false;
  scheduler.run_until(20s + 200ms);
  command_first = robot.seen.size() == 1 && sticks.size() <= 1;
  scheduler.run_until(22s);
  EXPECT_TRUE(command_first);
  ASSERT_EQ(sticks.size(), 2U);  // the one on the air already, and the newest
  EXPECT_EQ(sticks.back(), 20U);
}

TEST(SimulatedNetwork, CutNeitherBlocksNorGrowsAndHealsWithTheNewestStatus) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {.link = profile(1e6, 0.01, 0.0)});
  Machine robot(scheduler, network, "r1"), station(scheduler, network, "op1");
  std::vector<std::uint64_t> heard;
  auto reader =
      make_reader(*station.wire, topics::kAuthority, *station.strand,
                  [&](const radio::AuthorityStatus& s, const SampleInfo&) { heard.push_back(s.seq()); });
  auto writer = std::move(Writer<radio::AuthorityStatus>::make(*robot.wire, topics::kAuthority)).value();
  std::vector<ParticipantEvent> events;
  station.wire->on_participant(*station.strand, [&](const ParticipantEvent& e) { events.push_back(e); });
  scheduler.run_until(5s);
  for (const Duration cut_for : {10s, 60s}) {
    heard.clear();
    network.cut("r1", "op1", true);
    radio::AuthorityStatus status;
    status.robot("r1");
    for (std::uint64_t i = 1; i <= 100; ++i) {
      status.seq(i);
      ASSERT_TRUE(writer.write(status).ok());
    }
    scheduler.run_until(scheduler.elapsed() + cut_for);
    EXPECT_TRUE(heard.empty());
    network.cut("r1", "op1", false);
    scheduler.run_until(scheduler.elapsed() + 30s);  // the next announcement is at most 25 s away
    EXPECT_EQ(heard, std::vector<std::uint64_t>{100});
  }
  ASSERT_EQ(events.size(), 3U);  // came, lease ran out in the longer cut, came back
  EXPECT_TRUE(events[0].present);
  EXPECT_FALSE(events[1].present);
  EXPECT_TRUE(events[2].present);
}

TEST(SimulatedNetwork, GoodbyeIsSeenAtOnceACrashWhenTheLeaseRunsOut) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {});
  Machine station(scheduler, network, "op1");
  std::vector<std::pair<double, ParticipantEvent>> events;
  station.wire->on_participant(*station.strand, [&](const ParticipantEvent& e) {
    events.emplace_back(seconds(scheduler.elapsed()), e);
  });
  auto robot = std::make_unique<Machine>(scheduler, network, "r1");
  const ParticipantId first = robot->wire->id();
  scheduler.run_until(5s);
  robot.reset();
  scheduler.run_until(6s);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_LT(events[1].first, 5.1);
  robot = std::make_unique<Machine>(scheduler, network, "r1");
  EXPECT_NE(robot->wire->id(), first);
  scheduler.run_until(10s);
  ASSERT_EQ(events.size(), 3U);
  network.crash("r1");
  robot.reset();
  scheduler.run_until(60s);
  EXPECT_EQ(events.size(), 3U);
  scheduler.run_until(80s);
  ASSERT_EQ(events.size(), 4U);
  EXPECT_FALSE(events[3].second.present);
}

TEST(SimulatedNetwork, RangeAndDegradeLoseFrames) {
  VirtualScheduler scheduler(1);
  LinkProfile link = profile(1e6, 0.01, 0.0);
  link.range = 50.0;
  SimulatedNetwork network(scheduler, {.link = link});
  Machine station(scheduler, network, "op1"), robot(scheduler, network, "r1");
  network.set_position("op1", 0, 0);
  network.set_position("r1", 60, 0);
  scheduler.run_until(15s);
  EXPECT_EQ(robot.wire->counters().total_in, 0U);
  network.set_position("r1", 40, 0);
  scheduler.run_until(45s);
  const std::uint64_t heard = robot.wire->counters().total_in;
  EXPECT_GT(heard, 0U);
  network.degrade("op1", "r1", 1.0);
  scheduler.run_until(75s);
  EXPECT_EQ(robot.wire->counters().total_in, heard);
  network.degrade("op1", "r1", std::nullopt);
  scheduler.run_until(110s);
  EXPECT_GT(robot.wire->counters().total_in, heard);
}

TEST(SimulatedNetwork, LargeSamplesPassInFramesAndAreRepairedByFrame) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {.link = profile(20e6, 0.005, 0.1)});
  Machine robot(scheduler, network, "r1"), station(scheduler, network, "op1");
  constexpr TopicInfo large{"adit/test_large", "Bytes", QosClass::bulk, 8, false, 1 << 20};
  std::vector<std::size_t> sizes;
  auto reader = station.wire->make_reader(large, "", *station.strand, [&](auto bytes, const SampleInfo&) {
    sizes.push_back(bytes.size());
    return true;
  });
  auto writer = std::move(robot.wire->make_writer(large, "")).value();
  scheduler.run_until(10s);
  ASSERT_TRUE(writer->write(std::vector<std::uint8_t>(32 * 1024)).ok());
  scheduler.run_until(20s);
  EXPECT_EQ(sizes, std::vector<std::size_t>{32 * 1024});
}

TEST(SimulatedNetwork, OversizeAndKeylessSamplesAreErrorsAndCounted) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {});
  Machine robot(scheduler, network, "r1");
  auto writer = std::move(robot.wire->make_writer(topics::kPresence, "")).value();
  EXPECT_EQ(writer->write(std::vector<std::uint8_t>(4096)).reason(), Reason::out_of_range);
  EXPECT_EQ(writer->write(std::vector<std::uint8_t>(3)).reason(), Reason::malformed);
  EXPECT_EQ(robot.wire->counters().topics.at(0).failed_writes, 2U);
}

TEST(SimulatedNetwork, MalformedSamplesAreCountedBySenderAndSurvived) {
  VirtualScheduler scheduler(1);
  SimulatedNetwork network(scheduler, {});
  Machine station(scheduler, network, "op1"), robot(scheduler, network, "r1");
  robot.hear_commands("r1");
  auto writer = std::move(station.wire->make_writer(topics::kCommand, "r1")).value();
  scheduler.run_until(3s);
  ASSERT_TRUE(writer->write(std::vector<std::uint8_t>{0, 1, 0, 0, 255, 255, 255, 255}).ok());
  std::vector<std::uint8_t> good;
  encode(numbered_command(7), good);
  ASSERT_TRUE(writer->write(good).ok());
  scheduler.run_until(4s);
  EXPECT_EQ(robot.seen, std::vector<std::uint64_t>{7});
  const auto counters = robot.wire->counters();
  ASSERT_EQ(counters.topics.size(), 1U);
  EXPECT_EQ(counters.topics[0].malformed, 1U);
  EXPECT_EQ(counters.topics[0].peer, station.wire->id());
}

/// Everything seen on the air, as a number.
std::uint64_t digest_of(std::uint64_t seed) {
  std::uint64_t digest = 0xcbf29ce484222325ULL;
  const auto mix = [&digest](std::uint64_t v) { digest = (digest ^ v) * 0x100000001b3ULL; };
  VirtualScheduler scheduler(seed);
  SimulatedNetwork network(scheduler, {.seed = seed, .link = profile(500e3, 0.05, 0.2)});
  network.set_tap([&](const SampleEvent& f) {
    mix(static_cast<std::uint64_t>(f.kind));
    mix(static_cast<std::uint64_t>(f.at.count()));
    for (const auto byte : f.from) mix(byte);
    for (const auto byte : f.bytes) mix(byte);
  });
  std::vector<std::unique_ptr<Machine>> machines;
  std::vector<Writer<radio::Command>> writers;
  for (int i = 0; i < 4; ++i) {
    machines.push_back(std::make_unique<Machine>(scheduler, network, "m" + std::to_string(i)));
    machines.back()->hear_commands("all");
    writers.push_back(machines.back()->commands("all"));
  }
  for (std::uint64_t i = 1; i <= 100; ++i) {
    for (auto& writer : writers) (void)writer.write(numbered_command(i));
    scheduler.run_until(scheduler.elapsed() + 100ms);
  }
  return digest;
}

TEST(SimulatedNetwork, SameSeedSameRun) {
  EXPECT_EQ(digest_of(1), digest_of(1));
  EXPECT_NE(digest_of(1), digest_of(2));
}

TEST(SimulatedNetwork, WiresMayOutliveIt) {
  VirtualScheduler scheduler(1);
  auto network = std::make_unique<SimulatedNetwork>(scheduler, SimulatedNetworkParams{});
  Machine station(scheduler, *network, "op1"), robot(scheduler, *network, "r1");
  robot.hear_commands("r1");
  auto writer = station.commands("r1");
  scheduler.run_until(2s);
  (void)writer.write(numbered_command(1));
  network.reset();
  (void)writer.write(numbered_command(2));
  scheduler.run_until(60s);
  EXPECT_TRUE(robot.seen.empty());
}

}  // namespace
}  // namespace adit::wire
