// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"

namespace adit::agent {

/// Bounded history of a body's stamped poses in one frame; interpolates between samples.
///
/// All stamps are of one clock, ns. The oldest samples are dropped when the history is full.
class PoseHistory {
 public:
  static constexpr std::size_t kCapacity = 256;  ///< Samples: 5 s at 50 Hz.
  /// Two samples that are farther apart are not interpolated, ns.
  static constexpr std::uint64_t kLongestGap = 500'000'000;

  /// Adds a sample, also one older than the newest. A sample without a stamp (0), with the stamp of another
  /// one, or older than all of a full history is ignored.
  void add(std::uint64_t stamp, const Pose3& pose);
  /// The pose at `stamp`: linear in position, spherical linear in orientation. Errors: out_of_range before
  /// the oldest sample, after the newest one, in a gap longer than kLongestGap, and for stamp 0.
  Result<Pose3> at(std::uint64_t stamp) const;
  void clear() { poses_.clear(); }

  std::size_t size() const { return poses_.size(); }
  /// Stamp of the newest sample; 0: there is none.
  std::uint64_t newest() const { return poses_.empty() ? 0 : poses_.rbegin()->first; }

 private:
  std::map<std::uint64_t, Pose3> poses_{};  ///< By stamp.
};

}  // namespace adit::agent
