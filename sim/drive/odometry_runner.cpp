// SPDX-License-Identifier: Apache-2.0
#include "sim/drive/odometry_runner.hpp"

#include "perception/input/deskew.hpp"
#include "perception/input/scan_input.hpp"
#include "sim/navtool/cpu_time.hpp"

namespace adit::sim {

OdometryRunner::OdometryRunner(const Platform& platform, const perception::LidarOdometryParams& params,
                               bool moves, OnStep on_step)
    : lidar_(platform.lidar()),
      T_base_lidar_(lidar_.mounting.pose()),
      R_base_imu_(platform.imu.value_or(ImuConfig{}).mounting.pose().orientation),
      moves_(moves),
      on_step_(std::move(on_step)),
      odometry_(params) {}

void OdometryRunner::add(const perception::ImuSample& sample) {
  if (moves_) odometry_.add({sample.stamp, R_base_imu_ * sample.gyro, R_base_imu_ * sample.accel});
  work();
}

void OdometryRunner::add(const perception::BodyMotion& sample) {
  if (moves_) odometry_.add(sample);
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
  if (located) correct(sweep, end);
  on_step_({sweep, end, located, odometry_.state(), navtool::cpu_ms() - begin});
}

void OdometryRunner::correct(const perception::Sweep& sweep, std::uint64_t end) {
  perception::Deskew deskew = perception::Deskew::none(T_base_lidar_);
  bool deskewed = false;
  if (sweep.timed) {
    const auto pose = [this](std::uint64_t stamp) { return odometry_.at(stamp); };
    auto over = perception::Deskew::over(sweep.stamp, end, pose, T_base_lidar_);
    deskewed = over.ok();
    if (over) deskew = std::move(*over);
  }
  const auto low = static_cast<float>(lidar_.min_range), high = static_cast<float>(lidar_.max_range);
  points_.clear();
  const std::vector<std::uint8_t>& isolated = isolated_.find(sweep);
  for (std::size_t n = 0; n < sweep.points.size(); ++n) {
    const perception::TimedPoint& p = sweep.points[n];
    if (!isolated.empty() && isolated[n] != 0) continue;
    const float squared = p.position.squaredNorm();  // Of NaN all comparisons are false.
    if (squared >= low * low && squared <= high * high) points_.push_back(deskew(p.position, p.time));
  }
  odometry_.update(points_, {}, deskewed);
}

}  // namespace adit::sim
