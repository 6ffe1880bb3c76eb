// SPDX-License-Identifier: Apache-2.0
#include "perception/place/surfaces.hpp"

#include <algorithm>
#include <utility>

#include "perception/voxel/planar.hpp"

namespace adit::perception {
namespace {

void add(PointCloud& surfaces, std::span<const Eigen::Vector3f> points, const Eigen::Affine3f& T,
         bool planar) {
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3f at = T * p;
    if (planar)
      add_piece_of_wall(surfaces, at);
    else
      surfaces.push_back(at);
  }
}

}  // namespace

PointCloud surfaces_of(std::span<const Eigen::Vector3f> points, bool planar) {
  PointCloud surfaces;
  add(surfaces, points, Eigen::Affine3f::Identity(), planar);
  return surfaces;
}

PointCloud surfaces_near(std::span<const Keyframe> keyframes, const Pose3& T_odom_guess, double radius,
                         std::size_t most, double apart) {
  const Pose3 T_guess_odom = T_odom_guess.inverse();
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t n = 0; n < keyframes.size(); ++n) {
    const double distance = (keyframes[n].T_odom_base.position - T_odom_guess.position).norm();
    if (distance <= radius) near.emplace_back(distance, n);
  }
  std::sort(near.begin(), near.end());
  PointCloud surfaces;
  std::vector<Eigen::Vector3d> taken;
  for (const auto& [distance, n] : near) {
    const Eigen::Vector3d& at = keyframes[n].T_odom_base.position;
    const bool beside = std::any_of(taken.begin(), taken.end(),
                                    [&](const auto& other) { return (other - at).norm() < apart; });
    if (beside) continue;
    if (taken.size() == most) break;
    taken.push_back(at);
    const Pose3 T_guess_keyframe = T_guess_odom * keyframes[n].T_odom_base;
    add(surfaces, keyframes[n].points,
        (Eigen::Translation3d(T_guess_keyframe.position) * T_guess_keyframe.orientation).cast<float>(),
        keyframes[n].planar);
  }
  return surfaces;
}

Pose3 level_correction(const Pose3& T_odom_guess, const Pose3& T_guess_found) {
  const Pose3 corrected = T_odom_guess * T_guess_found;
  return Pose3::level(corrected.planar() * T_odom_guess.planar().inverse(),
                      corrected.position.z() - T_odom_guess.position.z());
}

}  // namespace adit::perception
