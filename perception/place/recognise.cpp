// SPDX-License-Identifier: Apache-2.0
#include "perception/place/recognise.hpp"

#include <cmath>
#include <cstdio>

namespace adit::perception {
namespace {

constexpr double kNear = 25.0;             ///< Keyframes within this distance show the same surfaces, m.
constexpr std::size_t kLeastPoints = 200;  ///< Fewer determine no pose.

Eigen::Affine3f affine(const Pose3& pose) {
  return (Eigen::Translation3d(pose.position) * pose.orientation).cast<float>();
}

}  // namespace

Result<RecognisedPlace> recognise(std::span<const Keyframe> keyframes,
                                  std::span<const Eigen::Vector3f> points, const Pose3& guess,
                                  const RecogniseParams& params) {
  // Relative to the guess, which may be far from the frame's origin.
  const Pose3 T_guess_odom = guess.inverse();
  PointCloud surfaces;
  for (const Keyframe& keyframe : keyframes) {
    const Pose3 T_guess_keyframe = T_guess_odom * keyframe.T_odom_base;
    if (T_guess_keyframe.position.norm() > kNear) continue;
    const Eigen::Affine3f T = affine(T_guess_keyframe);
    for (const Eigen::Vector3f& p : keyframe.points) surfaces.push_back(T * p);
  }
  if (surfaces.size() < kLeastPoints || points.size() < kLeastPoints) return RecognisedPlace{};

  const VoxelPlanes target = align_target(surfaces, params.noise);
  const Alignment found = align(
      target, points, Pose3{},
      {.range_noise = params.noise, .search_distance = params.max_shift, .search_angle = params.max_turn});
  const double turn = Eigen::AngleAxisd(found.pose.orientation).angle();
  const double shift = found.pose.position.norm();
  char text[160];
  const bool confirms = shift < 0.1 && turn < 0.035;
  const double least = confirms ? params.confirming_overlap : params.least_overlap;
  if (found.overlap < least) {
    std::snprintf(text, sizeof text, "%.0f %% of what the lidar sees was there before, %.0f %% are expected",
                  100 * found.overlap, 100 * least);
    return Error{Reason::not_localised_here, text};
  }
  if (shift > params.max_shift || turn > params.max_turn) {
    std::snprintf(text, sizeof text, "the surroundings fit %.1f m and %.0f degrees beside the expected place",
                  shift, turn * 180.0 / M_PI);
    return Error{Reason::not_localised_here, text};
  }
  RecognisedPlace place;
  place.overlap = found.overlap;
  place.compared = true;
  const Pose3 corrected = guess * found.pose;
  const Eigen::Quaterniond about_z(
      Eigen::AngleAxisd(wrap_angle(corrected.yaw() - guess.yaw()), Eigen::Vector3d::UnitZ()));
  place.correction = Pose3{corrected.position - about_z * guess.position, about_z};
  return place;
}

}  // namespace adit::perception
