// SPDX-License-Identifier: Apache-2.0
#include "sim/drive/odometry_runner.hpp"

#include "sim/navtool/cpu_time.hpp"

namespace adit::sim {

OdometryRunner::OdometryRunner(const Platform& platform, const perception::LidarOdometryParams& params,
                               bool moves, OnStep on_step)
    : lidar_frame_(platform.lidar().frame),
      R_base_imu_(platform.imu.value_or(ImuConfig{}).mounting.pose().orientation),
      moves_(moves),
      on_step_(std::move(on_step)),
      input_(platform),
      odometry_(params) {
  input_.mark_isolated(true);
}

void OdometryRunner::add(const perception::ImuSample& sample) {
  if (moves_ && input_.add(sample, {})) {
    const double scale = input_.imu_in_g() ? perception::kStandardGravity : 1.0;
    odometry_.add({sample.stamp, R_base_imu_ * sample.gyro, R_base_imu_ * (scale * sample.accel)});
  }
  work();
}

void OdometryRunner::add(const perception::BodyMotion& sample) {
  if (moves_) {
    if (last_motion_ && sample.stamp > last_motion_->stamp) {
      const Pose3 moved = last_motion_->pose.inverse() * sample.pose;
      const double dt = static_cast<double>(sample.stamp - last_motion_->stamp) * 1e-9;
      input_.add_odometry(sample.stamp, moved.position / dt, sample.pose.yaw());
    }
    last_motion_ = sample;
    odometry_.add(sample);
  }
  work();
}

void OdometryRunner::add(perception::Sweep&& sweep) {
  constexpr std::size_t kMostWaiting = 10;
  waiting_.push_back(std::move(sweep));
  work();
  // The sensors of motion fell silent.
  if (waiting_.size() > kMostWaiting) take();
}

void OdometryRunner::finish() {
  while (!waiting_.empty()) take();
}

void OdometryRunner::work() {
  while (!waiting_.empty() && (!moves_ || odometry_.covers(perception::ScanInput::end_of(waiting_.front()))))
    take();
}

void OdometryRunner::take() {
  const perception::Sweep sweep = std::move(waiting_.front());
  waiting_.pop_front();
  const std::uint64_t end = perception::ScanInput::end_of(sweep);
  const double begin = navtool::cpu_ms();
  const bool located = odometry_.advance(end);
  if (located) correct(sweep);
  on_step_({sweep, end, located, odometry_.state(), navtool::cpu_ms() - begin});
}

void OdometryRunner::correct(const perception::Sweep& sweep) {
  const auto scan =
      input_.add(sweep, 0, lidar_frame_, [this](std::uint64_t stamp) { return odometry_.at(stamp); });
  // As in the agent: a sweep that cannot be used corrects nothing.
  if (scan && *scan) odometry_.update((*scan)->points, (*scan)->isolated, (*scan)->deskewed);
}

}  // namespace adit::sim
