// SPDX-License-Identifier: Apache-2.0
// What the command strand of a complete agent leaves to `compute`: the work that grows with scans and maps.
#include <gtest/gtest.h>

#include "basestation/station/station.hpp"
#include "core/config/platform_file.hpp"
#include "tests/agent/agent_bench.hpp"
#include "tests/agent/large_map.hpp"
#include "tests/agent/timed_runtime.hpp"

namespace adit::agent {
namespace {

TEST(StrandWork, ObstaclesKeyframesAndPiecesAreWorkedOutByCompute) {
  AgentParams params{};
  params.name = "r1";
  params.platform = config::load_platform("wheeled").value();
  params.perception = PerceptionLevel::slam;
  params.disk = disk_with_map("r1", 1000);
  TimedRuntime* runtime = nullptr;
  AgentBench bench(std::move(params), 1, source_folder() + "/config/trees/robot.xml",
                   [&](std::unique_ptr<Runtime> machine) {
                     auto timed = std::make_unique<TimedRuntime>(std::move(machine));
                     runtime = timed.get();
                     return timed;
                   });
  for (int i = 0; i < 4000; ++i) {
    const float bearing = static_cast<float>(i % 400) * 0.0157F;
    bench.obstacles.emplace_back(4.0F * std::cos(bearing), 3.0F * std::sin(bearing),
                                 static_cast<float>(i / 400) * 0.2F);
  }
  bench.force = Eigen::Vector3d(0, 0, 9.81);
  const auto machine = bench.machine("late");
  const auto strand = machine->strand("station");
  const auto radio = bench.network().join(77, "late");
  station::StationParams late{};
  late.name = "late";
  late.id[0] = 9;
  station::Station station(late, *strand, *radio);
  ASSERT_TRUE(station.start());
  bench.run(6s);
  const auto& jobs = runtime->use("command").jobs;
  const auto count = [&](const char* name) { return jobs.contains(name) ? jobs.at(name) : 0; };
  EXPECT_GE(count("obstacles"), 55U) << "one a scan";
  EXPECT_GE(count("make keyframe"), 1U);
  EXPECT_GE(count("map piece"), 2U);
  EXPECT_GT(station.map().blocks(), 900U);
}

}  // namespace
}  // namespace adit::agent
