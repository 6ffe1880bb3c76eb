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
constexpr double kBeside = 0.04;  // m beside a robot in the narrowest gap that counts as one: 10 cm in all

/// Which cells of 0.1 m a disc can be in, and which of them it gets to from the start.
class Ground {
 public:
  Ground(const sim::GeneratedWorld& made, const sim::StandingMap& map, double stand, double pass)
      : nx_(static_cast<int>(made.size.x() / kCell)), ny_(static_cast<int>(made.size.y() / kCell)) {
    state_.assign(static_cast<std::size_t>(nx_) * ny_, State::blocked);
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i)
        if (map.distance(x(i), x(j)) >= stand) at(i, j) = State::apart;
    std::deque<std::pair<int, int>> open{
        {static_cast<int>(made.start.x() / kCell), static_cast<int>(made.start.y() / kCell)}};
    std::vector<std::uint8_t> seen(state_.size());
    while (!open.empty()) {
      const auto [i, j] = open.front();
      open.pop_front();
      if (i < 0 || j < 0 || i >= nx_ || j >= ny_) continue;
      auto& mark = seen[static_cast<std::size_t>(j) * nx_ + i];
      if (mark || map.distance(x(i), x(j)) < pass) continue;
      mark = 1;
      if (at(i, j) == State::apart) at(i, j) = State::reachable;
      for (const auto& [a, b] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) open.emplace_back(i + a, j + b);
    }
  }
  enum class State : std::uint8_t { blocked, apart, reachable };
  State& at(int i, int j) { return state_[static_cast<std::size_t>(j) * nx_ + i]; }
  static double x(int i) { return (i + 0.5) * kCell; }
  int nx() const { return nx_; }
  int ny() const { return ny_; }

 private:
  int nx_, ny_;
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
  Ground ground(*made, map, 0.5 * std::hypot(body->length, body->width) + 0.1, 0.5 * body->width + kBeside);
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
                  body->max_speed,
                  wanted == Ground::State::reachable};
  }
  return {Reason::out_of_range, fmt::format("{} seed {}: no place for a goal", kind, seed)};
}

Result<sim::Scenario> scenario_of(const Course& course, double slowness, bool planar) {
  const double duration = 30.0 + slowness * course.straight / (0.5 * course.speed);
  return sim::parse_scenario(
      fmt::format(
          "world: {{generate: {}, seed: {}}}\nduration: {:.0f}\nlink: mesh_500k\nlidar: {}\n"
          "robots:\n  - {{id: r1, platform: {}, pose: [{}, {}, 0]}}\nbasestations:\n  - {{id: op1, pose: [0, "
          "0]}}\n"
          "script:\n  - {{at: 3, by: op1, do: take r1}}\n  - {{at: 4, by: op1, do: goto r1 {:.2f} {:.2f}}}\n",
          course.kind, course.seed, duration, planar ? "planar" : "full", course.platform, course.start.x(),
          course.start.y(), course.goal.x(), course.goal.y()),
      course.kind + ".yaml");
}

}  // namespace adit::bench
