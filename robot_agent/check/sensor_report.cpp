// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

#include "robot_agent/check/sensor_check.hpp"

namespace adit::agent {
namespace {

constexpr double kRateError = 0.2;     ///< Relative to the file's rate.
constexpr double kOdometryRate = 10;   ///< 1/s, at least.
constexpr double kJitter = 0.2;        ///< Of the delay of a topic's messages, s.
constexpr double kSameClock = 0.3;     ///< Difference of two sensors' delays, s.
constexpr double kHeightError = 0.05;  ///< m
constexpr double kTiltError = 2;       ///< Of a lidar, degrees.
constexpr double kSteepest = 15;       ///< Of gravity to z of base_link on level ground, degrees.
constexpr double kGravity = 9.81, kGravityError = 0.5;  ///< m/s2
constexpr double kBias = 0.05;                          ///< Of a gyro at rest, rad/s.
constexpr double kTurnError = 0.25;                     ///< Of the gyro against the odometry, which slips.
constexpr double kAboutZ = 0.9;                         ///< Share of a turn on level ground that is about z.
constexpr std::uint64_t kBuffer = 4 << 20;  ///< The receive buffer that the agent asks for, bytes.

template <class... Args>
std::string print(const char* format, Args... args) {
  char text[240];
  std::snprintf(text, sizeof text, format, args...);
  return text;
}

double degrees(double radians) { return radians * 180 / M_PI; }

/// The axis of base_link that lies nearest to `up`, for example "-y".
std::string nearest_axis(const Eigen::Vector3d& up) {
  Eigen::Index axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  return std::string(up[axis] < 0 ? "-" : "+") + "xyz"[axis];
}

}  // namespace

std::vector<CheckLine> SensorCheck::report(bool turn) const {
  std::vector<CheckLine> out;
  report_stream(
      "odometry /odom", odometry_, 0, [](const std::string&) { return std::string(); }, out);
  for (std::size_t n = 0; n < lidars_.size(); ++n) {
    const Lidar& lidar = lidars_[n];
    const std::string name = "lidar /" + (lidar.planar ? "scan" : lidar.config.topic);
    report_stream(
        name, lidar.stream, lidar.config.rate, [&](const std::string& key) { return lines_.lidar(n, key); },
        out);
    if (lidar.stream.count > 0 && !lidar.planar && lidar.config.rings > 1 && !platform_.flies())
      report_ground(lidar, n, out);
  }
  if (platform_.imu) {
    report_stream(
        "imu /" + platform_.imu->topic, imu_, platform_.imu->rate,
        [&](const std::string& key) { return lines_.imu(key); }, out);
    if (standing_ > 0) report_imu(out);
    if (turn && standing_ > 0) report_turn(out);
  }
  if (battery_) out.push_back(*battery_);
  for (const auto& [topic, line] : two_sources_) out.push_back(line);
  out.insert(out.end(), topics_.begin(), topics_.end());
  return out;
}

void SensorCheck::report_stream(const std::string& name, const Stream& stream, double rate,
                                const std::function<std::string(const std::string&)>& line,
                                std::vector<CheckLine>& out) const {
  if (stream.count == 0) {
    out.push_back(
        {false, name, "no message; is the driver running, on this topic and domain?", line("topic")});
    return;
  }
  const double measured = stream.rate();
  if (rate > 0)
    out.push_back({std::fabs(measured / rate - 1) <= kRateError, name + ": rate",
                   print("%.1f per second, the file says %.1f", measured, rate), line("rate")});
  else
    out.push_back({measured >= kOdometryRate, name + ": rate",
                   print("%.1f per second, at least %.0f are needed", measured, kOdometryRate), ""});
  const double jitter = stream.most_delay - stream.least_delay;
  out.push_back({jitter <= kJitter, name + ": delay",
                 print("varies by %.0f ms, at most %.0f are usable", jitter * 1e3, kJitter * 1e3), ""});
  if (rate > 0 && odometry_.count > 0) {
    const double apart = stream.least_delay - odometry_.least_delay;
    out.push_back(
        {std::fabs(apart) <= kSameClock, name + ": clock",
         print("%.0f ms %s the odometry's", std::fabs(apart) * 1e3, apart > 0 ? "behind" : "ahead of"), ""});
  }
  if (rate > 0)
    for (const auto& [frame, count] : stream.frames) {
      const auto found = input_.find(frame);
      out.push_back({static_cast<bool>(found), name + ": frame",
                     found ? "'" + frame + "' is known" : found.error().text, line("frame")});
    }
  if (stream.unusable > 0)
    out.push_back({false, name + ": messages",
                   print("%zu of %zu cannot be used: ", stream.unusable, stream.count) + stream.error, ""});
}

void SensorCheck::report_ground(const Lidar& lidar, std::size_t n, std::vector<CheckLine>& out) const {
  const std::string name = "lidar /" + lidar.config.topic;
  const auto plane = lidar.ground.plane();
  if (!plane) {
    out.push_back({false, name + ": height", "no ground seen within 5 m", lines_.lidar(n, "z")});
    return;
  }
  const Mounting& m = lidar.config.mounting;
  const double height = m.z - plane->height;
  std::string found = print("%.2f m above the ground, the file says %.2f", height, m.z);
  const bool over = height < 0;
  if (over) found += ": is it mounted the other way up?";
  out.push_back({std::fabs(plane->height) <= kHeightError, name + ": height", found,
                 lines_.lidar(n, over ? "roll" : "z")});
  const double pitch = std::atan(plane->rise.x()), roll = -std::atan(plane->rise.y());
  const auto tilt = [&](const char* key, double error, double set) {
    out.push_back({std::fabs(degrees(error)) <= kTiltError, name + ": " + key,
                   print("off by %.1f degrees against the ground", degrees(error)) +
                       (m.yaw == 0 ? print("; %.3f would fit", set + error) : std::string()),
                   lines_.lidar(n, key)});
  };
  tilt("pitch", pitch, m.pitch);
  tilt("roll", roll, m.roll);
}

void SensorCheck::report_imu(std::vector<CheckLine>& out) const {
  const std::string name = "imu /" + platform_.imu->topic;
  const Eigen::Vector3d mean = force_ / static_cast<double>(standing_);
  const double size = mean.norm();
  const bool in_g = std::fabs(size * kGravity - kGravity) <= kGravityError;
  out.push_back({in_g || std::fabs(size - kGravity) <= kGravityError, name + ": gravity",
                 in_g ? print("%.2f: it measures in g, which is scaled", size)
                      : print("%.2f m/s2, 9.81 are expected", size),
                 lines_.imu("topic")});
  if (size > 0) {
    const Eigen::Vector3d up = mean / size;
    const double lean = degrees(std::acos(std::clamp(up.z(), -1.0, 1.0)));
    out.push_back({lean <= kSteepest, name + ": axis",
                   print("up is %.0f degrees off z of base_link", lean) +
                       (lean <= kSteepest ? std::string() : ", nearest to " + nearest_axis(up)),
                   lines_.imu("roll")});
  }
  const double bias = gyro_.norm() / static_cast<double>(standing_);
  out.push_back({bias <= kBias, name + ": gyro at rest",
                 print("%.3f rad/s, at most %.2f is usual; did the robot stand?", bias, kBias), ""});
}

void SensorCheck::report_turn(std::vector<CheckLine>& out) const {
  const std::string name = "imu /" + platform_.imu->topic + ": gyro in the turn";
  if (!turned()) {
    out.push_back({false, name, "the odometry showed less than a quarter turn", ""});
    return;
  }
  const bool fits = std::fabs(turns_.ratio() - 1) <= kTurnError;
  std::string found = print("%.2f times the turn of the odometry", turns_.ratio());
  if (!turns_.refusal().empty()) found += ": " + turns_.refusal();
  out.push_back({fits, name, found, lines_.imu("roll")});
  if (about_all_ > 0)
    out.push_back({about_z_ >= kAboutZ * about_all_, "imu /" + platform_.imu->topic + ": axis of the turn",
                   print("%.0f %% of it about z of base_link", 100 * about_z_ / about_all_),
                   lines_.imu("roll")});
}

CheckLine judge_buffer(std::uint64_t granted) {
  return {granted >= kBuffer, "socket buffers",
          print("the kernel grants %llu kB, scans need %llu", static_cast<unsigned long long>(granted >> 10),
                static_cast<unsigned long long>(kBuffer >> 10)),
          "sysctl -w net.core.rmem_max=" + std::to_string(kBuffer)};
}

std::string to_text(const std::vector<CheckLine>& lines) {
  std::string text;
  for (const CheckLine& line : lines) {
    text += (line.ok ? "OK     " : "wrong  ") + line.what + ": " + line.found;
    if (!line.ok && !line.where.empty()) text += "\n       change: " + line.where;
    text += "\n";
  }
  return text;
}

}  // namespace adit::agent
