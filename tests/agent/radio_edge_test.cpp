// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/radio/radio_edge.hpp"

#include <gmock/gmock.h>

#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/robot.h"
#include "adit/team.h"
#include "core/exec/virtual_runtime.hpp"
#include "core/wire/component_io.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "core/wire/topics.hpp"
#include "tests/agent/command_bench.hpp"
#include "tests/wire/held_strand.hpp"

namespace adit::agent {
namespace {

/// The radio edge of r1 on a command strand that is busy until it is released. op1 holds r1.
class RadioEdgeTest : public testing::Test {
 protected:
  RadioEdgeTest() {
    MessageSender& op1 = bench.station("op1").sender;
    bench.interface().departed(op1.participant);
    op1.participant = station->id();
    bench.interface().hear(op1, 1, bench.now);
    EXPECT_TRUE(bench.say("op1", "take").accepted());
    RadioEdge::Dependencies dependencies{directory, namesakes,
                                         [this](const auto& use) { use(bench.interface()); },
                                         [](const Task& task) { task(); }, [](const auto&, const auto&) {}};
    dependencies.refused = [this](const std::string& name, const std::string& why) {
      refused.push_back(name + ": " + why);
    };
    dependencies.beacon = [this](const auto&, const auto&, Time received) { beacons.push_back(received); };
    EXPECT_TRUE(edge->listen(std::move(dependencies)));
    run(3s);  // the endpoints match
    EXPECT_EQ(joystick.matched(), 1U);
  }
  void run(Duration time) { scheduler.run_until(scheduler.elapsed() + time); }
  /// op1 sends a stick that is pushed.
  void send_stick() {
    bench.now = strand->now();
    EXPECT_TRUE(joystick.write(encode(bench.stick("op1", {0.5, 0.0, 0.0}))));
  }

  VirtualScheduler scheduler{1};
  wire::SimulatedNetwork network{scheduler, {1}};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 1h)};
  std::shared_ptr<Strand> strand{machine->strand("command")};
  wire::HeldStrand held{strand};
  std::unique_ptr<wire::Participant> radio{network.join(77, "r1")}, station{network.join(77, "op1")};
  wire::Writer<radio::Joystick> joystick{
      wire::Writer<radio::Joystick>::make(*station, wire::topics::kJoystick, "r1").value()};
  CommandBench bench{};
  std::vector<std::string> refused{};
  std::vector<Time> beacons{};
  PeerTable peers{held};
  Directory directory{peers};
  Namesakes namesakes{radio->id()};
  std::shared_ptr<Generation> generation{std::make_shared<Generation>()};
  std::unique_ptr<RadioEdge> edge{RadioEdge::open({*radio, held, generation}, "r1").value()};
};

TEST_F(RadioEdgeTest, TheAgeOfAStickCountsFromItsReception) {
  send_stick();
  const Time sent = strand->now();
  run(250ms);
  held.release();
  run(1ms);
  ASSERT_EQ(bench.requests.sticks.size(), 1U);
  EXPECT_LT(bench.requests.stick_at - sent, 50ms);
}

TEST_F(RadioEdgeTest, AStickThatWaitedForTheCommandStrandIsStale) {
  send_stick();
  run(400ms);
  held.release();
  run(1ms);
  EXPECT_TRUE(bench.requests.sticks.empty()) << "its echo alone, of 400 ms ago, would let it pass";
}

TEST_F(RadioEdgeTest, TheAgeOfAHeartbeatAndABeaconCountsFromTheirReception) {
  auto presence = wire::Writer<radio::Presence>::make(*station, wire::topics::kPresence).value();
  auto team = wire::Writer<radio::TeamBeacon>::make(*station, wire::topics::kTeam).value();
  run(1s);
  radio::Presence heartbeat;
  heartbeat.kind(radio::AGENT_STATION);
  heartbeat.name("op1");
  heartbeat.id(bench.station("op1").sender.id);
  heartbeat.protocol(1);
  EXPECT_TRUE(presence.write(heartbeat));
  EXPECT_TRUE(team.write(encode(TeamBeacon{.robot = "r2"})));
  const Time sent = strand->now();
  run(2500ms);
  held.release();
  run(1ms);
  EXPECT_LT(bench.interface().authority().heard() - sent, 50ms);
  EXPECT_GE(bench.interface().authority().heard(), sent);
  ASSERT_EQ(beacons.size(), 1U);
  EXPECT_LT(beacons[0] - sent, 50ms);
}

TEST_F(RadioEdgeTest, ASizeThatNoRobotHasIsRefusedAndReported) {
  held.release();
  auto capabilities = wire::Writer<radio::Capabilities>::make(*station, wire::topics::kCapabilities).value();
  for (const float length : {600.0F, 0.6F})
    EXPECT_TRUE(capabilities.write(encode(contract::Capabilities{.name = "r2", .length = length})));
  run(3s);
  EXPECT_THAT(refused, testing::ElementsAre("r2: length of 600 m (expected 0, or 0.05 to 20)"));
  ASSERT_NE(peers.find("r2"), nullptr);
  EXPECT_FLOAT_EQ(peers.find("r2")->length, 0.6F);
}

TEST_F(RadioEdgeTest, OfARevokedCommandComponentNeitherWritesNorReads) {
  held.release();
  int states{};
  const auto reader = wire::make_reader(*station, wire::topics::kRobotState, *strand,
                                        [&](const radio::RobotState&, const wire::SampleInfo&) { ++states; });
  run(3s);
  edge->send_state({.stamp = 1});
  send_stick();
  run(100ms);
  generation->revoke();
  edge->send_state({.stamp = 2});
  send_stick();
  run(100ms);
  EXPECT_EQ(states, 1);
  EXPECT_EQ(bench.requests.sticks.size(), 1U);
}

}  // namespace
}  // namespace adit::agent
