// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "sim/drive/drive_recording.hpp"
#include "sim/drive/path_follower.hpp"

namespace adit::sim {
namespace {

constexpr double kClockOffset = 0.005;  // s: of a sensor's clock to the driver's, as RobotDriver has it
constexpr double kPatience = 20.0;      // s: without 0.2 m or 0.2 rad of motion while it should move

std::uint64_t stamp_of(Duration at) { return kDriveStart + static_cast<std::uint64_t>(at.count()); }

perception::Sweep sweep_of(const std::vector<SweepPoint>& points, std::uint64_t stamp) {
  perception::Sweep out;
  out.stamp = stamp;
  out.timed = true;
  out.points.reserve(points.size());
  for (const SweepPoint& p : points) out.points.push_back({p.position(), p.t, p.intensity, p.ring});
  return out;
}

/// A level scan of one instant, which comes in base_link.
perception::Sweep scan_of(const PointCloud& points, const Pose3& T_base_lidar, bool planar,
                          std::uint64_t stamp) {
  perception::Sweep out;
  out.stamp = stamp;
  out.planar = planar;
  out.points.reserve(points.size());
  const Pose3 T_lidar_base = T_base_lidar.inverse();
  for (const Eigen::Vector3f& p : points)
    out.points.push_back({(T_lidar_base * Eigen::Vector3d(p.cast<double>())).cast<float>(), 0.0f, 0.0f, 0});
  return out;
}

SimulationParams params_of(const DriveSpec& spec) {
  SimulationParams out;
  out.lidar = spec.lidar;
  out.odometry = spec.odometry.scaled(spec.noise);
  out.seed = spec.seed;
  out.people = spec.people;
  out.realistic = spec.realistic;
  out.noise = spec.noise;
  out.imu = spec.imu;
  out.dust = spec.dust;
  out.dropouts = spec.dropouts;
  if (!spec.realistic) out.lidar.range_noise *= spec.noise;
  return out;
}

Result<void> check(const DriveSpec& spec) {
  if (!spec.world) return {Reason::bad_argument, "a drive needs a world"};
  if (!(spec.noise >= 0.0 && spec.noise <= 10.0)) return {Reason::out_of_range, "noise: expected 0 to 10"};
  if (!(spec.wheel_rate >= 1.0 && spec.wheel_rate <= 100.0))
    return {Reason::out_of_range, "wheel_rate: expected 1 to 100 Hz"};
  for (const DriveStep& step : spec.steps) {
    const auto* to = std::get_if<DriveTo>(&step);
    if (to && !(to->place.allFinite() && to->speed > 0.0 && to->speed <= spec.platform.max_speed))
      return {Reason::out_of_range,
              fmt::format("DriveTo: expected a place and a speed of 0 to {} m/s", spec.platform.max_speed)};
    const auto* by = std::get_if<TurnBy>(&step);
    if (by && !(std::isfinite(by->angle) && by->rate > 0.0 && by->rate <= spec.platform.max_turn))
      return {Reason::out_of_range,
              fmt::format("TurnBy: expected an angle and a rate of 0 to {} rad/s", spec.platform.max_turn)};
    if (by && !spec.platform.turns_on_spot())
      return {Reason::bad_argument, "TurnBy: this platform does not turn on the spot"};
    const auto* stand = std::get_if<StandFor>(&step);
    if (stand && !(stand->time >= 0.0 && stand->time <= 3600.0))
      return {Reason::out_of_range, "StandFor: expected 0 to 3600 s"};
  }
  return {};
}

/// Ends a drive that gets no farther.
class Watch {
 public:
  explicit Watch(const Pose2& start) : at_(start) {}
  bool stuck(const Pose2& pose, const Twist2& wanted, double dt) {
    const Pose2 moved = at_.inverse() * pose;
    idle_ = wanted.zero() ? 0.0 : idle_ + dt;
    if (std::hypot(moved.x, moved.y) > 0.2 || std::abs(moved.yaw) > 0.2) {
      at_ = pose;
      idle_ = 0.0;
    }
    return idle_ > kPatience;
  }

 private:
  Pose2 at_;
  double idle_{};
};

}  // namespace

Result<void> drive(const DriveSpec& spec, DriveSink& sink) {
  if (const Result<void> good = check(spec); !good) return good;
  Result<Simulation> made =
      Simulation::create(spec.world, {{"r1", spec.platform, spec.start}}, params_of(spec));
  if (!made) return made.error();
  Simulation& simulation = *made;
  Random clocks(simulation.sensor_seed(0));
  const Duration lidar_clock = from_seconds(clocks.uniform(-kClockOffset, kClockOffset) * spec.noise);
  const Duration imu_clock = from_seconds(clocks.uniform(-kClockOffset, kClockOffset) * spec.noise);
  const Duration step = simulation.params().step;
  const Duration sweep_period = simulation.sweep_duration();
  const Duration wheel_period = from_seconds(1.0 / spec.wheel_rate);
  const Pose3 T_base_lidar = spec.platform.lidar().mounting.pose();
  Duration next_sweep = sweep_period, next_wheels{};
  PathFollower follower(spec.steps, spec.platform, spec.start);
  Watch watch(spec.start);
  // The last sweep is completed after the last step.
  while (!follower.done() || next_sweep - simulation.now() < sweep_period) {
    const Truth& truth = simulation.truth(0);
    const Twist2 wanted = follower.command(truth.pose.planar(), seconds(step));
    simulation.command(0, wanted);
    simulation.step();
    const Duration now = simulation.now();
    for (const Collision& contact : simulation.collisions())
      if (contact.partner == "world")
        return {Reason::bad_argument,
                fmt::format("the path touches the world at ({:.2f}, {:.2f}), in step {}", contact.pose.x,
                            contact.pose.y, follower.step())};
    if (watch.stuck(truth.pose.planar(), wanted, seconds(step)))
      return {Reason::bad_argument,
              fmt::format("stuck at ({:.2f}, {:.2f}), in step {}", truth.pose.position.x(),
                          truth.pose.position.y(), follower.step())};
    sink.on_truth({stamp_of(now), truth.pose});
    for (const ImuSample& sample : simulation.take_imu(0))
      sink.on_imu({stamp_of(sample.at + imu_clock), sample.gyro, sample.accel});
    if (now >= next_wheels) {
      next_wheels += wheel_period;
      const Odometry& odometry = simulation.odometry(0);
      const Pose2& pose = odometry.pose();
      sink.on_wheels({stamp_of(now),
                      {{pose.x, pose.y, simulation.altitude(0)}, odometry.orientation()},
                      odometry.sigma()});
    }
    if (now < next_sweep) continue;
    next_sweep += sweep_period;
    if (spec.realistic)
      sink.on_sweep(sweep_of(simulation.sweep(0).trace(), stamp_of(now - sweep_period + lidar_clock)));
    else
      sink.on_sweep(scan_of(simulation.scan(0).compute(), T_base_lidar, spec.lidar.folded, stamp_of(now)));
  }
  return {};
}

}  // namespace adit::sim
