// SPDX-License-Identifier: Apache-2.0
// What the command strand of a complete agent spends on scans and maps, in processor time of its thread.
// These are measurements of this machine, and so run alone.
#include <gtest/gtest.h>

#include "adit/bulk.h"
#include "basestation/station/station.hpp"
#include "core/config/platform_file.hpp"
#include "core/transfer/piece.hpp"
#include "perception/stream/piece.hpp"
#include "tests/agent/agent_bench.hpp"
#include "tests/agent/large_map.hpp"
#include "tests/agent/timed_runtime.hpp"

namespace adit::agent {
namespace {

constexpr double kScanLimit = 1.0;   // ms of one task with a scan, 262 000 points.
constexpr double kPieceLimit = 5.0;  // ms of one task with pieces of the map.
constexpr std::size_t kPoints = 262'000;
constexpr std::size_t kBlocks = 190'000;

/// An agent whose strands are measured.
struct TimedAgent {
  explicit TimedAgent(AgentParams params)
      : bench(std::move(params), 1, source_folder() + "/config/trees/robot.xml",
              [this](std::unique_ptr<Runtime> machine) {
                auto timed = std::make_unique<TimedRuntime>(std::move(machine));
                runtime = timed.get();
                return timed;
              }) {}
  /// What the command strand used meanwhile.
  StrandUse run(Duration span) {
    StrandUse& use = runtime->use("command");
    use = {};
    bench.run(span);
    std::printf("command strand, %.1f s: %zu tasks, longest %.2f ms, %.1f ms a second\n", seconds(span),
                use.tasks, use.longest, use.sum / seconds(span));
    for (const auto& [job, count] : use.jobs) std::printf("  %s: %zu\n", job.c_str(), count);
    return use;
  }

  TimedRuntime* runtime{};
  AgentBench bench;
};

AgentParams robot(PerceptionLevel perception) {
  AgentParams params{};
  params.name = "r1";
  params.platform = config::load_platform("wheeled").value();
  params.perception = perception;
  return params;
}

class StrandTime : public testing::TestWithParam<PerceptionLevel> {};

TEST_P(StrandTime, OfAScanOf262000PointsIsBelowAMillisecond) {
  TimedAgent agent(robot(GetParam()));
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double bearing = 2 * M_PI * static_cast<double>(i % 2048) / 2048;
    const double height = 2.0 * static_cast<double>(i / 2048) / 128;
    const double range = 5.0 / std::max(std::fabs(std::cos(bearing)), std::fabs(std::sin(bearing)));
    agent.bench.obstacles.emplace_back(static_cast<float>(range * std::cos(bearing)),
                                       static_cast<float>(range * std::sin(bearing)),
                                       static_cast<float>(height));
  }
  agent.bench.run(1s);
  EXPECT_LT(agent.run(2s).longest, kScanLimit);
}

INSTANTIATE_TEST_SUITE_P(Perception, StrandTime, testing::Values(PerceptionLevel::off, PerceptionLevel::slam),
                         [](const auto& each) {
                           return each.param == PerceptionLevel::off ? "off" : "slam";
                         });

TEST(StrandTime, OfAMapOf190000BlocksForALateStationIsBelow5Milliseconds) {
  AgentParams params = robot(PerceptionLevel::slam);
  params.disk = disk_with_map("r1", kBlocks);
  TimedAgent agent(std::move(params));
  agent.bench.run(2s);
  const auto machine = agent.bench.machine("late");
  const auto strand = machine->strand("station");
  const auto radio = agent.bench.network().join(77, "late");
  station::StationParams late{};
  late.name = "late";
  late.id[0] = 9;
  station::Station station(late, *strand, *radio);
  ASSERT_TRUE(station.start());
  EXPECT_LT(agent.run(10s).longest, kPieceLimit);
  EXPECT_GT(station.map().blocks(), 1000U) << "it comes";
}

TEST(StrandTime, OfCarriedPiecesIsBelow5Milliseconds) {
  AgentParams params = robot(PerceptionLevel::off);
  params.carry_maps = true;
  TimedAgent agent(std::move(params));
  const auto other = agent.bench.network().join(77, "r2");
  auto capabilities = wire::Writer<radio::Capabilities>::make(*other, wire::topics::kCapabilities).value();
  auto presence = wire::Writer<radio::Presence>::make(*other, wire::topics::kPresence).value();
  auto bulk = wire::Writer<radio::BulkPiece>::make(*other, wire::topics::kBulk, wire::topics::kCarryPartition)
                  .value();
  radio::Capabilities self;
  self.name("r2");
  self.kind(radio::AGENT_ROBOT);
  self.id({7});
  self.protocol(1);
  (void)capabilities.write(self);
  const Timer beat = agent.bench.strand().every(500ms, [&] {
    radio::Presence sample;
    sample.name("r2");
    sample.kind(radio::AGENT_ROBOT);
    sample.id({7});
    sample.protocol(1);
    (void)presence.write(sample);
  });
  std::uint32_t id = 0;
  // Four pieces arrive together, each of 512 blocks that take nearly nothing, 20 times a second.
  const Timer send = agent.bench.strand().every(50ms, [&] {
    for (int n = 0; n < 4; ++n) {
      std::vector<perception::BlockUpdate> blocks;
      for (std::int32_t i = 0; i < 512; ++i)
        blocks.push_back({{{i % 32, i / 32, static_cast<std::int32_t>(id)}, ~0ULL, 0}, id + 1});
      radio::BulkPiece piece;
      piece.robot("r2");
      piece.session(3);
      piece.id(++id);
      piece.kind(static_cast<std::uint8_t>(transfer::Kind::map_blocks));
      piece.data(perception::pack({"r2", 5, 0}, blocks, 1200).bytes);
      (void)bulk.write(piece);
    }
  });
  agent.bench.run(3s);
  EXPECT_LT(agent.run(5s).longest, kPieceLimit);
}

}  // namespace
}  // namespace adit::agent
