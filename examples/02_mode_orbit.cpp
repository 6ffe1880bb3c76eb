// SPDX-License-Identifier: Apache-2.0
// Example 2: a robot with a mode of its own, in a rehearsal.
//
//   example_mode_orbit [FILE.mcap]
//
// An operator takes r1 and requests `orbit`, the mode of 02_mode_orbit.hpp. A minute passes in a few seconds,
// and the program reports how far around its centre the robot drove. With FILE.mcap, everything that was said
// is recorded; example 6 reads it. Exit status 0: at least one complete circle, and no rule was broken.
#include "examples/02_mode_orbit.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>

#include "robot_agent/agent.hpp"
#include "robot_agent/behaviour/decider.hpp"
#include "sim/rehearsal/agent_factory.hpp"
#include "sim/rehearsal/rehearsal.hpp"
#include "sim/rehearsal/scenario_file.hpp"

namespace {

using namespace adit;

constexpr const char* kScenario = R"(
world: {boxes: [[-8, -7.8, -8, 8, 0, 2], [7.8, 8, -8, 8, 0, 2]], floor: 0, ceiling: 3}
duration: 60
robots:
  - {id: r1, platform: wheeled, pose: [0, -3, 0]}
basestations:
  - {id: op1, pose: [-6, -6]}
script:
  - {at: 2, by: op1, do: take r1}
  - {at: 3, by: op1, do: mode r1 orbit}
expect:
  - {always: no_collision}
)";
// The centre lies to the left of the start.
const Eigen::Vector2d kCentre{0.0, -3.0 + agent::OrbitMode::kRadius};

/// Gives an agent the mode and a tree that decides about it.
void add_orbit(agent::AgentParams& params) {
  params.modes = agent::modes_with_orbit();
  params.load_tree = [modes = params.modes](const std::string& file) {
    std::ifstream in(file);
    return agent::Decider::load_text(agent::with_orbit({std::istreambuf_iterator<char>(in), {}}), *modes);
  };
}

/// The angle that a path turns around the centre, rad.
double angle_around(const Eigen::Vector2d& centre, const std::vector<Pose2>& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const auto bearing = [&](const Pose2& at) { return std::atan2(at.y - centre.y(), at.x - centre.x()); };
    sum += wrap_angle(bearing(path[i]) - bearing(path[i - 1]));
  }
  return sum;
}

int fail(const Error& error) {
  std::fprintf(stderr, "example_mode_orbit: %s\n", error.text.c_str());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  const auto scenario = sim::parse_scenario(kScenario, "orbit.yaml");
  if (!scenario) return fail(scenario.error());
  const auto world = sim::make_world(scenario->world);
  if (!world) return fail(world.error());
  const auto factory = sim::make_agent_factory("", add_orbit);
  if (!factory) return fail(factory.error());
  sim::RunParams params{};
  params.make_agent = *factory;
  if (argc > 1) params.record = argv[1];
  const auto run = sim::rehearse(*scenario, *world, params);
  if (!run) return fail(run.error());

  const double circles = angle_around(kCentre, run->trails.at("r1").poses) / (2.0 * std::numbers::pi);
  std::printf("r1 drove %.1f m and %.1f times around (%.0f, %.0f)\n", run->report.robots.at("r1").distance,
              circles, kCentre.x(), kCentre.y());
  for (const std::string& line : run->report.complaints()) std::printf("%s\n", line.c_str());
  return run->report.ok() && circles >= 1.0 ? 0 : 1;
}
