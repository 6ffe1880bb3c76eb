// SPDX-License-Identifier: Apache-2.0
// bench_explore: how fast one robot explores generated worlds, beside what TARE needed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <thread>

#include "bench/explore/run.hpp"
#include "bench/explore/tare.hpp"

namespace {

using namespace adit;
using namespace adit::bench;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr const char* kHead =
    "| world | seed | 50 % s | 90 % s | 95 % s | 97 % s | 99 % s | m | m/s | moving | repeat | reversals | "
    "done s | seen then | contacts |\n"
    "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
constexpr std::size_t kColumns = 13;
using Row = std::array<double, kColumns>;

Row row_of(const ExploreOutcome& o) {
  Row row{};
  for (std::size_t n = 0; n < o.truth.reached.size(); ++n)
    row[n] = o.truth.reached[n] ? o.truth.reached[n]->time_s : kNever;
  row[5] = o.truth.reached.back() ? o.truth.reached.back()->metres : o.truth.metres;
  row[6] = o.mean_speed;
  row[7] = o.moving;
  row[8] = o.truth.repeat;
  row[9] = o.reversals;
  row[10] = o.done.value_or(kNever);
  row[11] = o.truth.share;
  row[12] = o.collisions;
  return row;
}

void print(const std::string& world, const std::string& name, const Row& r) {
  fmt::print(
      "| {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {:.2f} | {:.2f} | {:.2f} | {:.0f} | "
      "{:.1f} | {:.3f} | {:.0f} |\n",
      world, name, r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], r[9], r[10], r[11], r[12]);
}

void print_summary(const std::string& world, const std::vector<Row>& rows) {
  constexpr std::array kMoreIsBetter{6u, 7u, 11u};
  Row median{}, worst{};
  for (std::size_t c = 0; c < kColumns; ++c) {
    std::vector<double> column;
    for (const Row& row : rows) column.push_back(row[c]);
    std::sort(column.begin(), column.end());
    median[c] = column[column.size() / 2];
    const bool more = std::find(kMoreIsBetter.begin(), kMoreIsBetter.end(), c) != kMoreIsBetter.end();
    worst[c] = more ? column.front() : column.back();
  }
  print(world, "median", median);
  print(world, "worst", worst);
  for (const TareRow& t : kTare)
    if (t.world == world)
      fmt::print(
          "| {} | TARE | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | | | 0-0.11 | | {} | | |\n",
          world, t.times[0], t.times[1], t.times[2], t.times[3], t.times[4], t.metres, t.done);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "How fast one robot explores: times from the request until shares of what can be seen were seen."};
  std::vector<std::string> worlds{"blocks3"};
  std::string platform = "wheeled", perception = "off", trajectories;
  int seeds = 5;
  std::uint64_t first = 0;
  double noise = 0, limit = 300;
  unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
  app.add_option("--world", worlds,
                 "blocks2 to blocks9, kinds of generated worlds, geb079 (default blocks3)");
  app.add_option("--seeds", seeds, "how many (default 5)")->check(CLI::Range(1, 1000));
  app.add_option("--first", first, "the first seed (default 0: the worlds and the start of TARE)");
  app.add_option("--platform", platform, "of the robot (default wheeled)");
  app.add_option("--noise", noise, "scale of the errors of odometry and sensors (default 0)");
  app.add_option("--perception", perception, "of the robot: off (the default), odometry or slam")
      ->check(CLI::IsMember({"off", "odometry", "slam"}));
  app.add_option("--limit", limit, "end of a run, s (default 300)");
  app.add_option("--jobs", jobs, "runs at a time (default: one a processor)")->check(CLI::Range(1, 64));
  app.add_option("--trajectories", trajectories, "folder for the ways: files of \"time x y yaw\"");
  app.footer("Example:\n  bench_explore --world blocks3 blocks5 --seeds 10");
  CLI11_PARSE(app, argc, argv);

  const auto agents = sim::make_agent_factory();
  if (!agents) return std::fprintf(stderr, "bench_explore: %s\n", agents.error().text.c_str()), 1;
  fmt::print("{}", kHead);
  for (const std::string& world : worlds) {
    std::vector<std::optional<Result<ExploreOutcome>>> outcomes(static_cast<std::size_t>(seeds));
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t n = next++; n < outcomes.size(); n = next++) {
        const std::uint64_t seed = first + n;
        const std::string file =
            trajectories.empty() ? "" : fmt::format("{}/{}_{}.txt", trajectories, world, seed);
        outcomes[n] = run({world, platform, seed, noise, perception, limit}, *agents, file);
      }
    };
    std::vector<std::thread> workers;
    for (unsigned n = 0; n < jobs; ++n) workers.emplace_back(work);
    for (std::thread& worker : workers) worker.join();
    std::vector<Row> rows;
    for (std::size_t n = 0; n < outcomes.size(); ++n) {
      if (!*outcomes[n]) {
        fmt::print("| {} | {} | {} |\n", world, first + n, outcomes[n]->error().text);
        continue;
      }
      rows.push_back(row_of(**outcomes[n]));
      print(world, std::to_string(first + n), rows.back());
    }
    if (!rows.empty()) print_summary(world, rows);
    std::fflush(stdout);
  }
  return 0;
}
