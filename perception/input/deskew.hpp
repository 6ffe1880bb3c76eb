// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"
#include "perception/types/sweep.hpp"

namespace adit::perception {

/// T_odom_base at a stamp of the driver's clock, ns; an error where the pose is not known.
using PoseFunction = std::function<Result<Pose3>(std::uint64_t stamp)>;

/// Moves the points of a sweep to where they would have been measured at one instant.
///
/// The body's poses are asked for every few milliseconds. Between two of them a point takes the matrix that
/// lies between theirs: over 10 ms at 3 rad/s that is off by 0.1 mrad.
class Deskew {
 public:
  /// Asks for the poses between `from` and `to` (ns) and expresses them in base_link at `to`.
  /// Errors: those of `pose`.
  static Result<Deskew> over(std::uint64_t from, std::uint64_t to, const PoseFunction& pose,
                             const Pose3& T_base_sensor);
  /// All points belong to one instant.
  static Deskew none(const Pose3& T_base_sensor);

  /// A point of the sensor's frame, taken `time` s after `from`, in base_link at `to`.
  Eigen::Vector3f operator()(const Eigen::Vector3f& point, float time) const {
    const float at = std::clamp(time * per_second_, 0.0f, last_);
    const auto n = std::min(static_cast<std::size_t>(at), knots_.size() - 2);
    const float part = at - static_cast<float>(n);
    const Knot &a = knots_[n], &b = knots_[n + 1];
    const Eigen::Vector3f first = a(point), second = b(point);
    return first + part * (second - first);
  }

 private:
  struct Knot {
    Eigen::Matrix3f R;
    Eigen::Vector3f t;
    /// R * p + t, which Eigen does not inline here: it runs twice for every return.
    Eigen::Vector3f operator()(const Eigen::Vector3f& p) const {
      return {R(0, 0) * p.x() + R(0, 1) * p.y() + R(0, 2) * p.z() + t.x(),
              R(1, 0) * p.x() + R(1, 1) * p.y() + R(1, 2) * p.z() + t.y(),
              R(2, 0) * p.x() + R(2, 1) * p.y() + R(2, 2) * p.z() + t.z()};
    }
  };
  std::vector<Knot> knots_{};
  float per_second_{0}, last_{0};
};

}  // namespace adit::perception
