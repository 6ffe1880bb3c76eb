// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/random_faults.hpp"

#include <gtest/gtest.h>

#include <set>

#include "sim/rehearsal/scenario_file.hpp"

namespace adit::sim {
namespace {

constexpr const char* kTeam = R"(world: {boxes: [], floor: 0, ceiling: 3}
duration: 60
robots:
  - {id: r1, platform: wheeled, pose: [0, 0, 0]}
  - {id: r2, platform: legged, pose: [4, 0, 0]}
basestations:
  - {id: op1, pose: [0, 3]}
  - {id: op2, pose: [0, -3]}
)";

std::string text_of(const std::vector<Fault>& faults) {
  std::string out = "faults:\n";
  for (const Fault& fault : faults) out += "  - " + to_yaml(fault) + "\n";
  return out;
}

TEST(RandomFaults, AreWithinTheirTimesAndSorted) {
  const Scenario scenario = *parse_scenario(kTeam, "t.yaml");
  const RandomFaults spec{200, 5s, 40s, random_fault_kinds()};
  const auto faults = draw_faults(spec, scenario, Random(3));
  ASSERT_EQ(faults.size(), 200U);
  Duration last{};
  for (const Fault& fault : faults) {
    EXPECT_GE(fault.at, std::max<Duration>(last, 5s));
    EXPECT_LE(fault.at, Duration(40s));
    last = fault.at;
  }
}

TEST(RandomFaults, EveryKindComesUpAndCanBeWrittenDown) {
  const Scenario scenario = *parse_scenario(kTeam, "t.yaml");
  const RandomFaults spec{500, 5s, 40s, random_fault_kinds()};
  const auto faults = draw_faults(spec, scenario, Random(3));
  std::set<std::string> kinds;
  for (const Fault& fault : faults) kinds.insert(kind_of(fault));
  EXPECT_EQ(kinds.size(), 12U) << "as many as there are keys";
  const auto again = parse_scenario(kTeam + text_of(faults), "t.yaml");
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_EQ(text_of(again->faults), text_of(faults));
  for (std::size_t i = 0; i < faults.size(); ++i) EXPECT_EQ(again->faults[i].at, faults[i].at);
}

TEST(RandomFaults, OnlyTheKindsAskedFor) {
  const Scenario scenario = *parse_scenario(kTeam, "t.yaml");
  for (const Fault& fault : draw_faults({50, 5s, 40s, {"hang"}}, scenario, Random(1)))
    EXPECT_EQ(kind_of(fault), "hang");
}

TEST(RandomFaults, FindingsComeBesideThemAndChangeNoFault) {
  const Scenario scenario = *parse_scenario(kTeam, "t.yaml");
  RandomFaults spec{30, 5s, 40s, random_fault_kinds()};
  const auto without = draw_faults(spec, scenario, Random(3));
  spec.finds = 20;
  auto with = draw_faults(spec, scenario, Random(3));
  const auto again = parse_scenario(kTeam + text_of(with), "t.yaml");
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_EQ(text_of(again->faults), text_of(with));
  EXPECT_EQ(std::erase_if(with, [](const Fault& f) { return kind_of(f) == "finds"; }), 20U);
  EXPECT_EQ(text_of(with), text_of(without));
}

TEST(RandomFaults, SameSeedSameFaults) {
  const Scenario scenario = *parse_scenario(kTeam, "t.yaml");
  const RandomFaults spec{50, 5s, 40s, random_fault_kinds()};
  EXPECT_EQ(text_of(draw_faults(spec, scenario, Random(1))), text_of(draw_faults(spec, scenario, Random(1))));
  EXPECT_NE(text_of(draw_faults(spec, scenario, Random(1))), text_of(draw_faults(spec, scenario, Random(2))));
}

}  // namespace
}  // namespace adit::sim
