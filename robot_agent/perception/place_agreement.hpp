// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/geometry/pose.hpp"

namespace adit::agent {

/// Whether two scans in a row of a lost robot find the same place.
///
/// A lost robot holds, so that the two are usually of the same view: they prove no more than one that the
/// place is the right one. That is what the comparison with all other places within reach is for, see
/// perception::relocalise(). The second scan protects from accidents of one scan: people who walk through it,
/// dust, or a robot that still rocks. To wait until the body has moved would keep a robot lost that could
/// find its place, as only its operator can move it.
class PlaceAgreement {
 public:
  static constexpr double kSame = 0.3, kSameTurn = 0.1;  ///< Of two results, m and rad, as in relocalise().

  /// The frame in which a place was found; results of different ones are not comparable.
  struct Frame {
    std::uint32_t odom_epoch{};
    std::uint32_t jumps{};  ///< See PoseCorrection::jumps().
    bool operator==(const Frame&) const = default;
  };

  /// Takes the result of a scan. `correction`: from `guess` to where it was found, odometry frame. Returns
  /// whether the result before says the same; then it begins again.
  bool agrees(const Pose3& correction, const Pose3& guess, const Frame& frame) {
    const auto before = std::exchange(first_, First{correction, frame});
    if (!before || before->frame != frame) return false;
    const Pose3 at = correction * guess, expected = before->correction * guess;
    if ((at.position - expected.position).norm() > kSame ||
        std::abs(wrap_angle(at.yaw() - expected.yaw())) > kSameTurn)
      return false;
    first_.reset();
    return true;
  }
  /// A scan found no place, or the robot is not lost.
  void reset() { first_.reset(); }

 private:
  struct First {
    Pose3 correction{};
    Frame frame{};
  };
  std::optional<First> first_{};
};

}  // namespace adit::agent
