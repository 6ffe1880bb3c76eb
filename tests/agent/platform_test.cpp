// SPDX-License-Identifier: Apache-2.0
// The platform's file decides which components a robot starts and which capabilities it announces.
#include <gmock/gmock.h>

#include "core/config/platform_file.hpp"
#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using testing::UnorderedElementsAre;

struct Sheet {
  std::vector<std::string> components{}, services{};
  bool holonomic{};
};

Sheet launched(const std::string& platform) {
  AgentParams params{};
  params.name = "r1";
  params.platform = config::load_platform(platform).value();
  AgentBench bench(params);
  auto& op = bench.join("op1");
  bench.run(7s);
  Sheet sheet{.services = op.capabilities.services(), .holonomic = op.capabilities.holonomic()};
  for (const auto& c : op.health.components()) sheet.components.push_back(c.name());
  return sheet;
}

TEST(PlatformSwap, OneWordInARobotsFileDecidesWhatIsLaunched) {
  const Sheet wheeled = launched("wheeled"), legged = launched("legged"), car = launched("car"),
              aerial = launched("aerial");
  EXPECT_THAT(wheeled.services, UnorderedElementsAre("route", "tilt", "map_revision", "turn_on_spot"));
  EXPECT_THAT(legged.services,
              UnorderedElementsAre("route", "tilt", "map_revision", "turn_on_spot", "stairs"));
  EXPECT_THAT(car.services, UnorderedElementsAre("route", "tilt", "map_revision"));
  EXPECT_THAT(aerial.services, UnorderedElementsAre("tilt", "map_revision", "turn_on_spot", "flight"));
  EXPECT_THAT(wheeled.components, UnorderedElementsAre("command", "driver", "planner", "router", "sensors"));
  EXPECT_THAT(aerial.components, UnorderedElementsAre("command", "driver", "planner", "sensors"));
  EXPECT_TRUE(legged.holonomic && aerial.holonomic);
  EXPECT_FALSE(wheeled.holonomic || car.holonomic);
}

TEST(PlatformSwap, ARobotThatCarriesMapsSaysSo) {
  AgentParams params{};
  params.name = "r1";
  params.platform = config::load_platform("wheeled").value();
  params.carry_maps = true;
  AgentBench bench(params);
  auto& op = bench.join("op1");
  bench.run(7s);
  EXPECT_THAT(op.capabilities.services(), testing::Contains("carry_map"));
}

TEST(PlatformSwap, APlatformThatDoesNotFitTheDriveIsReportedAtTheStart) {
  const auto start = [](const auto& change) {
    AgentParams params{};
    params.name = "r1";
    params.platform = config::load_platform("car").value();
    change(params.platform);
    try {
      AgentBench bench(params);
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string("started");
  };
  EXPECT_EQ(start([](Platform&) {}), "started");
  EXPECT_THAT(start([](Platform& p) { p.planner = "trajectories"; }),
              testing::HasSubstr("turns on the spot"));
  EXPECT_THAT(start([](Platform& p) { p = config::load_platform("aerial").value(), p.router = "graph"; }),
              testing::HasSubstr("over ground"));
}

}  // namespace
}  // namespace adit::agent
