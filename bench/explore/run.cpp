// SPDX-License-Identifier: Apache-2.0
#include "bench/explore/run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "core/config/platform_file.hpp"
#include "core/contract/robot.hpp"
#include "core/time/random.hpp"
#include "sim/rehearsal/scenario_file.hpp"
#include "sim/world/generate.hpp"
#include "sim/world/standing_map.hpp"

namespace adit::bench {
namespace {

constexpr double kAsked = 2.0;      // s: when the robot is asked to explore.
constexpr double kSample = 0.1;     // s between the poses of a trail.
constexpr double kStill = 0.1;      // m/s
constexpr double kAlong = 1.0;      // m of the way before and after a turn.
constexpr double kStartFree = 0.8;  // m around a start that is drawn.

struct Place {
  std::string world{};  ///< As a scenario names it.
  Pose2 start{};
};

Result<Place> blocks_place(int size, const ExploreCourse& course) {
  const sim::GeneratedWorld made = sim::generate_blocks(size, course.seed);
  Place out{fmt::format("{{generate: blocks, size: {}, seed: {}}}", size, course.seed),
            {made.start.x(), made.start.y(), 0}};
  if (course.seed == 0) return out;
  const auto body = config::load_platform(course.platform, {});
  if (!body) return body.error();
  const auto world = sim::make_box_world(made.boxes, 0.0, 3.0);
  if (!world) return world.error();
  const sim::StandingMap map(*world, body->height, body->step);
  Random random(course.seed * 7919 + 17);
  do
    out.start = {random.uniform(0, made.size.x()), random.uniform(0, made.size.y()),
                 random.uniform(-M_PI, M_PI)};
  while (map.blocked(out.start.x, out.start.y) || map.distance(out.start.x, out.start.y) < kStartFree);
  return out;
}

Result<Place> place_of(const ExploreCourse& course) {
  if (course.world == "geb079") return Place{"{map: geb079.bt}", {0, 0, 0}};
  const bool sized = course.world.size() == 7 && course.world.starts_with("blocks");
  const int size = sized ? course.world.back() - '0' : 0;
  if (sized && size >= sim::kLeastBlocks && size <= sim::kMostBlocks) return blocks_place(size, course);
  const auto made = sim::generate_world(course.world, course.seed);
  if (!made) return made.error();
  Random random(course.seed * 7919 + 17);
  return Place{fmt::format("{{generate: {}, seed: {}}}", course.world, course.seed),
               {made->start.x(), made->start.y(), random.uniform(-M_PI, M_PI)}};
}

/// Turns by more than 120 degrees between the directions of the way before and after a place.
int count_reversals(const std::vector<Pose2>& poses) {
  std::vector<Eigen::Vector2d> way;
  for (const Pose2& pose : poses)
    if (way.empty() || (pose.position() - way.back()).norm() >= kAlong) way.push_back(pose.position());
  int reversals = 0;
  for (std::size_t i = 1; i + 1 < way.size(); ++i)
    reversals += (way[i] - way[i - 1]).normalized().dot((way[i + 1] - way[i]).normalized()) < -0.5;
  return reversals;
}

}  // namespace

Result<sim::Scenario> scenario_of(const ExploreCourse& course) {
  const auto place = place_of(course);
  if (!place) return place.error();
  return sim::parse_scenario(
      fmt::format(
          "world: {}\nodometry: {{noise: {}}}\nperception: {}\nduration: {:.0f}\nlink: wifi\n"
          "robots: [{{id: r1, platform: {}, pose: [{:.3f}, {:.3f}, {:.3f}]}}]\n"
          "basestations: [{{id: op1, pose: [{:.3f}, {:.3f}]}}]\n"
          "script: [{{at: 1, by: op1, do: take r1}}, {{at: {}, by: op1, do: explore r1 --after wait}}]\n"
          "expect: [{{by: 1, explored_at_least: 0}}]\n",
          place->world, course.noise, course.perception, course.limit + kAsked, course.platform,
          place->start.x, place->start.y, place->start.yaw, place->start.x, place->start.y, kAsked),
      course.world + ".yaml");
}

Result<ExploreOutcome> run(const ExploreCourse& course, const sim::AgentFactory& agents,
                           const std::string& trajectory) {
  const auto scenario = scenario_of(course);
  if (!scenario) return scenario.error();
  const auto world = sim::make_world(scenario->world);
  if (!world) return world.error();
  ExploreOutcome out;
  sim::RunParams params{};
  params.seed = std::max<std::uint64_t>(1, course.seed);
  params.workers = 1;
  params.make_agent = agents;
  params.ended = [&out](const sim::RunState& state) {
    const auto is = static_cast<adit::contract::ExplorationPhase>(state.witness.word("r1").exploration);
    if (is == adit::contract::ExplorationPhase::done) out.done = seconds(state.now) - kAsked;
    return is == adit::contract::ExplorationPhase::done || is == contract::ExplorationPhase::ended;
  };
  const auto done = sim::rehearse(*scenario, *world, params);
  if (!done) return done.error();
  out.truth = *done->report.exploration;
  for (auto& reached : out.truth.reached)
    if (reached) reached->time_s -= kAsked;
  out.collisions = done->report.robots.at("r1").collisions;
  std::vector<Pose2> poses = done->trails.at("r1").poses;
  poses.erase(poses.begin(),
              poses.begin() + std::min<std::ptrdiff_t>(std::lround(kAsked / kSample), std::ssize(poses)));
  if (!trajectory.empty()) {
    std::ofstream file(trajectory);
    for (std::size_t i = 0; i < poses.size(); ++i)
      file << fmt::format("{:.1f} {:.3f} {:.3f} {:.3f}\n", kSample * static_cast<double>(i), poses[i].x,
                          poses[i].y, poses[i].yaw);
  }
  if (const auto& all = out.truth.reached.back())
    poses.resize(std::min(poses.size(), static_cast<std::size_t>(all->time_s / kSample)));
  out.span = kSample * static_cast<double>(poses.size());
  double metres = 0;
  std::size_t moving = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double way = (poses[i].position() - poses[i - 1].position()).norm();
    metres += way;
    moving += way > kStill * kSample;
  }
  out.mean_speed = out.span > 0 ? metres / out.span : 0;
  out.moving = poses.empty() ? 0 : static_cast<double>(moving) / static_cast<double>(poses.size());
  out.reversals = count_reversals(poses);
  return out;
}

}  // namespace adit::bench
