// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/check/config_lines.hpp"

#include <vector>

#include "core/config/search.hpp"

namespace adit::agent {
namespace {

std::string line_of(const config::Node& sensor, const std::string& key) {
  const config::Node node = sensor.is_mapping() ? sensor.child_if(key) : config::Node{};
  return node.present() ? node.where() : sensor.where();
}

}  // namespace

Result<ConfigLines> ConfigLines::load(const std::string& robot_file) {
  const auto robot = config::load(robot_file);
  if (!robot) return robot.error();
  const auto path = config::find_named("platforms", robot->text("platform"), robot_file);
  if (!path) return path.error();
  const auto platform = config::load(*path);
  if (!platform) return platform.error();
  return ConfigLines(*platform);
}

std::string ConfigLines::lidar(std::size_t n, const std::string& key) const {
  const config::Node sensors = root_.child_if("sensors");
  const config::Node lidars = sensors.is_mapping() ? sensors.child_if("lidar") : config::Node{};
  if (!lidars.present()) return line_of(root_, key == "z" ? "lidar_height" : "sensors");
  if (!lidars.is_list()) return line_of(lidars, key);
  const std::vector<config::Node> list = lidars.as_list();
  return n < list.size() ? line_of(list[n], key) : lidars.where();
}

std::string ConfigLines::imu(const std::string& key) const {
  const config::Node sensors = root_.child_if("sensors");
  const config::Node imu = sensors.is_mapping() ? sensors.child_if("imu") : config::Node{};
  return imu.present() ? line_of(imu, key) : root_.where();
}

}  // namespace adit::agent
