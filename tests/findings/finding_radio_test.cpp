// SPDX-License-Identifier: Apache-2.0
// An agent's findings on the radio, at two stations: what they cost.
#include <gtest/gtest.h>

#include <iostream>

#include "basestation/station/station.hpp"
#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "core/wire/memory/simulated_network.hpp"
#include "robot_agent/agent.hpp"
#include "tests/findings/some.hpp"
#include "tests/folders/folders.hpp"

namespace adit {
namespace {

using namespace std::chrono_literals;

/// Of all participants in a minute.
struct Cost {
  double bytes{};       ///< On the air.
  double samples{};     ///< Of them for pieces of content and their acknowledgements.
  std::size_t there{};  ///< Findings, at both stations.
};

Cost minute_with(std::size_t findings, std::uint64_t seed) {
  VirtualScheduler scheduler(seed);
  wire::SimulatedNetwork network(
      scheduler,
      {.seed = seed, .link = {.name = "mesh_100k", .bandwidth = 100e3, .latency = 0.15, .loss = 0.1}});
  const auto robot_machine = scheduler.machine("r1", 77777s);
  std::vector<std::unique_ptr<wire::Participant>> radio;
  radio.push_back(network.join(77, "r1"));
  const auto inner = network.join(100, "r1");
  agent::AgentParams params;
  params.tree = source_folder() + "/config/trees/robot.xml";
  params.seed = seed;
  params.disk = std::make_shared<store::MemoryDisk>();
  agent::Agent robot(params, *robot_machine, *radio[0], *inner);
  EXPECT_TRUE(robot.start().ok());
  std::vector<std::unique_ptr<Runtime>> machines;
  std::vector<std::shared_ptr<Executor>> strands;
  std::vector<std::unique_ptr<station::Station>> stations;
  for (const std::uint8_t number : {1, 2}) {
    const std::string name = "op" + std::to_string(number);
    radio.push_back(network.join(77, name));
    machines.push_back(scheduler.machine(name, 5s));
    strands.push_back(machines.back()->strand("station"));
    station::StationParams op;
    op.name = name;
    op.id = {number};
    op.disk = std::make_shared<store::MemoryDisk>();
    stations.push_back(std::make_unique<station::Station>(op, *strands.back(), *radio.back()));
    EXPECT_TRUE(stations.back()->start().ok());
  }
  scheduler.run_until(30s);
  const auto total = [&radio] {
    Cost cost;
    for (const auto& each : radio) {
      const wire::WireCounters counters = each->counters();
      cost.bytes += static_cast<double>(counters.total_out);
      for (const wire::TopicCount& count : counters.topics)
        if (count.topic.find("bulk") != std::string::npos || count.topic.find("finding") != std::string::npos)
          cost.samples += static_cast<double>(count.bytes_out);
    }
    return cost;
  };
  const Cost before = total();
  for (std::uint64_t id = 1; id <= findings; ++id) robot.report(findings::some(id, 1 + id % 9));
  scheduler.run_until(90s);
  Cost cost = total();
  cost.bytes -= before.bytes;
  cost.samples -= before.samples;
  for (const auto& station : stations) cost.there += station->findings();
  return cost;
}

TEST(FindingRadio, TwentyFindingsForTwoStationsCostFewBytesOnAThinLink) {
  Cost more;
  constexpr int kSeeds = 4;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Cost without = minute_with(0, seed), with = minute_with(20, seed);
    EXPECT_EQ(with.there, 40U);
    more.bytes += (with.bytes - without.bytes) / kSeeds;
    more.samples += (with.samples - without.samples) / kSeeds;
  }
  std::cout << "20 findings to two stations on mesh_100k: " << more.samples << " bytes of samples, "
            << more.bytes << " bytes in all\n";
  EXPECT_LT(more.samples, 11000.0);
}

}  // namespace
}  // namespace adit
