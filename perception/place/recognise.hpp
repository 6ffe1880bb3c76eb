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
  bool planar{false};  ///< The scan is of one horizontal ring, see kPlanarHeight.
};

/// Result of a comparison with keyframes.
enum class PlaceMatch {
  nothing_stored,  ///< No keyframe near the guess shows enough; so there is nothing to compare with.
  cannot_tell,     ///< The scan shows too little; another one may show more.
  found,           ///< The scan lies on the keyframes' surfaces.
};

/// A place that was compared with keyframes.
struct RecognisedPlace {
  /// From where the robot believed that it is to where it is, odometry frame: a shift and a turn about the
  /// vertical axis.
  Pose3 correction{};  ///< The identity unless `match` is `found`.
  double overlap{};
  double runner_up{};  ///< Overlap of the best place elsewhere, by relocalise().
  PlaceMatch match{PlaceMatch::nothing_stored};
};

/// Keyframes within this distance show the same surfaces, m.
inline constexpr double kNearKeyframe = 25.0;

/// A scan with fewer points determines no pose. With 16 rings and more that is less than 1 % of a sweep. Of a
/// single ring each point stands for a piece of wall, and 60 are a sixth of a turn with one ray a degree.
inline constexpr std::size_t kMinPlacePoints = 200, kMinPlanarPoints = 60;

/// Compares a scan with keyframes of the same odometry frame.
///
/// @param points  In base_link, m.
/// @param guess   T_odom_base.
/// Errors: not_localised_here, with what differs.
Result<RecognisedPlace> recognise(std::span<const Keyframe> keyframes,
                                  std::span<const Eigen::Vector3f> points, const Pose3& guess,
                                  const RecogniseParams& params = {});

}  // namespace adit::perception
