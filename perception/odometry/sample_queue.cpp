// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/sample_queue.hpp"

namespace adit::perception {

std::optional<ImuSample> mean_of(const SampleQueue<ImuSample>& imu, std::uint64_t from, std::uint64_t to) {
  ImuSample mean;
  int count = 0;
  const ImuSample *before = nullptr, *after = nullptr;
  for (const ImuSample& s : imu.samples()) {
    if (s.stamp <= from) {
      before = &s;
      continue;
    }
    if (s.stamp > to) {
      after = &s;
      break;
    }
    mean.gyro += s.gyro;
    mean.accel += s.accel;
    ++count;
  }
  if (count > 0) {
    mean.gyro /= count;
    mean.accel /= count;
    return mean;
  }
  if (before && after && after->stamp - before->stamp <= kMaxImuGap) {
    const double part =
        seconds_between(before->stamp, (from + to) / 2) / seconds_between(before->stamp, after->stamp);
    mean.gyro = before->gyro + part * (after->gyro - before->gyro);
    mean.accel = before->accel + part * (after->accel - before->accel);
    return mean;
  }
  if (before && !after && to - before->stamp <= kMaxImuGap) return *before;
  return std::nullopt;
}

std::optional<Pose3> pose_at(const SampleQueue<BodyMotion>& motions, std::uint64_t stamp) {
  const auto& samples = motions.samples();
  const auto after =
      std::find_if(samples.begin(), samples.end(), [&](const auto& each) { return each.stamp >= stamp; });
  if (after == samples.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == samples.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (after->stamp - before->stamp > kMaxMotionGap) return std::nullopt;
  const double part = seconds_between(before->stamp, stamp) / seconds_between(before->stamp, after->stamp);
  return Pose3{before->pose.position + part * (after->pose.position - before->pose.position),
               before->pose.orientation.slerp(part, after->pose.orientation)};
}

}  // namespace adit::perception
