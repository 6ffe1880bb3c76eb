// SPDX-License-Identifier: Apache-2.0
// bench_nav_real: navigation on a real building's map, on tilted ground and on real scans, as a table.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "bench/nav_real/before.hpp"
#include "bench/nav_real/rows.hpp"

namespace {

using namespace adit;
using namespace adit::bench;

struct Row {
  const char* name;
  Result<RowResults> (*run)(const RowOptions&);
};
constexpr std::array<Row, 6> kRows{{{"goals", goals_row},
                                    {"doors", doors_row},
                                    {"straight", straight_row},
                                    {"impossible", impossible_row},
                                    {"tilt", tilt_row},
                                    {"street", street_row}}};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Navigation on a real building's map, on tilted ground and on real scans.", "bench_nav_real"};
  RowOptions options;
  std::vector<std::string> wanted, names;
  for (const Row& row : kRows) names.emplace_back(row.name);
  app.add_option("--rows", wanted, "goals, doors, straight, impossible, tilt, street (default all)")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  app.add_option("--platforms", options.platforms, "default wheeled,tracked,legged")->delimiter(',');
  app.add_option("--goals", options.goals, "a platform")->capture_default_str()->check(CLI::Range(1, 100000));
  app.add_option("--seeds", options.seeds, "of each door and of the straight drive")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  app.add_option("--impossible", options.impossible, "goals where no robot can stand")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  app.add_option("--first", options.first, "the first seed")->capture_default_str();
  app.add_option("--minutes", options.minutes,
                 "each part of a row ends after so long and shows what it has (default: never)");
  app.add_option("--clouds", options.clouds,
                 "folder of street scans, KITTI's .bin or .pcd, for the row street");
  app.add_option("--poses", options.poses, "of base_link at each of them, TUM: accumulates them, too");
  app.add_option("--lidar-height", options.lidar_height, "of the street scans above the ground, m")
      ->capture_default_str();
  app.add_flag("--each", options.each, "a line for each run that is not as it should be");
  app.add_option("--save", options.save, "folder for the scenarios of those runs, for rehearse");
  app.footer(
      "One process uses one core.\nExamples:\n"
      "  ./run bench nav-real --rows goals --platforms tracked --goals 10 --each\n"
      "  ./run bench nav-real --rows doors --seeds 3\n"
      "  ./run bench nav-real --rows street --clouds velodyne_points/data --poses street.tum");
  CLI11_PARSE(app, argc, argv);

  fmt::print("| row | measured | goal | at {} | command: bench_nav_real |\n| --- | --- | --- | --- | --- |\n",
             kBeforeCommit);
  bool ok = true;
  for (const Row& row : kRows) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), row.name) == wanted.end()) continue;
    const auto results = row.run(options);
    if (!results) {
      std::fprintf(stderr, "bench_nav_real: %s: %s\n", row.name, results.error().text.c_str());
      return 2;
    }
    for (const RowResult& result : *results) {
      fmt::print("| {} | {} | {} | {} | --rows {} |\n", result.what, result.measured,
                 result.goal.empty() ? "" : result.goal + (result.ok ? ": holds" : ": MISSED"),
                 before(result.what), row.name);
      ok = ok && (result.ok || result.goal.empty());
    }
    std::fflush(stdout);
  }
  return ok ? 0 : 1;
}
