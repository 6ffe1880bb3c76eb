// SPDX-License-Identifier: Apache-2.0
#include "sim/drive/drive_recording.hpp"

#include <algorithm>

namespace adit::sim {

std::uint64_t DriveRecording::end_of(const perception::Sweep& sweep) {
  const double last = sweep.timed && !sweep.points.empty() ? sweep.points.back().time : 0.0;
  return sweep.stamp + static_cast<std::uint64_t>(std::max(0.0, last) * 1e9);
}

void DriveRecording::play(DriveSink& sink) const {
  std::size_t i = 0, w = 0, t = 0;
  const auto until = [&](std::uint64_t stamp) {
    constexpr std::uint64_t none = ~std::uint64_t{0};
    while (true) {
      const std::uint64_t next_truth = t < truth.size() ? truth[t].stamp : none;
      const std::uint64_t next_imu = i < imu.size() ? imu[i].stamp : none;
      const std::uint64_t next_wheels = w < wheels.size() ? wheels[w].stamp : none;
      const std::uint64_t next = std::min({next_truth, next_imu, next_wheels});
      if (next == none || next > stamp) return;
      if (next_truth == next)
        sink.on_truth(truth[t++]);
      else if (next_imu == next)
        sink.on_imu(imu[i++]);
      else
        sink.on_wheels(wheels[w++]);
    }
  };
  for (const perception::Sweep& sweep : sweeps) {
    until(end_of(sweep));
    sink.on_sweep(perception::Sweep(sweep));
  }
  until(~std::uint64_t{0} - 1);
}

Pose3 DriveRecording::truth_at(std::uint64_t stamp) const {
  const auto after = std::upper_bound(truth.begin(), truth.end(), stamp,
                                      [](std::uint64_t s, const TruthSample& p) { return s < p.stamp; });
  if (after == truth.begin()) return truth.front().pose;
  if (after == truth.end()) return truth.back().pose;
  const TruthSample &a = *(after - 1), &b = *after;
  const double part = static_cast<double>(stamp - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  return {a.pose.position + part * (b.pose.position - a.pose.position),
          a.pose.orientation.slerp(part, b.pose.orientation)};
}

double DriveRecording::distance() const {
  double out = 0.0;
  for (std::size_t n = 1; n < truth.size(); ++n)
    out += (truth[n].pose.position - truth[n - 1].pose.position).norm();
  return out;
}

Result<DriveRecording> record_drive(const DriveSpec& spec) {
  DriveRecording out;
  if (const Result<void> driven = drive(spec, out); !driven) return driven.error();
  return out;
}

}  // namespace adit::sim
