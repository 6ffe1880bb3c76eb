// SPDX-License-Identifier: Apache-2.0
#include "bench/map_link/rows.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <thread>

#include "bench/map_link/mission.hpp"
#include "core/wire/link_file.hpp"

namespace adit::bench {
namespace {

struct Wanted {
  const char* link;
  double age;  ///< Within which 95 % of the cells are known, s.
};
constexpr std::array<Wanted, 2> kLinks{{{"mesh_500k", 5.0}, {"mesh_100k", 15.0}}};
constexpr double kRatio = 3.0;        ///< Bytes of a mission by those of the final .bt.
constexpr double kCoarse = 10.0;      ///< s
constexpr double kEverything = 60.0;  ///< s
constexpr Duration kBefore = 60s;     ///< Until the link is cut.
constexpr double kShare = 0.95;

struct World {
  const char* kind;
  std::uint64_t seed;
};
constexpr std::array<World, 3> kWorlds{{{"geb079", 7}, {"car_park", 7}, {"cave", 207}}};

struct NamedRule {
  const char* name;
  MakeRule make;
};
const std::array<NamedRule, 3>& rules() {
  static const std::array<NamedRule, 3> all{{{"Adit", make_adit_rule},
                                             {"whole .bt, zstd, 10 s", make_file_rule},
                                             {"MARBLE's diffs", make_diff_rule}}};
  return all;
}

std::vector<MissionResult> run_all(const std::vector<MapRecording>& robots, const MissionPlan& plan,
                                   bool alone) {
  std::vector<MissionResult> out(alone ? 1 : rules().size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < out.size(); ++i)
    threads.emplace_back([&, i] { out[i] = run_mission(robots, plan, rules()[i].make); });
  for (std::thread& thread : threads) thread.join();
  return out;
}

std::string time(double s) { return s < 0.0 ? "never" : fmt::format("{:.1f}", s); }
std::string time(const std::optional<Duration>& t) { return time(t ? seconds(*t) : -1.0); }
const char* verdict(bool holds) { return holds ? "holds" : "missed"; }

/// One row of each table.
struct Lines {
  std::vector<std::string> bytes{}, ages{}, causes{}, cuts{};
};

void print(const char* title, const char* columns, const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  fmt::print("\n{}\n\n{}\n|", title, columns);
  const std::string head(columns);
  for (std::size_t i = 1; i < head.size(); ++i)
    if (head[i] == '|') fmt::print(" --- |");
  fmt::print("\n");
  for (const std::string& line : lines) fmt::print("{}\n", line);
  std::fflush(stdout);
}

std::string row_17(const std::string& where, std::size_t rule, const MissionResult& r, std::size_t file) {
  const double ratio = static_cast<double>(r.robots.bytes) / static_cast<double>(file);
  return fmt::format("| {} | {} | {} | {} | {} | {} | {:.2f} | {} |", where, rules()[rule].name, file,
                     r.robots.bytes, r.robots.datagrams, r.station.bytes, ratio,
                     rule > 0 ? "" : fmt::format("{} ({:.0f})", verdict(ratio <= kRatio), kRatio));
}

std::string row_18(const std::string& where, std::size_t rule, const MissionResult& r, double wanted) {
  const double age = quantile(r.ages, kShare);
  return fmt::format(
      "| {} | {} | {} | {} | {} | {} | {:.1f} | {} |", where, rules()[rule].name, r.ages.size(),
      time(quantile(r.ages, 0.5)), time(age), time(quantile(r.ages, 1.0)), 100.0 * r.share_at_end,
      rule > 0 ? "" : fmt::format("{} ({:.0f} s)", verdict(age >= 0.0 && age <= wanted), wanted));
}

std::string row_causes(const std::string& where, const MissionResult& r) {
  const Account& a = r.account;
  const auto share = [&](std::uint64_t n) {
    return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::uint64_t>(1, a.ticks));
  };
  return fmt::format(
      "| {} | {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {} | {} / {} | {:.0f} | {:.0f} | {} / {} | {:.1f} | "
      "{} |",
      where, r.robots.bytes - a.content, a.first, a.changed, a.repeated, a.coarse, a.poses, a.sent, a.lost,
      share(a.held), share(a.paced), time(quantile(r.waits, 0.5)), time(quantile(r.waits, kShare)),
      seconds(r.after),
      r.different_voxels == 0 && r.different_blocks == 0 && r.settled
          ? "equal"
          : fmt::format("{} voxels, {} blocks{}", r.different_voxels, r.different_blocks,
                        r.settled ? "" : ", not settled"));
}

std::string row_19(const std::string& where, std::size_t rule, const MissionResult& r, double area,
                   std::size_t file) {
  const auto reached = [](const std::optional<Duration>& t, double s) { return t && seconds(*t) <= s; };
  return fmt::format(
      "| {} | {} | {:.0f} | {} | {} | {} | {} | {} | {} | {} |", where, rules()[rule].name, area, file,
      time(r.coarse_95), time(r.coarse_99), time(r.coarse_all), time(r.all_equal), r.robots.bytes,
      rule > 0 ? ""
               : fmt::format("{} ({:.0f} s), {} ({:.0f} s)", verdict(reached(r.coarse_95, kCoarse)), kCoarse,
                             verdict(reached(r.all_equal, kEverything)), kEverything));
}

Result<std::size_t> run_worlds(const RowOptions& options, Lines& lines) {
  std::size_t different = 0;
  const auto worlds = options.quick ? std::span(kWorlds).first(1) : std::span(kWorlds);
  for (const World& world : worlds) {
    const auto ground = make_ground(world.kind, world.seed);
    if (!ground) return ground.error();
    const std::string name = fmt::format("{} {}", world.kind, world.seed);
    fmt::print(stderr, "{}: three robots drive\n", name);
    const auto robots = record_team(*ground, options.seed, 3, options.quick ? 120s : 300s);
    std::size_t file = 0;
    for (const MapRecording& robot : robots) file += octree_file_bytes(final_map(robot));
    for (const Wanted& link : kLinks) {
      const auto profile = wire::load_link(link.link);
      if (!profile) return profile.error();
      const std::string where = fmt::format("{}, {}", name, link.link);
      fmt::print(stderr, "{}: rules send\n", where);
      const auto results = run_all(robots, {.link = *profile, .seed = options.seed}, options.alone);
      for (std::size_t i = 0; i < results.size(); ++i) {
        lines.bytes.push_back(row_17(where, i, results[i], file));
        lines.ages.push_back(row_18(where, i, results[i], link.age));
      }
      lines.causes.push_back(row_causes(where, results[0]));
      different += results[0].different_voxels + results[0].different_blocks;
    }
  }
  return different;
}

Result<std::size_t> run_cut(const RowOptions& options, Lines& lines) {
  const auto ground = make_ground("streets", 207);
  if (!ground) return ground.error();
  const Duration cut = options.quick ? 60s : 600s;
  fmt::print(stderr, "streets: one robot drives, {:.0f} s of it without a link\n", seconds(cut));
  const auto robots = record_team(*ground, options.seed, 1, kBefore + cut);
  const auto profile = wire::load_link("mesh_100k");
  if (!profile) return profile.error();
  const auto results = run_all(
      robots, {.link = *profile, .seed = options.seed, .cut_from = kBefore, .limit = 600s}, options.alone);
  const double area = area_seen_since(robots[0], kBefore);
  const std::size_t file = octree_file_bytes(final_map(robots[0]));
  for (std::size_t i = 0; i < results.size(); ++i)
    lines.cuts.push_back(row_19(fmt::format("{:.0f} s", seconds(cut)), i, results[i], area, file));
  lines.causes.push_back(row_causes("after the cut, mesh_100k", results[0]));
  return results[0].different_voxels + results[0].different_blocks;
}

}  // namespace

Result<std::size_t> print_mission_rows(const RowOptions& options) {
  Lines lines;
  std::size_t different = 0;
  const auto wants = [&](const char* row) { return options.rows.contains(row); };
  if (wants("17") || wants("18")) {
    const auto done = run_worlds(options, lines);
    if (!done) return done.error();
    different += *done;
  }
  if (wants("19")) {
    const auto done = run_cut(options, lines);
    if (!done) return done.error();
    different += *done;
  }
  if (wants("17"))
    print("Bytes of a mission with three robots (row 17)",
          "| world, link | rule | final .bt, zstd -19 | sent | datagrams | acknowledgements | ratio | |",
          lines.bytes);
  if (wants("18"))
    print("Time until a cell of 0.4 m is known at the station (row 18)",
          "| world, link | rule | cells | 50 %, s | 95 %, s | all, s | known at the end, % | |", lines.ages);
  if (wants("19"))
    print("After a cut, at 100 kbit/s (row 19)",
          "| cut | rule | m2 seen meanwhile | final .bt, zstd -19 | 95 %, s | 99 %, s | all cells, s | all "
          "blocks equal, s | bytes "
          "| |",
          lines.cuts);
  print("Where Adit's bytes and seconds go",
        "| world, link | headers | new places | changed | after a loss | coarse | poses | pieces / lost | "
        "held, % | no "
        "credit, % | first sent after, 50 / 95 %, s | settled after, s | station's map |",
        lines.causes);
  return different;
}

}  // namespace adit::bench
