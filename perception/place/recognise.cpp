// SPDX-License-Identifier: Apache-2.0
#include "perception/place/recognise.hpp"

#include <cmath>
#include <cstdio>

#include "perception/place/surfaces.hpp"

namespace adit::perception {
namespace {

/// The pose without its parts in directions of which the cloud says nothing, as along a smooth corridor:
/// there the guess is better than any of the poses that were tried.
Pose3 determined(const Alignment& found) {
  Pose3 pose = found.pose;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    const Eigen::Vector3d v = found.localizability.axes_t.col(axis);
    if (found.localizability.t[n] == Observability::none) pose.position -= v.dot(pose.position) * v;
  }
  return pose;
}

}  // namespace

Result<RecognisedPlace> recognise(std::span<const Keyframe> keyframes,
                                  std::span<const Eigen::Vector3f> points, const Pose3& guess,
                                  const RecogniseParams& params) {
  const PointCloud surfaces = surfaces_near(keyframes, guess, kNearKeyframe, keyframes.size());
  const std::size_t least = params.planar ? kMinPlanarPoints : kMinPlacePoints;
  if (surfaces.size() < least) return RecognisedPlace{};
  RecognisedPlace place;
  place.match = PlaceMatch::cannot_tell;
  if (points.size() < least) return place;

  const VoxelPlanes target = align_target(surfaces, params.noise);
  const Alignment found = align(target, surfaces_of(points, params.planar), Pose3{},
                                {.range_noise = params.noise,
                                 .search_distance = params.max_shift,
                                 .search_angle = params.max_turn,
                                 .keeps_undetermined = true});
  const Pose3 pose = determined(found);
  const double turn = Eigen::AngleAxisd(pose.orientation).angle();
  const double shift = pose.position.norm();
  char text[160];
  const bool confirms = shift < 0.1 && turn < 0.035;
  const double expected = confirms ? params.confirming_overlap : params.least_overlap;
  if (found.overlap < expected) {
    std::snprintf(text, sizeof text, "%.0f %% of what the lidar sees was there before, %.0f %% are expected",
                  100 * found.overlap, 100 * expected);
    return Error{Reason::not_localised_here, text};
  }
  if (shift > params.max_shift || turn > params.max_turn) {
    std::snprintf(text, sizeof text, "the surroundings fit %.1f m and %.0f degrees beside the expected place",
                  shift, turn * 180.0 / M_PI);
    return Error{Reason::not_localised_here, text};
  }
  place.overlap = found.overlap;
  place.match = PlaceMatch::found;
  place.correction = level_correction(guess, pose);
  return place;
}

}  // namespace adit::perception
