// SPDX-License-Identifier: Apache-2.0
#include "bench/goals/course.hpp"

#include <fmt/format.h>

#include <cmath>
#include <deque>

#include "core/config/platform_file.hpp"
#include "core/time/random.hpp"
#include "sim/rehearsal/scenario_file.hpp"
#include "sim/world/standing_map.hpp"

namespace adit::bench {
namespace {

constexpr double kCell = 0.1;     // m
constexpr double kSqueeze = 0.1;  // m: a way so much narrower is none
constexpr double kBeside = 0.04;  // m beside a robot in the narrowest gap that counts as one: 10 cm in all

/// Which cells of 0.1 m a disc of radius `stand` can be in, and which of them one of radius `pass` gets to
/// from the start; what only one of radius `squeeze` gets to counts neither as reachable nor as apart.
class Ground {
 public:
  Ground(const sim::GeneratedWorld& made, const sim::StandingMap& map, double stand, double pass,
         double squeeze)
      : nx_(static_cast<int>(made.size.x() / kCell)), ny_(static_cast<int>(made.size.y() / kCell)) {
    state_.assign(static_cast<std::size_t>(nx_) * ny_, State::blocked);
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i)
        if (map.distance(x(i), x(j)) >= stand) at(i, j) = State::apart;
    spread(made, map, squeeze, State::apart, State::doubtful);
    spread(made, map, pass, State::doubtful, State::reachable);
  }
  enum class State : std::uint8_t { blocked, apart, doubtful, reachable };
  /// Of the shortest way there, m; that of none where there is no way.
  double way(int i, int j) const {
    return std::max(0, cells_[static_cast<std::size_t>(j) * nx_ + i]) * kCell;
  }
  State& at(int i, int j) { return state_[static_cast<std::size_t>(j) * nx_ + i]; }
  static double x(int i) { return (i + 0.5) * kCell; }
  int nx() const { return nx_; }
  int ny() const { return ny_; }

 private:
  static constexpr int kUnseen = -1;
  void spread(const sim::GeneratedWorld& made, const sim::StandingMap& map, double radius, State from,
              State to) {
    struct Step {
      int i, j, cells;
    };
    std::deque<Step> open{
        {static_cast<int>(made.start.x() / kCell), static_cast<int>(made.start.y() / kCell), 0}};
    cells_.assign(state_.size(), kUnseen);
    while (!open.empty()) {
      const auto [i, j, cells] = open.front();
      open.pop_front();
      if (i < 0 || j < 0 || i >= nx_ || j >= ny_) continue;
      int& mark = cells_[static_cast<std::size_t>(j) * nx_ + i];
      if (mark != kUnseen || map.distance(x(i), x(j)) < radius) continue;
      mark = cells;
      if (at(i, j) == from) at(i, j) = to;
      for (const auto& [a, b] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
        open.push_back({i + a, j + b, cells + 1});
    }
  }
  int nx_, ny_;
  std::vector<int> cells_{};
  std::vector<State> state_{};
};

}  // namespace

Result<Course> draw_course(const std::string& kind, const std::string& platform, std::uint64_t seed) {
  const auto made = sim::generate_world(kind, seed);
  if (!made) return made.error();
  const auto body = config::load_platform(platform, {});
  if (!body) return body.error();
  const auto world = sim::make_box_world(made->boxes, 0.0, 3.0);
  if (!world) return world.error();
  const sim::StandingMap map(*world, body->height, body->step);
  Ground ground(*made, map, 0.5 * std::hypot(body->length, body->width) + 0.1, 0.5 * body->width + kBeside,
                0.5 * body->width - kSqueeze);
  Random random(seed * 7919 + 17);
  const bool apart = random.chance(0.1);
  for (int attempt = 0; attempt < 20000; ++attempt) {
    const int i = static_cast<int>(random.below(static_cast<std::uint64_t>(ground.nx())));
    const int j = static_cast<int>(random.below(static_cast<std::uint64_t>(ground.ny())));
    const Eigen::Vector2d goal(Ground::x(i), Ground::x(j));
    const double straight = (goal - made->start).norm();
    // In a world without such a place the goal becomes one that can be reached.
    const auto wanted = apart && attempt < 10000 ? Ground::State::apart : Ground::State::reachable;
    if (straight < 4.0 || straight > 25.0 || ground.at(i, j) != wanted) continue;
    return Course{kind,
                  platform,
                  seed,
                  made->start,
                  goal,
                  straight,
                  ground.way(i, j),
                  body->max_speed,
                  wanted == Ground::State::reachable};
  }
  return {Reason::out_of_range, fmt::format("{} seed {}: no place for a goal", kind, seed)};
}

std::string scenario_text(const Course& course, double slowness, bool planar) {
  // Who cannot get there may have to look at it from all sides.
  constexpr double kAround = 60.0;  // m
  const double way = course.reachable ? std::max(course.straight, course.way) : kAround;
  const double duration = 30.0 + slowness * way / (0.5 * course.speed);
  return fmt::format(
      "world: {{generate: {}, seed: {}}}\nduration: {:.0f}\nlink: mesh_500k\nlidar: {}\n"
      "robots:\n  - {{id: r1, platform: {}, pose: [{}, {}, 0]}}\nbasestations:\n  - {{id: op1, pose: [0, "
      "0]}}\n"
      "script:\n  - {{at: 3, by: op1, do: take r1}}\n  - {{at: 4, by: op1, do: goto r1 {:.2f} {:.2f}}}\n",
      course.kind, course.seed, duration, planar ? "planar" : "full", course.platform, course.start.x(),
      course.start.y(), course.goal.x(), course.goal.y());
}

Result<sim::Scenario> scenario_of(const Course& course, double slowness, bool planar) {
  return sim::parse_scenario(scenario_text(course, slowness, planar), course.kind + ".yaml");
}

}  // namespace adit::bench
