// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <set>

#include "core/command/words.hpp"
#include "core/config/platform_file.hpp"
#include "core/config/search.hpp"
#include "core/config/sensors_file.hpp"
#include "robot_agent/behaviour/tree_check.hpp"
#include "sim/rehearsal/scenario_parts.hpp"

namespace adit::sim {
namespace {

using config::Node;

// Beside the scenario, where all configuration is, or as typed from the current folder. In
// `config/robots/r1.yaml` the first part names the configuration's folder itself.
Result<std::string> find_robot_file(const std::string& name, const std::string& scenario) {
  constexpr std::string_view folder = "config/";
  const auto found = config::find_file(name, scenario);
  if (found) return found;
  if (auto typed = config::find_file(name, "./")) return typed;
  if (name.starts_with(folder))
    if (auto inside = config::find_file(name.substr(folder.size()), scenario)) return inside;
  return found;
}

void read_robot_file(const Node& robot, const Scenario& scenario, RobotSpec& spec) {
  const Node node = robot.child("file");
  const auto file = find_robot_file(robot.text("file"), scenario.file.string());
  if (!file) return node.fail(file.error().reason, file.error().text);
  auto settings = agent::load_robot_config(*file);
  if (!settings) return node.fail(settings.error().reason, settings.error().text);
  spec.settings = std::move(*settings);
  spec.id = spec.settings.name;
  spec.platform = spec.settings.platform.name;
  spec.pose = spec.settings.start;
}

void read_body(const Node& robot, const Scenario& scenario, RobotSpec& spec) {
  spec.platform = robot.text("platform");
  if (spec.platform.empty()) return;
  auto known = config::load_platform(spec.platform, scenario.file.string());
  if (known)
    spec.settings.platform = std::move(*known);
  else
    robot.child("platform").fail(known.error().reason, known.error().text);
}

// In place of those of the platform.
void read_sensors(const Node& robot, const Scenario& scenario, RobotSpec& spec) {
  if (!robot.has("sensors")) return;
  config::read_platform_sensors(robot.child("sensors"), spec.settings.platform);
  if (scenario.lidar != LidarKind::full)
    robot.child("sensors").fail(Reason::bad_argument, "expected lidar: full, which has a place and a topic");
}

// In place of those of the platform. They look ahead from the top of the body's front, unless they say
// otherwise.
void read_cameras(const Node& robot, RobotSpec& spec) {
  Platform& platform = spec.settings.platform;
  if (const Node camera = robot.child_if("camera"); camera.present())
    platform.cameras = config::read_cameras(camera, platform.flies(),
                                            Mounting{.x = 0.5 * platform.length, .z = platform.height});
}

void read_battery(const Node& robot, RobotSpec& spec) {
  const Node battery = robot.child_if("battery");
  if (!battery.present()) return;
  spec.charge = battery.number("charge", config::within(0.0, 1.0), spec.charge);
  spec.drain = battery.number("drain", config::within(0.0, 1.0), spec.drain);
}

// A tree that is missing, or that the product refuses, makes the scenario unreadable.
void check_tree(const Node& robot, const Scenario& scenario, const RobotSpec& spec) {
  const bool own = robot.has("tree");
  if (!own && !robot.has("file")) return;  // the one that comes along
  const auto file = config::find_file(spec.settings.tree, scenario.file.string());
  const auto tree = file ? agent::check_tree(*file) : Result<void>{file.error()};
  if (!tree) robot.child(own ? "tree" : "file").fail(tree.error().reason, tree.error().text);
}

RobotSpec read_spec(const Node& robot, const Scenario& scenario, Duration lock_lease) {
  RobotSpec spec;
  spec.settings.lock_lease = lock_lease;
  spec.settings.perception = scenario.perception;
  const bool has_file = robot.has("file");
  if (has_file) read_robot_file(robot, scenario, spec);
  if (!has_file || robot.has("id")) spec.id = read_name(robot, "id");
  if (command::valid_name(spec.id) && !command::valid_robot_name(spec.id))
    robot.child("id").fail(Reason::bad_argument, std::string("expected ") + command::kRobotName);
  if (!has_file || robot.has("platform")) read_body(robot, scenario, spec);
  read_sensors(robot, scenario, spec);
  read_cameras(robot, spec);
  if (!has_file || robot.has("pose")) {
    const std::vector<double> pose = robot.numbers("pose", 3, 3, config::within(-1e5, 1e5));
    if (pose.size() == 3) spec.pose = {pose[0], pose[1], wrap_angle(pose[2])};
    spec.settings.start_height.reset();  // The file's belongs to the file's pose.
  }
  agent::read_robot_keys(robot, scenario.file.string(), spec.settings);
  if (spec.settings.objects && spec.settings.platform.cameras.empty())
    robot.fail(Reason::bad_argument, "objects: the robot has no camera");
  read_battery(robot, spec);
  spec.settings.name = spec.id;
  spec.settings.start = spec.pose;
  check_tree(robot, scenario, spec);
  return spec;
}

}  // namespace

void read_machines(const Node& root, Scenario& out) {
  std::set<std::string> names;
  // Of each robot that says nothing itself.
  const Duration lock_lease = from_seconds(root.number("lock_lease", config::within(0.0, 86400.0), 300.0));
  for (const Node& robot : root.list("robots")) {
    RobotSpec spec = read_spec(robot, out, lock_lease);
    if (!names.insert(spec.id).second)
      robot.fail(Reason::in_use, "expected another id: " + spec.id + " is taken");
    out.robots.push_back(std::move(spec));
  }
  if (out.robots.empty()) root.child("robots").fail(Reason::missing_key, "expected at least one robot");
  for (const Node& station : root.list_if("basestations")) {
    StationSpec spec;
    spec.id = read_name(station, "id");
    const std::vector<double> pose = station.numbers("pose", 2, 3, config::within(-1e5, 1e5), {0.0, 0.0});
    if (pose.size() >= 2) spec.position = {pose[0], pose[1]};
    if (!names.insert(spec.id).second)
      station.fail(Reason::in_use, "expected another id: " + spec.id + " is taken");
    out.stations.push_back(std::move(spec));
  }
}

}  // namespace adit::sim
