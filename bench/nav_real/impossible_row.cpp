// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/nav_real/goal_run.hpp"
#include "bench/nav_real/rows.hpp"
#include "bench/nav_real/site.hpp"
#include "sim/world/lidar.hpp"

namespace adit::bench {
namespace {

enum class Where { furniture, wall, outside };
constexpr std::array<const char*, 3> kNames{"furniture", "wall", "outside"};

constexpr double kNear = 1.0;     // m: from the ground that robots reach to furniture and walls
constexpr double kAway = 1.5;     // m: the same to what counts as outside, at least
constexpr double kReach = 12.0;   // m: from the start to the goal
constexpr double kLimit = 150.0;  // s

/// What a column of the world is where no body fits. Furniture has open space somewhere below a person's
/// height, a wall has none.
std::optional<Where> kind_at(const TrueMap& map, const sim::World& world, const std::vector<float>& distances,
                             int i, int j) {
  constexpr double kPerson = 1.8;  // m
  const Eigen::Vector2d at = map.middle(i, j);
  // No body stands within an arrival's tolerance.
  if (map.distance_to(distances, at, 0.5) < TrueMap::kFar) return std::nullopt;
  const int reach = static_cast<int>(kAway / TrueMap::kCell);
  bool open = false;
  double nearest = 1e9, ground = 0.0;
  for (int b = j - reach; b <= j + reach; ++b)
    for (int a = i - reach; a <= i + reach; ++a) {
      if (!map.inside(a, b)) continue;
      const Eigen::Vector2d place = map.middle(a, b);
      if (map.distance_to(distances, place, 0.05) >= TrueMap::kFar) continue;
      const double apart = (place - at).norm();
      if (apart < nearest) ground = map.standing().ground(place.x(), place.y());
      nearest = std::min(nearest, apart);
    }
  if (nearest > kAway) return Where::outside;
  if (nearest > kNear) return std::nullopt;
  const sim::VoxelGrid& grid = world.grid();
  const int x = grid.column_x(at.x()), y = grid.column_y(at.y());
  if (!grid.inside(x, y)) return std::nullopt;
  for (int k = 0; k < grid.layers(); ++k) {
    const double z = grid.levels()[static_cast<std::size_t>(k)];
    open = open || (z > ground && z < ground + kPerson && !grid.solid(x, y, k));
  }
  return open ? Where::furniture : Where::wall;
}

/// Whether the lidar sees the place from the start: at least so many returns near it.
bool observed(const TrueMap& map, const sim::World& world, const Pose2& start, const Eigen::Vector2d& goal) {
  constexpr int kReturns = 3;
  constexpr double kWithin = 0.2;  // m
  const Platform& body = map.platform();
  sim::LidarParams lidar;
  lidar.rings = body.lidar_rings;
  lidar.lowest = body.lidar_lowest;
  lidar.highest = body.lidar_highest;
  const Pose3 base = Pose3::level(start, map.standing().ground(start.x, start.y));
  int count = 0;
  for (const Eigen::Vector3f& p : sim::LidarPattern(lidar).scan(world, {}, base, body.lidar_height, 1))
    count += ((base * p.cast<double>()).head<2>() - goal).norm() < kWithin;
  return count >= kReturns;
}

struct Impossible {
  GoalRun run{};
  bool observed{};
  double straight{};
};

std::optional<Impossible> draw_impossible(const TrueMap& map, const sim::World& world, Where where,
                                          std::uint64_t seed) {
  Random random(seed * 15485863 + 3);
  for (int attempt = 0; attempt < 20; ++attempt) {
    const auto start = map.draw_pose(random, 0.10);
    if (!start) return std::nullopt;
    const std::vector<float> distances = map.distances(*start);
    // A place with little ground around it sees nothing of the building.
    if (std::count_if(distances.begin(), distances.end(), [](float d) { return d < TrueMap::kFar; }) < 2000)
      continue;
    for (int n = 0; n < 3000; ++n) {
      const double range = random.uniform(2.0, kReach), angle = random.uniform(-M_PI, M_PI);
      const Eigen::Vector2d goal =
          start->position() + range * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      if (kind_at(map, world, distances, map.column(goal.x(), 0), map.column(goal.y(), 1)) != where) continue;
      Impossible out;
      out.run.platform = map.platform().name;
      out.run.start = *start;
      out.run.goal = goal;
      out.run.impossible = true;
      out.run.limit = kLimit;
      out.run.seed = seed;
      out.observed = observed(map, world, *start, goal);
      out.straight = range;
      return out;
    }
  }
  return std::nullopt;
}

}  // namespace

Result<RowResults> impossible_row(const RowOptions& options) {
  constexpr double kAtOnce = 1.0, kUnmoved = 0.05;  // s, m
  const auto site = open_site();
  if (!site) return site.error();
  int seen = 0, refused = 0, unseen = 0, reported = 0, silent = 0;
  double farthest = 0.0;
  int done = 0;
  Progress progress("impossible", options.impossible, options.minutes);
  const auto platforms = static_cast<int>(options.platforms.size());
  for (int p = 0; p < platforms; ++p) {
    const auto map = map_of(*site, options.platforms[static_cast<std::size_t>(p)]);
    if (!map) return map.error();
    for (int n = p; n < options.impossible && progress.next(); n += platforms) {
      const auto where = static_cast<Where>(n / platforms % 3);
      const auto drawn =
          draw_impossible(*map, *site->world, where, options.first + static_cast<std::uint64_t>(n));
      if (!drawn) continue;
      const GoalResult result = drive(drawn->run, site->world, site->agents);
      ++done;
      // The budget of the body, and the metres it needs to stop.
      const double budget = std::max(20.0, 1.5 * drawn->straight) + 1.0;
      bool good;
      if (drawn->observed) {
        ++seen;
        good = result.refused && result.seconds <= kAtOnce && result.metres <= kUnmoved;
        refused += good;
      } else {
        ++unseen;
        good = (result.refused || result.ends) && result.metres <= budget;
        reported += good;
      }
      silent += result.reason.empty();
      farthest = std::max(farthest, result.metres);
      if (!good)
        print_run(options,
                  fmt::format("impossible ({}, {})", kNames[static_cast<std::size_t>(where)],
                              drawn->observed ? "seen" : "unseen"),
                  drawn->run, result, drawn->straight);
    }
  }
  return RowResults{
      {"impossible goals",
       fmt::format(
           "{} goals: {} of {} on observed ground refused within 1 s and 0 m, {} of {} others stopped "
           "within their budget with a report; {} without any report, up to {:.0f} m driven",
           done, refused, seen, reported, unseen, silent, farthest),
       "all, all", "", refused == seen && reported == unseen}};
}

}  // namespace adit::bench
