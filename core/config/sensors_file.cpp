// SPDX-License-Identifier: Apache-2.0
#include "core/config/sensors_file.hpp"

#include <cmath>
#include <utility>

#include "core/command/words.hpp"

namespace adit::config {
namespace {

/// `usual`: values of x, y and z that are missing; nothing: they are required.
Mounting read_mounting(const Node& node, bool flies, const std::optional<Mounting>& usual = std::nullopt) {
  constexpr double kTurn = 2 * M_PI;
  const Range height = flies ? within(-5, 5) : positive_up_to(5);
  Mounting m;
  m.x = usual ? node.number("x", within(-5, 5), usual->x) : node.number("x", within(-5, 5));
  m.y = usual ? node.number("y", within(-5, 5), usual->y) : node.number("y", within(-5, 5));
  m.z = usual ? node.number("z", height, usual->z) : node.number("z", height);
  m.roll = node.number("roll", within(-kTurn, kTurn), 0.0);
  m.pitch = node.number("pitch", within(-kTurn, kTurn), 0.0);
  m.yaw = node.number("yaw", within(-kTurn, kTurn), 0.0);
  return m;
}

/// Reads the topic and the frame of a driver.
void read_source(const Node& node, std::string& topic, std::string& frame) {
  topic = node.text("topic", topic);
  frame = node.text("frame", frame);
  if (topic.empty() || frame.empty())
    node.fail(Reason::out_of_range, "expected a topic and a frame that are not empty");
}

LidarConfig read_lidar(const Node& node, const LidarConfig& usual, bool flies) {
  LidarConfig lidar = usual;
  lidar.mounting = read_mounting(node, flies);
  read_source(node, lidar.topic, lidar.frame);
  lidar.rings = static_cast<int>(node.integer("rings", 1, 256, lidar.rings));
  lidar.lowest = node.number("lowest", within(-89, 0), lidar.lowest);
  lidar.highest = node.number("highest", within(0, 89), lidar.highest);
  lidar.rate = node.number("rate", within(1, 50), lidar.rate);
  lidar.min_range = node.number("min_range", within(0, 5), lidar.min_range);
  lidar.max_range = node.number("max_range", within(1, 500), lidar.max_range);
  lidar.noise = node.number("noise", within(0, 0.5), lidar.noise);
  lidar.rosette = node.choice("pattern", {"rings", "rosette"}, lidar.rosette ? 1 : 0) == 1;
  if (lidar.min_range >= lidar.max_range)
    node.fail(Reason::out_of_range, "expected min_range below max_range");
  return lidar;
}

ImuConfig read_imu(const Node& node, bool flies) {
  ImuConfig imu;
  imu.mounting = read_mounting(node, flies);
  read_source(node, imu.topic, imu.frame);
  imu.rate = node.number("rate", within(10, 2000), imu.rate);
  return imu;
}

CameraConfig read_camera(const Node& node, bool flies, const std::optional<Mounting>& usual) {
  CameraConfig camera;
  camera.name = node.text("name", camera.name);
  if (!command::valid_name(camera.name) || camera.name.size() > 16)
    node.fail(Reason::out_of_range, "expected a name of up to 16 letters, digits, - and _");
  camera.mounting = read_mounting(node, flies, usual);
  camera.topic = node.text("topic", camera.topic);
  if (camera.topic.empty()) node.fail(Reason::out_of_range, "expected a topic that is not empty");
  camera.field_of_view = node.number("field_of_view", within(0.2, 2.6), camera.field_of_view);
  camera.rate = node.number("rate", within(1, 60), camera.rate);
  camera.width = static_cast<int>(node.integer("width", 16, 1920, camera.width));
  camera.height = static_cast<int>(node.integer("height", 16, 1080, camera.height));
  camera.compressed = node.choice("sends", {"raw", "jpeg"}, camera.compressed ? 1 : 0) == 1;
  return camera;
}

}  // namespace

std::vector<CameraConfig> read_cameras(const Node& cameras, bool flies,
                                       const std::optional<Mounting>& usual) {
  std::vector<CameraConfig> out;
  const std::vector<Node> each = cameras.is_list() ? cameras.as_list() : std::vector<Node>{cameras};
  if (each.empty() || each.size() > Sensors::kMaxCameras)
    cameras.fail(Reason::out_of_range, "expected 1 to 8 cameras");
  for (const Node& node : each) {
    CameraConfig read = read_camera(node, flies, usual);
    for (const CameraConfig& other : out)
      if (other.topic == read.topic || other.name == read.name)
        node.fail(Reason::out_of_range, "expected a topic and a name that no other camera has");
    if (out.size() < Sensors::kMaxCameras) out.push_back(std::move(read));
  }
  return out;
}

Sensors read_sensors(const Node& sensors, const LidarConfig& usual, bool flies) {
  Sensors out;
  const Node lidar = sensors.child_if("lidar");
  if (lidar.present()) {
    const std::vector<Node> each = lidar.is_list() ? lidar.as_list() : std::vector<Node>{lidar};
    if (each.empty() || each.size() > Sensors::kMaxLidars)
      lidar.fail(Reason::out_of_range, "expected 1 to 4 lidars");
    for (const Node& node : each) {
      const LidarConfig read = read_lidar(node, usual, flies);
      for (const LidarConfig& other : out.lidars)
        if (other.topic == read.topic || other.frame == read.frame)
          node.fail(Reason::out_of_range, "expected a topic and a frame that no other lidar has");
      if (out.lidars.size() < Sensors::kMaxLidars) out.lidars.push_back(read);
    }
  }
  if (const Node imu = sensors.child_if("imu"); imu.present()) out.imu = read_imu(imu, flies);
  if (const Node camera = sensors.child_if("camera"); camera.present())
    out.cameras = read_cameras(camera, flies);
  return out;
}

Result<Sensors> load_sensors_file(const std::string& path) {
  auto file = load(path);
  if (!file) return file.error();
  const bool outer = file->has("sensors");
  Sensors sensors = read_sensors(outer ? file->child("sensors") : *file, {}, true);
  if (auto done = file->finish(); !done) return done.error();
  if (sensors.lidars.empty()) return Error{Reason::missing_key, path + ": expected a lidar"};
  return sensors;
}

}  // namespace adit::config
