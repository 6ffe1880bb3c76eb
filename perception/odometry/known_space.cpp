// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/known_space.hpp"

#include <algorithm>
#include <cmath>

namespace adit::perception {
namespace {

constexpr std::size_t kRays = 300;       ///< Of a cloud, that are followed.
constexpr std::size_t kCompared = 256;   ///< Points of a cloud that are compared: a share is known to 3 %.
constexpr std::size_t kDoubtful = 64;    ///< Of those that lie on no plane, that are followed.
constexpr double kFarthest = 20.0;       ///< m
constexpr double kRemembered = 60.0;     ///< As VoxelPlanes::Params::keep_distance, m.
constexpr std::size_t kForgetPart = 64;  ///< Calls of forget() that visit the whole table.
constexpr double kRayStep = 0.25;        ///< m
constexpr double kBeside = 0.05;         ///< And three standard deviations, m.
constexpr float kFloor = 0.9f;           ///< Vertical part of the normal of a floor.
constexpr double kMeets = 0.5;           ///< Cosine between a ray and the normal of a plane that it meets.

std::uint64_t key_of(const Eigen::Vector3d& place) {
  const Eigen::Vector3d index = (place / KnownSpace::kEdge).array().floor();
  if (!(index.cwiseAbs().maxCoeff() < 1e6)) return FlatHash<float>::kEmpty;
  return voxel_key(static_cast<std::int32_t>(index.x()), static_cast<std::int32_t>(index.y()),
                   static_cast<std::int32_t>(index.z()));
}

/// Whether the ray from `lidar` to `place` passes through a known plane, or ends where all was empty.
bool contradicts(const VoxelPlanes& map, const KnownSpace& space, const Eigen::Vector3d& lidar,
                 const Eigen::Vector3d& place) {
  const Eigen::Vector3d ray = place - lidar;
  const double range = ray.norm();
  const Eigen::Vector3d along = ray / std::max(1e-6, range);
  if (space.is_empty(place) && space.is_empty(place + KnownSpace::kEdge * along)) return true;
  const double end = std::min(range - KnownSpace::kEdge, kFarthest);
  for (double at = kRayStep; at < end; at += kRayStep) {
    const Eigen::Vector3d here = lidar + at * along;
    const auto plane = map.find(here);
    if (!plane || plane->line) continue;
    const Eigen::Vector3d normal = plane->normal.cast<double>();
    const double facing = std::abs(normal.dot(along));
    if (facing > kMeets && std::abs(normal.dot(here - plane->centre)) <= 0.5 * kRayStep * facing) return true;
  }
  return false;
}

}  // namespace

void KnownSpace::add(const Eigen::Vector3d& lidar, std::span<const Eigen::Vector3d> points,
                     double travelled) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / kRays);
  for (std::size_t n = 0; n < points.size(); n += step) {
    const Eigen::Vector3d ray = points[n] - lidar;
    const double range = ray.norm(), end = std::min(range - kEdge, kFarthest);
    for (double at = 0; at < end; at += kEdge) {
      const std::uint64_t key = key_of(lidar + at / range * ray);
      if (key == FlatHash<float>::kEmpty) continue;
      if (float* const known = voxels_.size() < kMaxVoxels ? &voxels_.at(key) : voxels_.find(key))
        *known = static_cast<float>(travelled);
    }
  }
}

void KnownSpace::forget(double travelled) {
  const auto limit = static_cast<float>(travelled - kRemembered);
  sweep_ =
      voxels_.sweep(sweep_, voxels_.slots().size() / kForgetPart, [&](float seen) { return seen < limit; });
}

bool KnownSpace::is_empty(const Eigen::Vector3d& place) const {
  const std::uint64_t key = key_of(place);
  return key != FlatHash<float>::kEmpty && voxels_.find(key) != nullptr;
}

Agreement agreement(const VoxelPlanes& map, const KnownSpace& space, std::span<const Eigen::Vector3f> points,
                    const Pose3& pose, double range_noise, double enough) {
  Agreement out;
  std::vector<Eigen::Vector3d> others;
  const Eigen::Matrix3d R = pose.orientation.toRotationMatrix();
  const std::size_t step = std::max<std::size_t>(1, points.size() / kCompared);
  for (std::size_t n = 0; n < points.size(); n += step) {
    const Eigen::Vector3d place = R * points[n].cast<double>() + pose.position;
    const auto plane = map.find(place);
    if (plane && plane->line) continue;
    const bool on = plane && std::abs(plane->normal.cast<double>().dot(place - plane->centre)) <
                                 3 * std::sqrt(plane->variance + range_noise * range_noise) + kBeside;
    if (!on)
      others.push_back(place);
    else if (std::abs(plane->normal.z()) < kFloor)
      out.agree += 1.0;
  }
  if (out.agree >= enough * (out.agree + static_cast<double>(others.size()))) return out;
  const std::size_t stride = std::max<std::size_t>(1, (others.size() + kDoubtful - 1) / kDoubtful);
  for (std::size_t n = 0; n < others.size(); n += stride)
    if (contradicts(map, space, pose.position, others[n])) out.contradict += static_cast<double>(stride);
  return out;
}

}  // namespace adit::perception
