// SPDX-License-Identifier: Apache-2.0
// bench_map_insert: inserting scans into SubmapGrid and into OctoMap's OcTree, as a table.
#include <fmt/format.h>
#include <octomap/octomap.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "bench/nav/calibration.hpp"
#include "bench/perception/leaf_equality.hpp"
#include "bench/perception/map_scans.hpp"

namespace {

using namespace adit;
using namespace adit::bench;

constexpr double kResolution = 0.1;  ///< m
constexpr float kMaxRange = 20.0f;   ///< m
constexpr double kTimeGoal = 0.1, kMemoryGoal = 0.5, kEqualGoal = 0.99;

struct Row {
  const char* name;
  const char* what;
  int rings, columns;
  Result<std::vector<MapScan>> (*scans)(const sim::LidarParams&, int);
};
constexpr std::array<Row, 4> kRows{{{"building-16", "geb079, 16 x 900", 16, 900, building_scans},
                                    {"building-32", "geb079, 32 x 900", 32, 900, building_scans},
                                    {"hall-32", "hall of 36 m, 32 x 900", 32, 900, hall_scans},
                                    {"hall-64", "hall of 36 m, 64 x 900", 64, 900, hall_scans}}};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

struct Measured {
  std::size_t points{};     ///< Of a scan, mean.
  double ours{}, theirs{};  ///< Time of an insertion, median, ms.
  double slowest{};         ///< Of ours, ms.
  std::size_t our_bytes{}, their_bytes{};
  LeafEquality equality{};
};

Measured measure(const std::vector<MapScan>& scans) {
  Measured out;
  perception::SubmapGrid grid(kResolution);
  octomap::OcTree tree(kResolution);
  std::vector<double> ours, theirs;
  for (const MapScan& scan : scans) {
    out.points += scan.points.size() / scans.size();
    double begin = thread_cpu_ms();
    grid.insert(scan.origin, scan.points, kMaxRange);
    ours.push_back(thread_cpu_ms() - begin);
    octomap::Pointcloud cloud;
    for (const Eigen::Vector3f& p : scan.points) cloud.push_back(p.x(), p.y(), p.z());
    begin = thread_cpu_ms();
    tree.insertPointCloud(cloud, octomap::point3d(scan.origin.x(), scan.origin.y(), scan.origin.z()),
                          kMaxRange);
    theirs.push_back(thread_cpu_ms() - begin);
  }
  out.ours = median(ours);
  out.theirs = median(theirs);
  out.slowest = *std::max_element(ours.begin(), ours.end());
  tree.prune();
  out.our_bytes = grid.bytes();
  out.their_bytes = tree.memoryUsage();
  out.equality = compare(grid, tree);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Inserting scans into SubmapGrid and into OctoMap's OcTree: voxels of 0.1 m, 20 m.",
               "bench_map_insert"};
  int scans = 12;
  std::vector<std::string> wanted, names;
  for (const Row& row : kRows) names.emplace_back(row.name);
  app.add_option("--rows", wanted, "building-16, building-32, hall-32, hall-64 (default all)")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  app.add_option("--scans", scans, "of a row, 0.2 m apart")->capture_default_str()->check(CLI::Range(1, 80));
  CLI11_PARSE(app, argc, argv);

  const double unit = calibration_unit_ms();
  fmt::print(
      "| scans | points | ours, ms (units) | slowest, ms | OctoMap, ms | time | memory, kB | memory | equal, "
      "of ours / "
      "OctoMap's / its occupied | |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  bool ok = true;
  for (const Row& row : kRows) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), row.name) == wanted.end()) continue;
    sim::LidarParams lidar;
    lidar.rings = row.rings;
    lidar.columns = row.columns;
    const auto made = row.scans(lidar, scans);
    if (!made) {
      std::fprintf(stderr, "bench_map_insert: %s\n", made.error().text.c_str());
      return 2;
    }
    const Measured m = measure(*made);
    const double time = m.ours / m.theirs;
    const double memory = static_cast<double>(m.our_bytes) / static_cast<double>(m.their_bytes);
    const LeafEquality& e = m.equality;
    const bool holds =
        time <= kTimeGoal && memory <= kMemoryGoal && std::min(e.of_ours(), e.of_theirs()) >= kEqualGoal;
    ok = ok && holds;
    fmt::print(
        "| {} | {} | {:.2f} ({:.2f}) | {:.2f} | {:.1f} | {:.3f} | {} / {} | {:.2f} | {:.4f} / {:.4f} / "
        "{:.4f} | {} |\n",
        row.what, m.points, m.ours, m.ours / unit, m.slowest, m.theirs, time, m.our_bytes / 1000,
        m.their_bytes / 1000, memory, e.of_ours(), e.of_theirs(), e.of_occupied(),
        holds ? "holds" : "MISSED");
    std::fflush(stdout);
  }
  fmt::print("\nA unit of calibration: {:.2f} ms. Goals: time <= {}, memory <= {}, equal >= {}.\n", unit,
             kTimeGoal, kMemoryGoal, kEqualGoal);
  return ok ? 0 : 1;
}
