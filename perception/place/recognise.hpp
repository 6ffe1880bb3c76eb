// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "perception/odometry/align.hpp"
#include "perception/place/keyframe.hpp"

namespace adit::perception {

/// Limits of the difference between a place and where the robot believes that it is.
struct RecogniseParams {
  double max_shift{0.5};                ///< In m.
  double max_turn{0.175};               ///< 10 degrees, in rad.
  double least_overlap{kAlignOverlap};  ///< See Alignment::overlap.
  /// The same when the surroundings are where they were expected, to 0.1 m and 2 degrees: two measurements
  /// agree.
  double confirming_overlap{0.5};
  double noise{0.02};  ///< Standard deviation of a range, m.
};

/// A place that was recognised.
struct RecognisedPlace {
  /// From where the robot believed that it is to where it is, odometry frame: a shift and a turn about the
  /// vertical axis.
  Pose3 correction{};
  double overlap{};
  /// Whether the scan is on the keyframes' surfaces; false: too few of them are near to compare with, and
  /// `correction` is the identity.
  bool compared{};
};

/// Compares a scan with keyframes of the same odometry frame.
///
/// @param points  In base_link, m.
/// @param guess   T_odom_base.
/// Errors: not_localised_here, with what differs.
Result<RecognisedPlace> recognise(std::span<const Keyframe> keyframes,
                                  std::span<const Eigen::Vector3f> points, const Pose3& guess,
                                  const RecogniseParams& params = {});

}  // namespace adit::perception
