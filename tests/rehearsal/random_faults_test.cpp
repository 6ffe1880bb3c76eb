// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/random_faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
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
  const RandomFaults spec{200, 5s, 40s, random_fault_kinds(scenario)};
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
  const RandomFaults spec{500, 5s, 40s, random_fault_kinds(scenario)};
  const auto faults = draw_faults(spec, scenario, Random(3));
  std::set<std::string> kinds;
  for (const Fault& fault : faults) kinds.insert(kind_of(fault));
  EXPECT_EQ(kinds.size(), 13U) << "as many as there are keys";
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

/// The same team with perception, with all sensors.
std::string perceiving() {
  std::string text = kTeam;
  return text.replace(text.find("duration: 60"), 12, "duration: 60\nperception: odometry\nlidar: full");
}

TEST(RandomFaults, FaultsOfDriversComeUpWithPerceptionOnlyAndCanBeWrittenDown) {
  const std::set<std::string> of_drivers{"slip",     "turn_slip",      "driver_clock",
                                         "no_stamp", "driver_restart", "lose_columns"};
  for (const auto& [text, expected] : {std::pair{std::string(kTeam), std::size_t{0}}, {perceiving(), 6}}) {
    const Scenario scenario = *parse_scenario(text, "t.yaml");
    const auto faults = draw_faults({500, 5s, 40s}, scenario, Random(3));
    std::set<std::string> kinds;
    for (const Fault& fault : faults)
      if (of_drivers.contains(kind_of(fault))) kinds.insert(kind_of(fault));
    EXPECT_EQ(kinds.size(), expected);
    const auto again = parse_scenario(text + text_of(faults), "t.yaml");
    ASSERT_TRUE(again.ok()) << again.error().text;
    EXPECT_EQ(text_of(again->faults), text_of(faults));
  }
  const auto named = parse_scenario(
      std::string(kTeam) + "random_faults: {faults: 3, from: 0, to: 9, kinds: [slip]}\n", "t.yaml");
  ASSERT_FALSE(named.ok()) << "perception is off";
  EXPECT_EQ(named.error().text.find("t.yaml:9: "), 0U) << named.error().text;
}

TEST(RandomFaults, APlanarRobotHasNoFaultOfSweepsAndNoImu) {
  std::string text = perceiving();
  text.replace(text.find("lidar: full"), 11, "lidar: planar");
  const Scenario scenario = *parse_scenario(text, "t.yaml");
  const auto faults = draw_faults({500, 5s, 40s}, scenario, Random(3));
  const auto again = parse_scenario(text + text_of(faults), "t.yaml");
  EXPECT_TRUE(again.ok()) << again.error().text;
}

TEST(RandomFaults, ARobotThatPerceivesAlwaysHasItsLidarOrItsOdometry) {
  const Scenario scenario = *parse_scenario(perceiving(), "t.yaml");
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    // Per robot and sensor (lidar, odometry), in steps of 50 ms.
    std::map<std::pair<std::string, Sensor>, std::set<std::int64_t>> without;
    const auto note = [&](const Fault& fault, const std::string& robot, Sensor sensor, Duration duration) {
      for (Duration t = fault.at; t <= fault.at + duration; t += 50ms)
        without[{robot, sensor}].insert(t / 50ms);
    };
    for (const Fault& fault : draw_faults({60, 5s, 50s}, scenario, Random(seed))) {
      if (const auto* f = std::get_if<SensorSilent>(&fault.what))
        note(fault, f->robot, f->sensor, f->duration);
      if (const auto* f = std::get_if<DriverClock>(&fault.what))
        note(fault, f->robot, f->sensor, f->duration);
      if (const auto* f = std::get_if<NoStamp>(&fault.what)) note(fault, f->robot, f->sensor, f->duration);
      if (const auto* f = std::get_if<Slip>(&fault.what))
        note(fault, f->robot, Sensor::odometry, f->duration);
    }
    for (const char* robot : {"r1", "r2"}) {
      std::vector<std::int64_t> both;
      const auto &lidar = without[{robot, Sensor::lidar}], &odometry = without[{robot, Sensor::odometry}];
      std::set_intersection(lidar.begin(), lidar.end(), odometry.begin(), odometry.end(),
                            std::back_inserter(both));
      EXPECT_EQ(both.size(), 0U) << "seed " << seed << ' ' << robot;
    }
  }
}

TEST(RandomFaults, FindingsComeBesideThemAndChangeNoFault) {
  const Scenario scenario = *parse_scenario(kTeam, "t.yaml");
  RandomFaults spec{30, 5s, 40s, random_fault_kinds(scenario)};
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
  const RandomFaults spec{50, 5s, 40s, random_fault_kinds(scenario)};
  EXPECT_EQ(text_of(draw_faults(spec, scenario, Random(1))), text_of(draw_faults(spec, scenario, Random(1))));
  EXPECT_NE(text_of(draw_faults(spec, scenario, Random(1))), text_of(draw_faults(spec, scenario, Random(2))));
}

}  // namespace
}  // namespace adit::sim
