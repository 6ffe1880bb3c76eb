// SPDX-License-Identifier: Apache-2.0
// Reads the faults of a robot's drive and sensors.
#include <algorithm>

#include "sim/rehearsal/scenario_parts.hpp"

namespace adit::sim {
namespace {

using config::Node;

constexpr double kFastestWheels = 2.0;   // m/s and rad/s: no platform of config/platforms/ is faster
constexpr double kFarthestJump = 2e9;    // s: as far as a stamp's 32 bits of seconds go
constexpr double kFarthestOrigin = 1e4;  // m and rad

// Of those that drive: what flies has neither wheels nor legs that slip.
std::string read_driving_robot(const Node& fault, const char* key, const Scenario& scenario) {
  const std::string id = read_robot(fault, key, scenario);
  const RobotSpec* robot = scenario.robot(id);
  if (robot && robot->settings.platform.flies())
    fault.child(key).fail(Reason::bad_argument, "expected a robot that drives or walks, not " + id);
  return id;
}

// What may last to the end: 0.
Duration read_open_length(const Node& fault) { return fault.has("for") ? read_length(fault) : Duration{}; }

bool has_camera(const Scenario& scenario, const std::string& id, bool of_jpegs = false) {
  const RobotSpec* robot = scenario.robot(id);
  if (!robot) return true;  // Which is an error already.
  const std::vector<CameraConfig>& all = robot->settings.platform.cameras;
  return std::any_of(all.begin(), all.end(),
                     [&](const CameraConfig& camera) { return camera.compressed || !of_jpegs; });
}

Sensor read_sensor(const Node& fault, const Scenario& scenario, const std::string& robot) {
  const auto sensor = static_cast<Sensor>(fault.choice("sensor", sensor_words(), 0));
  if (sensor == Sensor::imu && scenario.lidar != LidarKind::full)
    fault.child("sensor").fail(Reason::bad_argument, "expected lidar: full, whose robots have an imu");
  if (sensor == Sensor::camera && !has_camera(scenario, robot))
    fault.child("sensor").fail(Reason::bad_argument, "expected a robot with a camera, not " + robot);
  return sensor;
}

Slip read_slip(const Node& fault, const Scenario& scenario) {
  Slip out;
  out.robot = read_driving_robot(fault, "slip", scenario);
  const std::vector<double> wheels =
      fault.numbers("wheels", 2, 2, config::within(-kFastestWheels, kFastestWheels));
  if (wheels.size() == 2) {
    out.vx = wheels[0];
    out.wz = wheels[1];
  }
  out.duration = read_length(fault);
  return out;
}

TurnSlip read_turn_slip(const Node& fault, const Scenario& scenario) {
  return {read_driving_robot(fault, "turn_slip", scenario),
          fault.number("share", config::positive_up_to(1.0)), read_length(fault)};
}

DriverClock read_driver_clock(const Node& fault, const Scenario& scenario) {
  const std::string robot = read_robot(fault, "driver_clock", scenario);
  const double jump = fault.number("jump", config::within(-kFarthestJump, kFarthestJump));
  return {robot, from_seconds(jump), read_sensor(fault, scenario, robot), read_open_length(fault)};
}

DriverRestart read_restart(const Node& fault, const Scenario& scenario) {
  DriverRestart out;
  out.robot = read_robot(fault, "driver_restart", scenario);
  const std::vector<double> origin =
      fault.numbers("origin", 3, 3, config::within(-kFarthestOrigin, kFarthestOrigin));
  if (origin.size() == 3) out.origin = {origin[0], origin[1], wrap_angle(origin[2])};
  return out;
}

// Of a lidar whose beams are simulated one by one.
std::string read_swept_robot(const Node& fault, const char* key, const Scenario& scenario) {
  const std::string id = read_robot(fault, key, scenario);
  if (scenario.lidar != LidarKind::full)
    fault.child(key).fail(Reason::bad_argument, "expected lidar: full, whose beams are simulated one by one");
  return id;
}

LoseColumns read_lost_columns(const Node& fault, const Scenario& scenario) {
  LoseColumns out;
  out.robot = read_swept_robot(fault, "lose_columns", scenario);
  out.loss.share = fault.number("share", config::positive_up_to(1.0));
  out.loss.time = static_cast<LostTime>(fault.choice("time", lost_time_words(), 0));
  out.duration = read_length(fault);
  return out;
}

BrokenJpeg read_broken_jpeg(const Node& fault, const Scenario& scenario) {
  const std::string robot = read_robot(fault, "broken_jpeg", scenario);
  if (!has_camera(scenario, robot, true))
    fault.child("broken_jpeg")
        .fail(Reason::bad_argument, "expected a robot with a camera that sends jpeg, not " + robot);
  return {robot, read_length(fault)};
}

}  // namespace

Duration read_length(const Node& fault) {
  return from_seconds(fault.number("for", config::positive_up_to(kLongestTime)));
}

const std::vector<std::string>& driver_fault_kinds() {
  static const std::vector<std::string> kinds{"sensor_silent", "slip",     "turn_slip",
                                              "driver_clock",  "no_stamp", "driver_restart",
                                              "lose_columns",  "cover",    "broken_jpeg"};
  return kinds;
}

void read_driver_fault(const Node& node, const std::string& kind, const Scenario& scenario, Fault& out) {
  if (kind == "sensor_silent") {
    const std::string robot = read_robot(node, "sensor_silent", scenario);
    out.what = SensorSilent{robot, read_sensor(node, scenario, robot), read_length(node)};
  }
  if (kind == "slip") out.what = read_slip(node, scenario);
  if (kind == "turn_slip") out.what = read_turn_slip(node, scenario);
  if (kind == "no_stamp") {
    const std::string robot = read_robot(node, "no_stamp", scenario);
    out.what = NoStamp{robot, read_sensor(node, scenario, robot), read_open_length(node)};
  }
  if (kind == "driver_restart") out.what = read_restart(node, scenario);
  if (kind == "lose_columns") out.what = read_lost_columns(node, scenario);
  if (kind == "cover") out.what = Cover{read_swept_robot(node, "cover", scenario), read_length(node)};
  if (kind == "broken_jpeg") out.what = read_broken_jpeg(node, scenario);
  if (kind == "driver_clock") out.what = read_driver_clock(node, scenario);
}

}  // namespace adit::sim
