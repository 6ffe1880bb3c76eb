// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/trajectories.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/folders/folders.hpp"
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

using Row = std::array<double, 8>;  // t x y z qx qy qz qw

std::vector<Row> read_tum(const std::string& file) {
  std::ifstream in(file);
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    Row row{};
    for (double& v : row) EXPECT_TRUE(words >> v) << file << ": " << line;
    EXPECT_TRUE((words >> std::ws).eof()) << "eight numbers a line: " << line;
    rows.push_back(row);
  }
  return rows;
}

struct Driven {
  RunReport report{};
  std::vector<Row> truth{}, odometry{}, map{};
};

/// A robot drives 4 m; its trajectories.
Driven drive(const std::string& noise) {
  const std::string folder = scratch_folder();
  auto scenario = parse_scenario(
      "world: {boxes: [[-4, 12, 4, 4.2, 0, 2]], floor: 0, ceiling: 3}\nduration: 10\nlink: lan\n"
      "odometry: {noise: " +
          noise +
          "}\nrobots:\n  - {id: r1, platform: wheeled, pose: [1, 2, 0]}\nbasestations:\n"
          "  - {id: op1, pose: [0, 0]}\nscript:\n  - {at: 1, by: op1, do: take r1}\n"
          "  - {at: 2, by: op1, do: goto r1 5 2}\n",
      "trajectories.yaml");
  EXPECT_TRUE(scenario.ok()) << (scenario ? "" : scenario.error().text);
  RunParams params;
  params.make_agent = *make_agent_factory("");
  params.parent_wire = make_parent_decorator("");
  params.trajectories = folder;
  auto outcome = rehearse(*scenario, *make_world(scenario->world), params);
  EXPECT_TRUE(outcome.ok()) << (outcome ? "" : outcome.error().text);
  Driven out{outcome->report};
  const TrajectoryFiles& files = out.report.trajectories.at("r1");
  out.truth = read_tum(files.truth);
  out.odometry = read_tum(files.odometry);
  out.map = read_tum(files.map);
  return out;
}

/// The largest distance of odometry, which begins at the start pose, to the truth, m.
double apart(const Driven& driven) {
  double most = 0.0;
  for (std::size_t n = 0; n < driven.truth.size(); ++n)
    most = std::max(most, std::hypot(driven.odometry[n][1] + 1.0 - driven.truth[n][1],
                                     driven.odometry[n][2] + 2.0 - driven.truth[n][2],
                                     driven.odometry[n][3] - driven.truth[n][3]));
  return most;
}

TEST(Trajectories, AreTumFilesAtFiftyHertzAndWithoutNoiseOdometryIsTheTruth) {
  const Driven driven = drive("0");
  EXPECT_EQ(driven.report.complaints(), std::vector<std::string>{});
  ASSERT_NEAR(driven.truth.size(), 500, 1);
  ASSERT_EQ(driven.odometry.size(), driven.truth.size());
  for (std::size_t n = 1; n < driven.truth.size(); ++n)
    ASSERT_NEAR(driven.truth[n][0] - driven.truth[n - 1][0], 0.02, 1e-6);
  for (const Row& row : driven.truth)
    ASSERT_NEAR(std::hypot(std::hypot(row[4], row[5]), std::hypot(row[6], row[7])), 1.0, 1e-6);
  EXPECT_NEAR(driven.truth.back()[1], 5.0, 0.3);
  EXPECT_LT(apart(driven), 1e-4);
  ASSERT_GT(driven.map.size(), 20u);
  EXPECT_NEAR(driven.map.back()[1], 5.0, 0.3);
  for (std::size_t n = 1; n < driven.map.size(); ++n)
    ASSERT_GT(driven.map[n][0], driven.map[n - 1][0]) << "once per message";
}

TEST(Trajectories, WithNoiseOdometryDrifts) {
  const Driven driven = drive("1");
  EXPECT_GT(apart(driven), 0.005);
  EXPECT_LT(apart(driven), 0.6);
}

TEST(Trajectories, AFolderThatCannotBeMadeIsRefused) {
  const auto opened = Trajectories::open("/proc/none/here", {"r1"});
  ASSERT_FALSE(opened.ok());
  EXPECT_EQ(opened.reason(), Reason::cannot_write);
}

}  // namespace
}  // namespace adit::sim
