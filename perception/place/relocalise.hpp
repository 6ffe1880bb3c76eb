// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numbers>
#include <span>

#include "perception/place/recognise.hpp"

namespace adit::perception {

/// What a lost robot knows of the error of its pose.
struct RelocaliseParams {
  double moved{0.5};                  ///< What the body can have done unseen, beyond the guess, m, [0, inf).
  double max_turn{std::numbers::pi};  ///< The same for its heading, rad, [0, pi].
  double noise{0.02};                 ///< Standard deviation of a range, m.
  bool planar{false};                 ///< The scan is of one horizontal ring, see kPlanarHeight.
  std::size_t max_squares{4000};      ///< Squares of the plan whose poses are compared, [1, inf).
};

/// Poses farther from the guess are not searched, m: as far as a robot of 2 m/s may be when the odometry
/// begins a new map, see LidarOdometry, and 4 m for its error before.
inline constexpr double kMaxRelocaliseRadius = 20.0;

/// Finds the pose of a robot that is lost among what it saw before.
///
/// Within 3 sigma + `moved` around the guess, at most kMaxRelocaliseRadius, all poses of a grid are compared
/// on a plan of the upright surfaces (correlative scan matching, Olson 2009; squares of a metre that cannot
/// hold a good one are left out by an upper bound, as in Cartographer, Hess et al. 2016). The ten best ones
/// that differ are laid onto the keyframes' planes by align(). The best of them counts only when the next
/// best place is clearly worse: a robot between places that look alike stays lost. It does so, too, when more
/// than `max_squares` squares could hold one of the ten. Height, roll and pitch are the guess's but for what
/// align() corrects. Pure and deterministic.
///
/// @param points  In base_link, m.
/// @param guess   T_odom_base.
/// @param sigma   Standard deviation of its horizontal position, m.
/// Errors: not_localised_here, with why.
Result<RecognisedPlace> relocalise(std::span<const Keyframe> keyframes,
                                   std::span<const Eigen::Vector3f> points, const Pose3& guess, double sigma,
                                   const RelocaliseParams& params = {});

}  // namespace adit::perception
