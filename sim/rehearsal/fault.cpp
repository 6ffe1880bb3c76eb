// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/fault.hpp"

#include <fmt/format.h>

namespace adit::sim {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};

std::string list(const std::vector<std::string>& names) {
  return fmt::format("[{}]", fmt::join(names, ", "));
}
std::string pair(const std::string& a, const std::string& b) { return list({a, b}); }

std::string window(Duration duration) { return fmt::format(", for: {:.3f}", seconds(duration)); }

// Of what may last to the end.
std::string open_window(Duration duration) { return duration > 0ns ? window(duration) : std::string(); }

std::string sensor(Sensor sensor) { return ", sensor: " + sensor_words()[static_cast<std::size_t>(sensor)]; }

std::string component_of(const std::string& robot, const std::string& component) {
  return component.empty() ? robot : robot + "/" + component;
}

// Key and value, and what else there is.
std::pair<const char*, std::string> parts(const Fault& fault) {
  using Fields = std::pair<const char*, std::string>;
  return std::visit(
      Overloaded{
          [](const Crash& f) {
            return Fields{"crash", component_of(f.victim, f.component)};
          },
          [](const Hang& f) {
            return Fields{"hang", component_of(f.robot, f.component)};
          },
          [](const CutLink& f) {
            return Fields{"cut", pair(f.a, f.b) + (f.one_way ? ", one_way: true" : "") + window(f.duration)};
          },
          [](const DegradeLink& f) {
            const std::string delay = f.delay > 0.0 ? fmt::format(", delay: {:.3f}", f.delay) : "";
            return Fields{"degrade", pair(f.a, f.b) + fmt::format(", loss: {:.3f}", f.loss) + delay +
                                         window(f.duration)};
          },
          [](const Partition& f) {
            std::vector<std::string> groups;
            for (const auto& group : f.groups) groups.push_back(list(group));
            return Fields{"partition", list(groups) + window(f.duration)};
          },
          [](const Reorder& f) {
            return Fields{"reorder", pair(f.a, f.b) +
                                         fmt::format(", chance: {:.3f}, by: {:.3f}", f.chance, f.by) +
                                         window(f.duration)};
          },
          [](const Duplicate& f) {
            return Fields{"duplicate",
                          pair(f.a, f.b) + fmt::format(", chance: {:.3f}", f.chance) + window(f.duration)};
          },
          [](const ClockJump& f) {
            std::vector<std::string> jumps;
            for (const auto& [who, by] : f.by) jumps.push_back(fmt::format("{}: {:.3f}", who, seconds(by)));
            return Fields{"clock_jump", fmt::format("{{{}}}", fmt::join(jumps, ", "))};
          },
          [](const SensorSilent& f) {
            return Fields{"sensor_silent", f.robot + sensor(f.sensor) + window(f.duration)};
          },
          [](const StuckDrive& f) {
            return Fields{"stuck", f.robot + window(f.duration)};
          },
          [](const DiskFull& f) {
            return Fields{"disk_full", f.robot + window(f.duration)};
          },
          [](const Forge& f) {
            return Fields{"forge", pair(f.as, f.robot) + window(f.duration)};
          },
          [](const StuckStick& f) {
            return Fields{"stuck", pair(f.by, f.robot) + window(f.duration)};
          },
          [](const Find& f) {
            const std::string photo = f.photo > 0 ? fmt::format(", photo: {}", f.photo) : "";
            return Fields{
                "finds",
                fmt::format("\"{}\", robot: {}, importance: {}", f.kind, f.robot, f.importance) + photo};
          },
          [](const Steer& f) {
            return Fields{"steers", f.robot +
                                        fmt::format(", velocity: [{:.3f}, {:.3f}, {:.3f}]", f.velocity.vx,
                                                    f.velocity.vy, f.velocity.wz) +
                                        window(f.duration)};
          },
          [](const OdometryReset& f) {
            return Fields{"odometry_reset", f.robot};
          },
          [](const Twin& f) {
            return Fields{"twin", f.robot + window(f.duration)};
          },
          [](const Slip& f) {
            return Fields{
                "slip", f.robot + fmt::format(", wheels: [{:.3f}, {:.3f}]", f.vx, f.wz) + window(f.duration)};
          },
          [](const TurnSlip& f) {
            return Fields{"turn_slip",
                          f.robot + fmt::format(", share: {:.3f}", f.share) + window(f.duration)};
          },
          [](const DriverClock& f) {
            return Fields{"driver_clock", f.robot + fmt::format(", jump: {:.3f}", seconds(f.jump)) +
                                              sensor(f.sensor) + open_window(f.duration)};
          },
          [](const NoStamp& f) {
            return Fields{"no_stamp", f.robot + sensor(f.sensor) + open_window(f.duration)};
          },
          [](const DriverRestart& f) {
            return Fields{"driver_restart", f.robot + fmt::format(", origin: [{:.3f}, {:.3f}, {:.3f}]",
                                                                  f.origin.x, f.origin.y, f.origin.yaw)};
          },
          [](const LoseColumns& f) {
            const std::string& time = lost_time_words()[static_cast<std::size_t>(f.loss.time)];
            return Fields{"lose_columns", f.robot + fmt::format(", share: {:.3f}, time: ", f.loss.share) +
                                              time + window(f.duration)};
          },
          [](const Cover& f) {
            return Fields{"cover", f.robot + window(f.duration)};
          },
          [](const BrokenJpeg& f) {
            return Fields{"broken_jpeg", f.robot + window(f.duration)};
          },
          [](const Close& f) {
            return Fields{"close", fmt::format("[{:.3f}]", fmt::join(f.box, ", ")) + window(f.duration)};
          },
      },
      fault.what);
}

}  // namespace

std::string kind_of(const Fault& fault) { return parts(fault).first; }

std::string to_yaml(const Fault& fault) {
  const auto [key, value] = parts(fault);
  return fmt::format("{{at: {:.3f}, {}: {}}}", seconds(fault.at), key, value);
}

Duration* duration_of(Fault& fault) {
  return std::visit(
      [](auto& f) -> Duration* {
        if constexpr (requires { f.duration; })
          return &f.duration;
        else
          return nullptr;
      },
      fault.what);
}

}  // namespace adit::sim
