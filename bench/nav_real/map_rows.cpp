// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/nav_real/doors.hpp"
#include "bench/nav_real/site.hpp"

namespace adit::bench {
namespace {

constexpr double kTolerance = 0.25;  // m: of an arrival
constexpr double kNearest = 3.0;     // m: shortest path of a drawn goal
constexpr double kAllowance = 10.0;  // s: beside the shortest path at top speed
constexpr double kPatience = 4.0;    // times the shortest path at top speed and the allowance: a run's limit

double limit_of(double shortest, double speed) { return kPatience * (shortest / speed + kAllowance); }

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A goal on the true map that the body can reach, with the length of its shortest path.
struct Drawn {
  GoalRun run{};
  double shortest{};
};
std::optional<Drawn> draw_goal(const TrueMap& map, std::uint64_t seed) {
  Random random(seed * 7919 + 17);
  for (int attempt = 0; attempt < 50; ++attempt) {
    const auto start = map.draw_pose(random, TrueMap::kStartClearance);
    if (!start) return std::nullopt;
    const std::vector<float> distances = map.distances(*start);
    // A start in a closet, or on a table, has nowhere to go.
    for (int n = 0; n < 2000; ++n) {
      const int i = static_cast<int>(random.below(static_cast<std::uint64_t>(map.nx())));
      const int j = static_cast<int>(random.below(static_cast<std::uint64_t>(map.ny())));
      if (!map.standable(i, j)) continue;
      const Eigen::Vector2d goal = map.middle(i, j);
      const double shortest = map.distance_to(distances, goal, kTolerance);
      if (shortest < kNearest || shortest >= TrueMap::kFar) continue;
      Drawn out;
      out.run.platform = map.platform().name;
      out.run.start = *start;
      out.run.goal = goal;
      out.run.limit = limit_of(shortest, map.platform().max_speed);
      out.run.seed = seed;
      out.shortest = shortest;
      return out;
    }
  }
  return std::nullopt;
}

struct Tally {
  int runs{}, reached{}, contacts{};
  std::vector<double> ratios{}, off{};
  void add(const GoalResult& result, double shortest, double speed) {
    ++runs;
    contacts += result.contacts;
    if (!result.arrived) return;
    ++reached;
    ratios.push_back(result.seconds / (shortest / speed + kAllowance));
    off.push_back(result.off);
  }
  std::string text() const {
    return fmt::format(
        "{} of {} reached, {} contacts, time {:.2f} x (shortest path at top speed + 10 s), truly {:.2f} m "
        "from the goal (at most {:.2f})",
        reached, runs, contacts, median(ratios), median(off),
        off.empty() ? 0.0 : *std::max_element(off.begin(), off.end()));
  }
};

/// Whether the trail passes by a place within so many metres.
bool passes(const std::vector<Pose2>& trail, const Eigen::Vector2d& place, double within) {
  return std::any_of(trail.begin(), trail.end(),
                     [&](const Pose2& pose) { return (pose.position() - place).norm() < within; });
}

/// A start on one side of a passage and a goal on the other, 1.5 to 4 m from it.
std::optional<Drawn> draw_passage(const TrueMap& map, const Passage& passage, std::uint64_t seed) {
  constexpr double kClear = 0.10, kFrom = 1.5, kTo = 4.0, kAside = 1.2;
  Random random(seed * 104729 + 5);
  const bool forth = random.chance(0.5);
  const Pose2 middle = forth ? passage.middle : passage.middle * Pose2{0, 0, M_PI};
  const auto draw_at = [&](double from, double to) {
    return middle *
           Pose2{random.uniform(from, to), random.uniform(-kAside, kAside), random.uniform(-M_PI, M_PI)};
  };
  for (int attempt = 0; attempt < 200; ++attempt) {
    const Pose2 start = draw_at(-kTo, -kFrom);
    if (!map.fits(start, kClear)) continue;
    const std::vector<float> distances = map.distances(start);
    for (int n = 0; n < 200; ++n) {
      const Pose2 goal = draw_at(kFrom, kTo);
      if (!map.fits(goal, kClear)) continue;
      const double shortest = map.distance_to(distances, goal.position(), kTolerance);
      const double through =
          (start.position() - middle.position()).norm() + (goal.position() - middle.position()).norm();
      if (shortest > through + 0.7) continue;  // there is another door, or a wall
      Drawn out;
      out.run.platform = map.platform().name;
      out.run.start = start;
      out.run.goal = goal.position();
      out.run.limit = limit_of(shortest, map.platform().max_speed);
      out.run.seed = seed;
      out.shortest = shortest;
      return out;
    }
  }
  return std::nullopt;
}

}  // namespace

Result<RowResults> goals_row(const RowOptions& options) {
  const auto site = open_site();
  if (!site) return site.error();
  RowResults rows;
  Tally all;
  for (const std::string& platform : options.platforms) {
    const auto map = map_of(*site, platform);
    if (!map) return map.error();
    Tally tally;
    Progress progress("goals " + platform, options.goals, options.minutes);
    for (int n = 0; n < options.goals && progress.next(); ++n) {
      const auto drawn = draw_goal(*map, options.first + static_cast<std::uint64_t>(n));
      if (!drawn) return {Reason::out_of_range, platform + ": no place for a goal"};
      const GoalResult result = drive(drawn->run, site->world, site->agents);
      for (Tally* t : {&tally, &all}) t->add(result, drawn->shortest, map->platform().max_speed);
      if (!result.arrived || result.contacts > 0)
        print_run(options, "goals", drawn->run, result, drawn->shortest);
    }
    rows.push_back({"goals " + platform, tally.text(), "", "", true});
  }
  const bool ok = all.reached * 300 >= all.runs * 298 && all.contacts == 0 && median(all.ratios) <= 1.5;
  rows.push_back({"goals", all.text(), "298 of 300, 0 contacts, 1.5", "", ok});
  return rows;
}

Result<RowResults> doors_row(const RowOptions& options) {
  constexpr double kBeside = 0.08, kBy = 0.8;  // m
  const auto site = open_site();
  if (!site) return site.error();
  RowResults rows;
  int pairs = 0, runs = 0, passed = 0, contacts = 0;
  for (const std::string& platform : options.platforms) {
    const auto map = map_of(*site, platform);
    if (!map) return map.error();
    for (const Door& door : find_doors(*map)) {
      const Passage passage = fit_passage(*map, door);
      const std::string name = fmt::format("door ({:.2f}, {:.2f}) {}", door.at.x(), door.at.y(), platform);
      if (passage.beside < kBeside) {
        if (options.each)
          fmt::print("{}: {:.2f} m wide, {:.0f} cm a side: not in the row\n", name, door.width,
                     100 * passage.beside);
        continue;
      }
      int here = 0, done = 0;
      Progress progress(name, options.seeds, options.minutes);
      for (int n = 0; n < options.seeds && progress.next(); ++n) {
        const auto drawn = draw_passage(*map, passage, options.first + static_cast<std::uint64_t>(n));
        if (!drawn) break;
        const GoalResult result = drive(drawn->run, site->world, site->agents);
        const bool good = result.arrived && passes(result.trail, passage.middle.position(), kBy);
        ++done;
        here += good;
        contacts += result.contacts;
        if (!good || result.contacts > 0) print_run(options, "doors", drawn->run, result, drawn->shortest);
      }
      if (done == 0) {
        if (options.each) fmt::print("{}: no start and goal on its two sides: not in the row\n", name);
        continue;
      }
      ++pairs;
      runs += done;
      passed += here;
      rows.push_back({name,
                      fmt::format("{} of {} passed, {:.2f} m wide, {:.0f} cm a side", here, done, door.width,
                                  100 * passage.beside),
                      "", "", here == done});
    }
  }
  rows.push_back({"doors",
                  fmt::format("{} of {} passed ({} pairs), {} contacts", passed, runs, pairs, contacts),
                  "all, 0 contacts", "", passed == runs && contacts == 0});
  return rows;
}

Result<RowResults> straight_row(const RowOptions& options) {
  constexpr double kWithin = 30.0;  // s
  const auto site = open_site();
  if (!site) return site.error();
  int runs = 0, reached = 0, contacts = 0;
  std::vector<double> times;
  Progress progress("straight", options.seeds, options.minutes);
  for (int n = 0; n < options.seeds && progress.next(); ++n) {
    GoalRun run;
    run.platform = "tracked";
    run.start = {6, 0, 0};
    run.goal = {14, 0};
    run.limit = 2 * kWithin;
    run.seed = options.first + static_cast<std::uint64_t>(n);
    const GoalResult result = drive(run, site->world, site->agents);
    const bool good = result.arrived && result.seconds <= kWithin;
    ++runs;
    reached += good;
    contacts += result.contacts;
    times.push_back(result.seconds);
    if (!good) print_run(options, "straight", run, result, 8.0);
  }
  return RowResults{{"straight tracked (6, 0) to (14, 0)",
                     fmt::format("{} of {} within 30 s, median {:.1f} s, {} contacts", reached, runs,
                                 median(times), contacts),
                     "20 of 20", "", reached == runs && contacts == 0}};
}

}  // namespace adit::bench
