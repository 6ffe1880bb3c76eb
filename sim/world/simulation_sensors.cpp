// SPDX-License-Identifier: Apache-2.0
// The part of the simulation that makes bodies and sensors realistic, and its cameras.
#include <algorithm>
#include <cmath>

#include "sim/world/noise.hpp"
#include "sim/world/simulation.hpp"

namespace adit::sim {
namespace {

constexpr double kSettled = 1e6;  // s: an error process of any correlation time has reached its deviation
constexpr std::uint64_t kLidarParts = 100;         // of a sweep's seed; below are those of its faults
constexpr double kGrain = 2.0;                     // of 255: noise of a pixel, PictureJob::grain
constexpr std::uint64_t kCameraPart = 200;         // of a picture's seed
constexpr std::uint64_t kSensorParts = 1'000'000;  // seeds of parts from here on are the sensors'

}  // namespace

void Simulation::equip(const RobotStart& start) {
  if (!params_.realistic) return;
  Robot& robot = robots_.back();
  const Platform& platform = start.platform;
  const std::uint64_t seed = derive_seed(params_.seed, kSensorParts + robots_.size());
  robot.real.emplace(platform, params_.imu, params_.noise, seed);
  Realism& real = *robot.real;
  for (std::size_t n = 0; n < real.lidars.size(); ++n) {
    MountedLidar& lidar = real.lidars[n];
    lidar.pattern = n == 0 ? robot.lidar : lidar_of(platform, platform.lidars[n]);
    lidar.errors.dust = params_.dust;
    if (params_.dropouts) lidar.errors.dropouts = *params_.dropouts;
  }
  Truth& truth = robot.truth;
  real.ground = {truth.pose.position.z(), 0.0, 0.0};
  if (const auto ground =
          platform.flies() ? std::nullopt : ground_attitude(*robot.ground, platform, start.pose))
    real.ground = *ground;
  real.chassis.start(real.ground);
  robot.odometry.rise(real.ground.z - truth.pose.position.z());
  robot.odometry.lean(real.ground, kSettled);
  truth.pose = {{start.pose.x, start.pose.y, real.ground.z}, real.ground.orientation(start.pose.yaw)};
  real.history.assign(sweep_steps() + 1, truth.pose);
}

std::size_t Simulation::sweep_steps() const {
  return std::max<std::size_t>(1, std::lround(1.0 / (params_.lidar.rate * seconds(params_.step))));
}

Duration Simulation::sweep_duration() const { return params_.step * static_cast<int>(sweep_steps()); }

void Simulation::settle(Robot& robot, const Twist2& before, bool moved) {
  Realism& real = *robot.real;
  Truth& truth = robot.truth;
  const Platform& platform = robot.body.platform();
  const double dt = seconds(params_.step);
  const Twist2& v = truth.twist;
  const Eigen::Vector2d acceleration((v.vx - before.vx) / dt - v.vy * v.wz,
                                     (v.vy - before.vy) / dt + v.vx * v.wz);
  const Pose2 at = robot.body.pose();
  if (platform.flies())
    real.ground.z = truth.pose.position.z();
  else if (const auto ground = moved ? ground_attitude(*robot.ground, platform, at) : std::nullopt)
    real.ground = *ground;
  const double speed = std::hypot(v.vx, v.vy) + 0.5 * platform.length * std::abs(v.wz);
  real.chassis.advance(real.ground, acceleration, speed, dt);
  const Attitude attitude = real.chassis.attitude();
  robot.odometry.rise(attitude.z - truth.pose.position.z());
  robot.odometry.lean(attitude, dt);
  truth.pose = {{at.x, at.y, attitude.z}, attitude.orientation(at.yaw)};
}

void Simulation::sense() {
  if (!params_.realistic) return;
  for (Robot& robot : robots_) {
    Realism& real = *robot.real;
    const Platform& platform = robot.body.platform();
    const double speed = std::hypot(robot.truth.twist.vx, robot.truth.twist.vy);
    const double wheels = std::abs(robot.traction.spin().value_or(Twist2{}).vx);
    const double effort =
        platform.flies() ? 1.0 : std::min(1.0, std::max(speed, wheels) / platform.max_speed);
    real.imu.advance(robot.truth.pose, now_, params_.step, effort);
    real.history.pop_front();
    real.history.push_back(robot.truth.pose);
  }
  for (std::size_t n = 0; n < people_.size(); ++n) {
    walked_[n].pop_front();
    walked_[n].push_back(people_[n].body().pose);
  }
}

std::vector<ImuSample> Simulation::take_imu(std::size_t robot) {
  return robots_[robot].real ? robots_[robot].real->imu.take() : std::vector<ImuSample>{};
}

std::uint64_t Simulation::sensor_seed(std::size_t robot) const {
  return derive_seed(params_.seed, 2 * kSensorParts + robot);
}

SweepJob Simulation::sweep(std::size_t index, std::size_t of) const {
  const Robot& robot = robots_[index];
  const Realism& real = *robot.real;
  SweepJob job;
  job.world = world_;
  const MountedLidar& lidar = real.lidars[of];
  job.lidar = lidar.pattern;
  job.errors = lidar.errors;
  job.duration = seconds(sweep_duration());
  job.seed = derive_seed(params_.seed ^ (steps_ << 8), 2 * index + 2);
  if (of > 0) job.seed = derive_seed(job.seed, kLidarParts + of);
  for (const Pose3& T_world_base : real.history)
    job.T_world_lidar.push_back(T_world_base * lidar.T_base_lidar);
  job.others.assign(sweep_steps(), shutter_bodies());
  for (std::size_t interval = 0; interval < job.others.size(); ++interval) {
    std::vector<BodyBox>& others = job.others[interval];
    for (std::size_t n = 0; n < robots_.size(); ++n) {
      if (n == index) continue;
      const Platform& platform = robots_[n].body.platform();
      const Pose3& pose = robots_[n].real->history[interval + 1];
      others.push_back({pose.planar(), pose.position.z(), platform.length, platform.width, platform.height});
    }
    for (std::size_t n = 0; n < people_.size(); ++n) {
      const Rectangle body = people_[n].body();
      const Pose2& pose = walked_[n][interval + 1];
      const double ground = robot.ground->ground(pose.x, pose.y);
      others.push_back({pose, std::isnan(ground) ? robot.truth.pose.position.z() : ground, body.length,
                        body.width, Person::kHeight});
    }
  }
  return job;
}

PictureJob Simulation::picture(std::size_t index, std::size_t of) const {
  const Robot& robot = robots_[index];
  const CameraConfig& camera = robot.body.platform().cameras[of];
  PictureJob job;
  job.world = world_;
  job.T_world_camera = robot.truth.pose * camera.mounting.pose();
  job.field_of_view = camera.field_of_view;
  job.width = camera.width;
  job.height = camera.height;
  job.grain = kGrain * params_.noise;
  job.seed = derive_seed(derive_seed(params_.seed ^ (steps_ << 8), 2 * index + 2), kCameraPart + of);
  for (const BodyBox& body : shutter_bodies()) job.bodies.push_back({BodyKind::door, body});
  for (const BodyBox& body : other_robots(index)) job.bodies.push_back({BodyKind::robot, body});
  for (const BodyBox& body : people_bodies(index)) job.bodies.push_back({BodyKind::person, body});
  return job;
}

}  // namespace adit::sim
