// SPDX-License-Identifier: Apache-2.0
// bench_stairs: staircases, and what looks like one, in simulated clouds, as a table.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/nav/calibration.hpp"
#include "perception/stairs/stairs_detector.hpp"
#include "tests/perception/stairs/scene.hpp"

namespace {

using namespace adit;
using namespace adit::bench;
namespace scenes = perception::scenes;

struct Options {
  std::size_t cases{150};
  std::uint64_t first{1};
  std::vector<double> noise{0.0, 0.01, 0.02, 0.03};  // m
  std::vector<std::string> rows{"open", "walled", "down", "false"};
  double tilt{1.0};  // degrees
  int sweeps{15};
  bool each{false};
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Row {
  std::size_t cases{}, found{}, whole{}, wrong{};
  std::vector<double> rise{}, run{}, width{}, ms{};
};

/// Whether a flight is part of the true one. Steps that are out of view are an error of the count, not
/// another flight.
bool same(const Staircase& found, const Staircase& truth) {
  const Eigen::Vector3d off = found.foot - truth.foot;
  const Eigen::Vector2d ahead = truth.direction();
  const double along = off.head<2>().dot(ahead), length = (truth.steps - found.steps) * truth.run;
  return std::abs(wrap_angle(found.heading - truth.heading)) < 0.17 &&
         std::abs(off.x() * ahead.y() - off.y() * ahead.x()) < 0.3 && along > -1.5 * truth.run &&
         along < length + 1.5 * truth.run && std::abs(off.z() - along * truth.rise / truth.run) < 0.15 &&
         std::abs(found.rise - truth.rise) < 0.02 && std::abs(found.run - truth.run) < 0.03;
}

void run_case(const std::string& name, std::uint64_t seed, double noise, const Options& options, Row& row) {
  Random random = Random(seed).fork(7);
  scenes::Scene scene;
  if (const auto row_of = std::ranges::find(scenes::kRows, name); row_of != scenes::kRows.end())
    scene = scenes::staircase(static_cast<scenes::Row>(row_of - scenes::kRows.begin()), random);
  else if (const auto kind = std::ranges::find(scenes::kNotStairs, name); kind != scenes::kNotStairs.end())
    scene = scenes::not_stairs(static_cast<std::size_t>(kind - scenes::kNotStairs.begin()), random);
  else
    scene = scenes::not_stairs(seed, random);
  scenes::Sensing sensing{.sweeps = options.sweeps, .tilt = options.tilt * M_PI / 180.0};
  sensing.lidar.noise = noise;
  const scenes::Cloud cloud = scenes::sense(scene, sensing, random);
  static perception::StairsDetector detector;
  const double begin = thread_cpu_ms();
  const std::vector<Staircase> found = detector.detect(cloud.points, cloud.eye);
  row.ms.push_back(thread_cpu_ms() - begin);
  ++row.cases;
  const bool sought = scene.truth.has_value();
  const Staircase truth = sought ? scenes::seen_from(scene, *scene.truth) : Staircase{};
  bool hit = false;
  for (const Staircase& stairs : found) {
    if (!sought || hit || !same(stairs, truth)) {
      ++row.wrong;
    } else {
      hit = true;
      row.whole += stairs.steps == truth.steps ? 1 : 0;
      row.rise.push_back(std::abs(stairs.rise - truth.rise));
      row.run.push_back(std::abs(stairs.run - truth.run));
      row.width.push_back(std::abs(stairs.width - truth.width));
    }
    if (options.each)
      fmt::print(
          "    foot {:.2f} {:.2f} {:.2f} heading {:.2f} rise {:.3f} run {:.3f} width {:.2f} steps {}\n",
          stairs.foot.x(), stairs.foot.y(), stairs.foot.z(), stairs.heading, stairs.rise, stairs.run,
          stairs.width, stairs.steps);
  }
  row.found += hit ? 1 : 0;
  if (options.each && sought)
    fmt::print(
        "  {} {}: {} truth foot {:.2f} {:.2f} {:.2f} heading {:.2f} rise {:.3f} run {:.3f} width {:.2f} "
        "steps {}\n",
        name, seed, hit ? "ok" : "MISSED", truth.foot.x(), truth.foot.y(), truth.foot.z(), truth.heading,
        truth.rise, truth.run, truth.width, truth.steps);
  else if (options.each)
    fmt::print("  {} {} ({}): {}\n", name, seed, scenes::kNotStairs[seed % scenes::kNotStairs.size()],
               found.size());
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "bench_stairs: staircases, and what looks like one, in simulated clouds of a legged robot's lidar");
  app.add_option("--cases", options.cases, "a row and noise")->capture_default_str();
  app.add_option("--first", options.first, "seed")->capture_default_str();
  app.add_option("--noise", options.noise, "standard deviations of a range, m")->capture_default_str();
  app.add_option(
         "--rows", options.rows,
         "open, walled, down, winding, clutter, half, door, grating, mirror; false, or one of its kinds")
      ->capture_default_str();
  app.add_option("--tilt", options.tilt, "error of the attitude, degrees")->capture_default_str();
  app.add_option("--sweeps", options.sweeps, "in a cloud, at 10 Hz")->capture_default_str();
  app.add_flag("--each", options.each, "print each case");
  CLI11_PARSE(app, argc, argv);
  fmt::print("row     noise  found    whole  wrong  rise mm  run mm  width mm  ms median  worst\n");
  for (const std::string& name : options.rows)
    for (const double noise : options.noise) {
      Row row;
      const std::size_t cases = name == "false" ? 3 * options.cases : options.cases;
      for (std::size_t n = 0; n < cases; ++n) run_case(name, options.first + n, noise, options, row);
      fmt::print("{:<7} {:.2f}   {:>3}/{:<4} {:>5}  {:>5}  {:>7.1f} {:>7.1f} {:>9.0f} {:>10.2f} {:>6.2f}\n",
                 name, noise, row.found, row.cases, row.whole, row.wrong, 1e3 * median(row.rise),
                 1e3 * median(row.run), 1e3 * median(row.width), median(row.ms),
                 *std::max_element(row.ms.begin(), row.ms.end()));
      std::fflush(stdout);
    }
  return 0;
}
