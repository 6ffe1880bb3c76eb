// SPDX-License-Identifier: Apache-2.0
#include "bench/nav_real/site.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core/config/platform_file.hpp"
#include "core/config/search.hpp"

namespace adit::bench {
namespace {

void save_run(const RowOptions& options, const std::string& row, const GoalRun& run) {
  if (options.save.empty()) return;
  std::filesystem::create_directories(options.save);
  const std::string name = fmt::format("{}_{}_{}.yaml", row.substr(0, row.find(' ')), run.platform, run.seed);
  std::ofstream(std::filesystem::path(options.save) / name) << scenario_text(run);
}

}  // namespace

Result<Site> open_site() {
  const auto file = config::find_file("geb079.bt");
  if (!file) return file.error();
  auto world = sim::load_octomap(*file);
  if (!world) return world.error();
  auto agents = sim::make_agent_factory();
  if (!agents) return agents.error();
  return Site{std::make_shared<const sim::World>(std::move(*world)), *agents};
}

Result<TrueMap> map_of(const Site& site, const std::string& platform) {
  const auto body = config::load_platform(platform, {});
  if (!body) return body.error();
  return TrueMap(*site.world, *body);
}

void print_run(const RowOptions& options, const std::string& row, const GoalRun& run,
               const GoalResult& result, double shortest) {
  save_run(options, row, run);
  if (!options.each) return;
  fmt::print(
      "{} {} seed {}: ({:.2f}, {:.2f}, {:.2f}) to ({:.2f}, {:.2f}), shortest {:.1f} m: {} after {:.1f} s, "
      "{:.1f} m driven, {} contacts {} {}\n",
      row, run.platform, run.seed, run.start.x, run.start.y, run.start.yaw, run.goal.x(), run.goal.y(),
      shortest, result.arrived ? "arrived" : "not arrived", result.seconds, result.metres, result.contacts,
      result.reason, result.error);
  std::fflush(stdout);
}

}  // namespace adit::bench
