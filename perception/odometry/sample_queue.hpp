// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>

#include "core/geometry/pose.hpp"
#include "perception/types/body_motion.hpp"
#include "perception/types/imu_sample.hpp"

namespace adit::perception {

/// A step between two stamps of one sensor that is longer, or so far back, is a clock that was set, or a
/// sensor that was silent, ns. Sensors of motion send 10 samples a second or more, a lidar at least one
/// sweep.
inline constexpr std::uint64_t kClockStep = 1'000'000'000;

/// Time from one stamp to another, negative when `later` is the earlier one, s.
inline double seconds_between(std::uint64_t earlier, std::uint64_t later) {
  return static_cast<double>(static_cast<std::int64_t>(later - earlier)) * 1e-9;
}
/// Whether two stamps may be of one clock and one moment.
inline bool same_clock(std::uint64_t a, std::uint64_t b) { return (a > b ? a - b : b - a) <= kClockStep; }

/// Samples of one sensor of motion in the order of their stamps; bounded, the oldest are dropped.
///
/// A sample that is not of the clock of the one before waits for the next one. When that is of its clock, the
/// clock was set, and all samples before are dropped; else it was a single bad stamp, and is dropped itself.
template <class Sample>
class SampleQueue {
 public:
  static constexpr std::size_t kMaxSamples = 1024;

  /// Samples may come in any order; the second one with a stamp is ignored.
  void add(const Sample& sample) {
    if (newest_received_ != 0 && !same_clock(sample.stamp, newest_received_)) {
      const bool confirmed = suspect_ && same_clock(sample.stamp, suspect_->stamp);
      if (!confirmed) {
        suspect_ = sample;
        return;
      }
      samples_.assign(1, *suspect_);
      ++clock_steps_;
    }
    suspect_.reset();
    newest_received_ = sample.stamp;
    insert(sample);
  }
  /// Drops the samples before the last one that is not after `stamp`, and those of another clock ahead of
  /// `now`.
  void forget(std::uint64_t stamp, std::uint64_t now) {
    while (samples_.size() > 1 && samples_[1].stamp <= stamp) samples_.pop_front();
    while (!samples_.empty() && samples_.back().stamp > now + kClockStep) samples_.pop_back();
  }
  void clear() { samples_.clear(); }

  /// Whether there are samples from one stamp to another, without a gap longer than `gap`, ns.
  bool cover(std::uint64_t from, std::uint64_t to, std::uint64_t gap) const {
    std::uint64_t last = from;
    for (const Sample& each : samples_) {
      if (each.stamp <= last) continue;
      if (each.stamp - last > gap) return false;
      last = each.stamp;
      if (last >= to) return true;
    }
    return to - last <= gap;
  }
  /// Whether a sample of `stamp` or later is there, or none is to be expected: the sensor has another clock.
  bool reaches(std::uint64_t stamp) const {
    return newest_received_ != 0 &&
           ((!samples_.empty() && samples_.back().stamp >= stamp) || !same_clock(newest_received_, stamp));
  }
  int clock_steps() const { return clock_steps_; }  ///< How often the clock was set.
  const std::deque<Sample>& samples() const { return samples_; }

 private:
  void insert(const Sample& sample) {
    auto at = samples_.end();
    while (at != samples_.begin() && std::prev(at)->stamp > sample.stamp) --at;
    if (at != samples_.begin() && std::prev(at)->stamp == sample.stamp) return;
    samples_.insert(at, sample);
    if (samples_.size() > kMaxSamples) samples_.pop_front();
  }
  std::deque<Sample> samples_{};
  std::optional<Sample> suspect_{};
  std::uint64_t newest_received_{};  ///< Stamp of the sample that was added last.
  int clock_steps_{};
};

/// Mean of the samples in (from, to]; where there are none, interpolated over a gap of at most 50 ms.
std::optional<ImuSample> mean_of(const SampleQueue<ImuSample>& imu, std::uint64_t from, std::uint64_t to);
/// The pose at a stamp, interpolated over a gap of at most kMaxMotionGap.
std::optional<Pose3> pose_at(const SampleQueue<BodyMotion>& motions, std::uint64_t stamp);

inline constexpr std::uint64_t kMaxImuGap = 50'000'000;      ///< A longer gap between samples is bridged, ns.
inline constexpr std::uint64_t kMaxMotionGap = 600'000'000;  ///< ns

}  // namespace adit::perception
