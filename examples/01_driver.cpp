// SPDX-License-Identifier: Apache-2.0
// Example 1: the driver of a robot.
//
//   example_driver DOMAIN          until Ctrl-C
//
// A driver connects the motors and sensors of a robot with Adit's robot domain: it obeys /cmd_vel, and
// publishes /odom and /scan. This one simulates its robot, which stands in the middle of an empty square room
// of 10 m. Replace `Robot` by your hardware. The types are those of ROS 2, so a ROS 2 node can do the same
// (docs/drivers.md).
#include <csignal>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>

#include "core/exec/live_runtime.hpp"
#include "core/geometry/pose.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/LaserScan.h"

namespace {

using namespace adit;

constexpr Duration kOdometryPeriod = 20ms;   // 50 Hz; the agent needs at least 10 Hz.
constexpr Duration kScanPeriod = 100ms;      // 10 Hz
constexpr Duration kCommandTimeout = 500ms;  // Without /cmd_vel for longer, the robot stops.
constexpr int kRays = 360;                   // Rays of one scan, one per degree.
constexpr double kRoom = 5.0;                // From the middle of the room to each wall, m.

/// The robot: a body without mass that follows each command exactly.
class Robot {
 public:
  /// `velocity`: in the body frame, m/s and rad/s.
  void set(const Twist2& velocity) { velocity_ = velocity; }
  void move(double dt) { pose_ = pose_ * Pose2{velocity_.vx * dt, velocity_.vy * dt, velocity_.wz * dt}; }
  const Pose2& pose() const { return pose_; }
  const Twist2& velocity() const { return velocity_; }
  bool moves() const { return velocity_.vx != 0.0 || velocity_.vy != 0.0 || velocity_.wz != 0.0; }
  /// Distance to the wall in a direction relative to the robot's front, m.
  double range(double bearing) const {
    const double c = std::cos(pose_.yaw + bearing), s = std::sin(pose_.yaw + bearing);
    const double to_x = c == 0.0 ? INFINITY : (std::copysign(kRoom, c) - pose_.x) / c;
    const double to_y = s == 0.0 ? INFINITY : (std::copysign(kRoom, s) - pose_.y) / s;
    return std::min(to_x, to_y);
  }

 private:
  Pose2 pose_{};
  Twist2 velocity_{};
};

/// Connects a Robot with the robot domain. All its functions run on one strand, so it needs no locks.
class Driver {
 public:
  Driver(wire::Participant& wire, Executor& strand) : wire_(wire), strand_(strand) {}

  Result<void> start() {
    auto odometry = wire::Writer<nav_msgs::msg::Odometry>::make(wire_, wire::topics::kOdom);
    if (!odometry) return odometry.error();
    auto scan = wire::Writer<sensor_msgs::msg::LaserScan>::make(wire_, wire::topics::kScan);
    if (!scan) return scan.error();
    auto command = wire::make_reader(
        wire_, wire::topics::kCmdVel, strand_,
        [this](const geometry_msgs::msg::Twist& twist, const wire::SampleInfo& info) { obey(twist, info); });
    if (!command) return command.error();
    odometry_ = std::move(*odometry);
    scan_ = std::move(*scan);
    command_ = std::move(*command);
    odometry_timer_ = strand_.every(kOdometryPeriod, [this] { step(); });
    scan_timer_ = strand_.every(kScanPeriod, [this] { publish_scan(); });
    return {};
  }

 private:
  void obey(const geometry_msgs::msg::Twist& twist, const wire::SampleInfo& info) {
    if (!commanded_) std::printf("driver: the agent is there\n");
    commanded_ = info.received;  // By our clock: never compare clocks of two programs.
    robot_.set({twist.linear().x(), twist.linear().y(), twist.angular().z()});
  }

  void step() {
    // The watchdog. Behind the agent and its parent process, the driver is the last that can stop the robot.
    if (commanded_ && strand_.now() - *commanded_ > kCommandTimeout) {
      std::printf("driver: /cmd_vel is silent%s\n", robot_.moves() ? ", stopping" : "");
      robot_.set({});
      commanded_.reset();
    }
    robot_.move(seconds(kOdometryPeriod));
    publish_odometry();
    if (robot_.moves() && ++steps_ % 50 == 0)
      std::printf("driver: at %.2f %.2f m, %.2f m/s\n", robot_.pose().x, robot_.pose().y,
                  robot_.velocity().vx);
    std::fflush(stdout);
  }

  void publish_odometry() {
    nav_msgs::msg::Odometry odometry;
    stamp(odometry.header(), "odom");
    odometry.child_frame_id("base_link");
    auto& pose = odometry.pose().pose();
    pose.position().x(robot_.pose().x);
    pose.position().y(robot_.pose().y);
    pose.orientation().z(std::sin(robot_.pose().yaw / 2.0));
    pose.orientation().w(std::cos(robot_.pose().yaw / 2.0));
    auto& twist = odometry.twist().twist();
    twist.linear().x(robot_.velocity().vx);
    twist.linear().y(robot_.velocity().vy);
    twist.angular().z(robot_.velocity().wz);
    (void)odometry_.write(odometry);  // The wire counts a failed write; the next sample follows in 20 ms.
  }

  void publish_scan() {
    sensor_msgs::msg::LaserScan scan;
    stamp(scan.header(), "base_link");
    scan.angle_increment(static_cast<float>(2.0 * std::numbers::pi / kRays));
    scan.angle_min(0.0f);
    scan.angle_max(scan.angle_increment() * (kRays - 1));
    scan.range_min(0.1f);
    scan.range_max(20.0f);
    for (int i = 0; i < kRays; ++i)
      scan.ranges().push_back(static_cast<float>(robot_.range(i * 2.0 * std::numbers::pi / kRays)));
    (void)scan_.write(scan);
  }

  /// The driver's own clock: the agent compares its stamps among each other only.
  void stamp(std_msgs::msg::Header& header, const char* frame) const {
    const std::int64_t ns = strand_.now().time_since_epoch().count();
    header.stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
    header.stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
    header.frame_id(frame);
  }

  wire::Participant& wire_;
  Executor& strand_;
  Robot robot_{};
  std::optional<Time> commanded_{};  // When the newest command arrived; unset: none yet, or it is too old.
  int steps_{};
  wire::Writer<nav_msgs::msg::Odometry> odometry_{};
  wire::Writer<sensor_msgs::msg::LaserScan> scan_{};
  std::unique_ptr<wire::RawReader> command_{};
  Timer odometry_timer_{}, scan_timer_{};
};

int fail(const Error& error) {
  std::fprintf(stderr, "driver: %s\n", error.text.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  wire::FastDdsParams params{.name = "example_driver", .large_samples = true};
  const std::string_view domain = argc == 2 ? argv[1] : "";
  if (std::from_chars(domain.data(), domain.data() + domain.size(), params.domain).ptr !=
          domain.data() + domain.size() ||
      domain.empty()) {
    std::fprintf(stderr, "usage: example_driver DOMAIN   (`robot_domain` in the robot's file)\n");
    return 2;
  }
  // Before any thread exists, so that every thread leaves these signals to the sigwait() below.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  auto wire = wire::open_fastdds(params);
  if (!wire) return fail(wire.error());
  LiveRuntime runtime;
  const auto strand = runtime.strand("driver");
  Driver driver(**wire, *strand);
  if (auto started = driver.start(); !started) return fail(started.error());
  std::printf("driver: ready on domain %u\n", params.domain);
  std::fflush(stdout);
  int number = 0;
  sigwait(&signals, &number);
  strand->end();  // Nothing runs on it any more when the driver is destroyed.
  return 0;
}
