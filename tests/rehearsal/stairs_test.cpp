// SPDX-License-Identifier: Apache-2.0
// Staircases that robots find on their way, as findings of the station.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "basestation/station/station.hpp"
#include "sim/world/generate.hpp"
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

/// A legged robot drives towards six steps of 20 cm and back.
std::string towards_stairs(const std::string& more, int duration = 30) {
  return "world: {generate: stairs, seed: 1}\nduration: " + std::to_string(duration) +
         "\nlink: wifi\nlidar: full\nperception: odometry\n"
         "robots:\n  - {id: r1, platform: legged, pose: [2, 2.5, 0]}\n"
         "basestations:\n  - {id: op1, pose: [0, 0]}\n"
         "script:\n  - {at: 2, by: op1, do: take r1}\n  - {at: 3, by: op1, do: goto r1 6.5 2.5}\n" +
         more;
}

void expect_found(const RunReport& report) {
  EXPECT_TRUE(report.ok()) << (report.complaints().empty() ? "" : report.complaints().front());
}

/// What a station lists at some instants, s.
using Listed = std::map<int, std::vector<station::StairsItem>>;

/// Plays a scenario to its end. `truth`: of the last robot at the end; null: not needed.
Listed listed(const Scenario& scenario, std::uint64_t seed, const std::vector<int>& instants,
              Pose3* truth = nullptr) {
  RunParams params;
  params.seed = seed;
  params.make_agent = *make_agent_factory("");
  Listed out;
  params.on_station = [&](Duration now, const station::Station& station) {
    for (const int at : instants)
      if (now >= std::chrono::seconds(at) && !out.contains(at)) out[at] = station.stairs().stairs;
  };
  if (truth)
    params.on_truth = [&](Duration, const Simulation& simulation) {
      *truth = simulation.truth(scenario.robots.size() - 1).pose;
    };
  auto outcome = rehearse(scenario, *make_world(scenario.world), params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  if (outcome) expect_ok(outcome->report);
  return out;
}

/// Of the world `stairs`: the flight that climbs along x. The other one climbs the other way.
std::vector<station::StairsItem> along_x(const std::vector<station::StairsItem>& all) {
  std::vector<station::StairsItem> out;
  for (const station::StairsItem& item : all)
    if (item.stairs.direction().x() > 0) out.push_back(item);
  return out;
}

TEST(StairsRun, AFlightIsFoundOnce) {
  expect_found(
      run_text(towards_stairs("expect:\n  - {at: 28, by_operator: op1, findings: 1}\n"), "stairs.yaml"));
}

TEST(StairsRun, AFlightIsFoundOnTheWayToIt) {
  const std::uint64_t seeds = all_seeds() ? 20 : 2;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Listed at = listed(load_shipped("stairs_found.yaml"), seed, {28});
    ASSERT_TRUE(at.contains(28)) << "seed " << seed;
    ASSERT_EQ(at.at(28).size(), 1U) << "seed " << seed;
    const Staircase& stairs = at.at(28).front().stairs;
    EXPECT_EQ(stairs.steps, 6) << "seed " << seed;
    EXPECT_LT((stairs.foot - Eigen::Vector3d(8.0, 2.5, 0.1)).norm(), 0.15) << "seed " << seed;
  }
}

TEST(StairsRun, RestartsOfRobotAndStationMakeNoSecondOne) {
  expect_found(
      run_text(towards_stairs("  - {at: 20, by: op1, do: take r1}\n  - {at: 21, by: op1, do: goto r1 3 2.5}\n"
                              "  - {at: 32, by: op1, do: goto r1 6.5 2.5}\n"
                              "faults:\n  - {at: 15, crash: r1}\n  - {at: 17, crash: op1}\n"
                              "  - {at: 33, crash: r1/stairs}\n  - {at: 35, hang: r1/stairs}\n"
                              "expect:\n  - {at: 48, by_operator: op1, findings: 1}\n",
                              50),
               "stairs.yaml"));
}

/// r1 sees the flight along x from its foot, r2 from its top. r2 believes to be 0.5 m beside its place; its
/// agent and the station are restarted, and then it is at rest. `more`: of the script after that.
Scenario both_ends(int duration, const std::string& more) {
  const auto scenario = parse_scenario(
      "world: {generate: stairs, seed: 1}\nduration: " + std::to_string(duration) +
          "\nlink: wifi\nlidar: full\nperception: odometry\n"
          "robots:\n  - {id: r1, platform: legged, pose: [2, 2.5, 0]}\n"
          "  - {id: r2, platform: legged, pose: [13, 2.5, 3.1416]}\n"
          "basestations:\n  - {id: op1, pose: [0, 0]}\n"
          "faults:\n  - {at: 19, crash: r2}\n  - {at: 20, crash: op1}\n"
          "expect:\n  - {always: no_collision}\n"
          "script:\n  - {at: 1, by: op1, do: take r1 r2}\n  - {at: 2, by: op1, do: pose r2 13 3 3.1416}\n"
          "  - {at: 3, by: op1, do: goto r1 6.5 2.5}\n  - {at: 3, by: op1, do: goto r2 10.1 3}\n"
          "  - {at: 10, by: op1, do: goto r2 10.1 1.5}\n" +
          more,
      "both_ends.yaml");
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().text);
  return *scenario;
}

TEST(StairsRun, TwoRobotsSeeOneFlightFromBothEndsAndACorrectionKeepsItOne) {
  constexpr int kCorrected = 26;  // s
  Pose3 r2;
  (void)listed(both_ends(kCorrected, ""), 1, {}, &r2);
  std::array<char, 80> pose{};
  std::snprintf(pose.data(), pose.size(), "pose r2 %.3f %.3f %.4f", r2.position.x(), r2.position.y(),
                r2.yaw());
  const Listed at = listed(
      both_ends(40, "  - {at: 24, by: op1, do: take r2}\n  - {at: 25, by: op1, do: mode r2 hold}\n  - {at: " +
                        std::to_string(kCorrected) + ", by: op1, do: " + pose.data() +
                        "}\n  - {at: 28, by: op1, do: goto r2 10.1 3.5}\n"),
      1, {18, 39});
  ASSERT_TRUE(at.contains(18) && at.contains(39));
  for (const auto& [instant, items] : at) {
    const auto flights = along_x(items);
    ASSERT_EQ(flights.size(), 1U) << "after " << instant << " s";
    EXPECT_EQ(flights[0].robots, (std::vector<std::string>{"r1", "r2"})) << "after " << instant << " s";
  }
  const Staircase stairs = along_x(at.at(39)).at(0).stairs;
  EXPECT_EQ(stairs.steps, 6);
  EXPECT_LT((stairs.foot - Eigen::Vector3d(8.0, 2.5, 0.1)).norm(), 0.3) << stairs.foot.transpose();
}

/// Minutes of virtual time that a robot explores each kind of world: by ADIT_STAIRS_MINUTES, else half a one.
double minutes_of_exploring() {
  const char* wanted = std::getenv("ADIT_STAIRS_MINUTES");
  return wanted ? std::strtod(wanted, nullptr) : 0.5;
}

/// The staircases that a legged robot finds while it explores, and prints them. `way`: is added to, m.
std::size_t found_exploring(const std::string& kind, std::uint64_t seed, double minutes, double& way) {
  const auto world = generate_world(kind, seed);
  EXPECT_TRUE(world.ok());
  const std::string text =
      "world: {generate: " + kind + ", seed: " + std::to_string(seed) + "}\nseed: " + std::to_string(seed) +
      "\nduration: " + std::to_string(60.0 * minutes) +
      "\nlink: wifi\nlidar: full\nperception: odometry\nrobots:\n  - {id: r1, platform: legged, pose: [" +
      std::to_string(world->start.x()) + ", " + std::to_string(world->start.y()) +
      ", 0]}\nbasestations:\n  - {id: op1, pose: [0, 0]}\n"
      "script:\n  - {at: 1, by: op1, do: take r1}\n  - {at: 2, by: op1, do: mode r1 explore}\n";
  const auto scenario = parse_scenario(text, "exploring.yaml");
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().text);
  RunParams params;
  params.seed = seed;
  params.make_agent = *make_agent_factory("");
  std::vector<station::StairsItem> found;
  params.on_station = [&](Duration, const station::Station& station) { found = station.stairs().stairs; };
  const auto outcome = rehearse(*scenario, *make_world(scenario->world), params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  if (outcome) way += outcome->report.robots.at("r1").distance;
  for (const station::StairsItem& item : found)
    std::printf("%s seed %d: %d steps at (%.2f, %.2f, %.2f), heading %.2f, rise %.3f, run %.3f, width %.2f\n",
                kind.c_str(), static_cast<int>(seed), item.stairs.steps, item.stairs.foot.x(),
                item.stairs.foot.y(), item.stairs.foot.z(), item.stairs.heading, item.stairs.rise,
                item.stairs.run, item.stairs.width);
  return found.size();
}

class WorldsWithoutStaircases : public ::testing::TestWithParam<const char*> {};

TEST_P(WorldsWithoutStaircases, HaveNone) {
  constexpr double kRun = 5.0;  // After so many minutes, most worlds of 30 x 30 m are explored.
  double left = minutes_of_exploring(), way = 0.0;
  for (std::uint64_t seed = 1; left > 0.0; ++seed, left -= kRun)
    EXPECT_EQ(found_exploring(GetParam(), seed, std::min(left, kRun), way), 0U) << "seed " << seed;
  std::printf("%s: %.0f m in %.1f min\n", GetParam(), way, minutes_of_exploring());
  EXPECT_GT(way, 2.0);
}

INSTANTIATE_TEST_SUITE_P(Stairs, WorldsWithoutStaircases,
                         ::testing::Values("cave", "rubble", "maze", "rooms"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST(StairsRun, LegsClimbThreeFlights) {
  const Scenario scenario = load_shipped("stairs_flights.yaml");
  RunParams params;
  params.make_agent = *make_agent_factory("");
  params.seed = 1;
  params.ended = once_decided();
  auto outcome = rehearse(scenario, *make_world(scenario.world), params);
  ASSERT_TRUE(outcome.ok()) << outcome.error().text;
  expect_ok(outcome->report);
}

/// A wheeled robot with a lidar of 32 rings looks at the first flight, and is sent to the upper floor.
Scenario wheels_below(std::uint64_t world, int duration, const std::string& expectations) {
  auto scenario = parse_scenario(
      "world: {generate: flights, seed: " + std::to_string(world) +
          "}\nduration: " + std::to_string(duration) +
          "\nlink: wifi\nlidar: full\nperception: odometry\n"
          "robots:\n  - {id: r1, platform: wheeled, pose: [6, 1.2, 0]}\n"
          "basestations:\n  - {id: op1, pose: [4, 6]}\n"
          "script:\n  - {at: 2, by: op1, do: take r1}\n  - {at: 3, by: op1, do: goto r1 10.5 1.2 0}\n"
          "  - {at: 14, by: op1, do: goto r1 20 8 4.8 --budget none}\n"
          "expect:\n  - {always: no_collision}\n" +
          expectations,
      "wheels_below.yaml");
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().text);
  Platform& platform = scenario->robots[0].settings.platform;
  platform.lidar_rings = 32;
  platform.lidar_lowest = -25.0;
  return *scenario;
}

TEST(StairsRun, WheelsRefuseAGoalToWhichOnlyStairsLead) {
  for (const std::uint64_t world : {1, 3, 7}) {
    const Scenario scenario = wheels_below(world, 60, "  - {by: 58, robot: r1, told: goal_over_stairs}\n");
    RunParams params;
    params.make_agent = *make_agent_factory("");
    params.seed = 1;
    params.ended = once_decided();
    const auto outcome = rehearse(scenario, *make_world(scenario.world), params);
    ASSERT_TRUE(outcome.ok()) << outcome.error().text;
    expect_ok(outcome->report);
  }
}

}  // namespace
}  // namespace adit::sim
