// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"
#include "sim/driver/sensor.hpp"
#include "sim/world/sweep.hpp"

/// What goes wrong in a rehearsal, as its YAML file says it; docs/rehearsal.md is the reference.
namespace adit::sim {

/// The process of a robot's agent or of a basestation dies and is started again; or a component of an agent
/// throws.
struct Crash {
  std::string victim{};     ///< A robot or a basestation.
  std::string component{};  ///< Component of a robot's agent; empty: the process.
};
/// A callback of a robot's component does not return.
struct Hang {
  std::string robot{}, component{};
};
struct CutLink {
  std::string a{}, b{};
  bool one_way{};  ///< Only messages from a to b.
  Duration duration{};
};
struct DegradeLink {
  std::string a{}, b{};
  double loss{};   ///< Probability in place of the link's.
  double delay{};  ///< Added to the latency, s.
  Duration duration{};
};
/// Nothing passes between the groups; who is in none of them is not concerned.
struct Partition {
  std::vector<std::vector<std::string>> groups{};
  Duration duration{};
};
/// Messages between two are held back, and overtaken by later ones.
struct Reorder {
  std::string a{}, b{};
  double chance{};
  double by{};  ///< Maximum, s.
  Duration duration{};
};
struct Duplicate {
  std::string a{}, b{};
  double chance{};
  Duration duration{};
};
/// The clock of a computer goes on by so much at once, as after a suspend.
struct ClockJump {
  std::map<std::string, Duration> by{};
};
struct SensorSilent {
  std::string robot{};
  Sensor sensor{Sensor::lidar};
  Duration duration{};
};
/// The drive is stationary and ignores commands.
struct StuckDrive {
  std::string robot{};
  Duration duration{};
};
struct DiskFull {
  std::string robot{};
  Duration duration{};
};
/// A foreign participant writes well-formed commands and joystick samples to `robot` in `as`'s name.
struct Forge {
  std::string as{}, robot{};
  Duration duration{};
};
/// `by`'s joystick hangs: his own participant streams a pushed stick to `robot`, whatever the mode.
struct StuckStick {
  std::string by{}, robot{};
  Duration duration{};
};
/// No fault, but it happens by itself, too: a component of the robot reports a finding where it stands.
struct Find {
  std::string robot{};
  std::string kind{};  ///< 1 to 32 bytes
  int importance{1};   ///< 0 to 255
  int photo{};  ///< Size of its photo, kB, [0, 256]; 0: it has none. With a photo a program reports it.
};

/// No fault either: a program on the robot steers, in mode `external`, 20 times a second.
struct Steer {
  std::string robot{};
  Twist2 velocity{};  ///< Body frame.
  Duration duration{};
};
/// The robot's driver is restarted: its odometry starts at zero where the robot is.
struct OdometryReset {
  std::string robot{};
};
/// The wheels report that velocity (body frame, m/s and rad/s) while the body is stuck, whatever is
/// commanded.
struct Slip {
  std::string robot{};
  double vx{}, wz{};
  Duration duration{};
};
/// The body turns by that share, (0, 1], less than the wheels report.
struct TurnSlip {
  std::string robot{};
  double share{};
  Duration duration{};
};
/// The stamps of a sensor are that far off; its messages come at the same time as before.
struct DriverClock {
  std::string robot{};
  Duration jump{};
  Sensor sensor{Sensor::lidar};
  Duration duration{};  ///< 0: to the end.
};
/// The stamps of a sensor are 0.
struct NoStamp {
  std::string robot{};
  Sensor sensor{Sensor::lidar};
  Duration duration{};  ///< 0: to the end.
};
/// The robot's driver is restarted: its odometry begins again at that pose of its frame, where the robot is.
struct DriverRestart {
  std::string robot{};
  Pose2 origin{};
};
/// Packets of the robot's lidar are lost.
struct LoseColumns {
  std::string robot{};
  ColumnLoss loss{};
  Duration duration{};
};
/// Something, a hand, covers the robot's lidar, see SweepJob::covered.
struct Cover {
  std::string robot{};
  Duration duration{};
};
/// The JPEGs of the robot's cameras end in their middle, see RobotDriver::break_jpegs.
struct BrokenJpeg {
  std::string robot{};
  Duration duration{};
};
/// A solid box appears as soon as neither a person nor a robot is in it, as a door that shuts: see
/// Simulation::close.
struct Close {
  std::array<double, 6> box{};  ///< x0, x1, y0, y1, z0, z1, world frame, m.
  Duration duration{};
};
/// A second computer with the name of that robot comes on the air: an agent with a disk of its own and no
/// driver.
struct Twin {
  std::string robot{};
  Duration duration{};
};

struct Fault {
  Duration at{};
  std::variant<Crash, Hang, CutLink, DegradeLink, Partition, Reorder, Duplicate, ClockJump, SensorSilent,
               StuckDrive, DiskFull, Forge, StuckStick, Find, Steer, OdometryReset, Twin, Slip, TurnSlip,
               DriverClock, NoStamp, DriverRestart, LoseColumns, Cover, BrokenJpeg, Close>
      what{};
};

/// The key of a fault in a scenario file: crash, hang, cut, ...
std::string kind_of(const Fault& fault);
/// As it is written in a scenario file, a mapping in one line.
std::string to_yaml(const Fault& fault);
/// How long it lasts, 0: to the end; null for what happens in an instant.
Duration* duration_of(Fault& fault);

}  // namespace adit::sim
