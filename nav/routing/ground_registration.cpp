// SPDX-License-Identifier: Apache-2.0
#include "nav/routing/ground_registration.hpp"

#include <algorithm>
#include <cmath>

#include "nav/terrain/plane_fit.hpp"

namespace adit::nav {
namespace {

constexpr float kFrom = 1.0f, kTo = 8.0f;   // Inner and outer radius of the ground that is compared, m.
constexpr float kSame = 0.25f;              // Heights that differ by more belong to different ground, m.
constexpr std::size_t kMaxSamples = 1024;   // Per scan.
constexpr std::size_t kEnoughSamples = 64;  // Minimum number of samples for a plane.
constexpr float kReturnNoise = 0.02f;       // m
constexpr float kFirstScale = 0.2f, kLastScale = 0.03f;  // Scales of the fit's weights, m.
constexpr float kInliers = 0.6f;                         // Minimum inlier fraction of the plane.
constexpr float kMaxGradient = 0.0524f;                  // 3 degrees.
// Shares of what the map says of attitude and height that are taken; the rest is the reported pose's. A map
// that each scan extends by its own tilt agrees with any slope, so it must not be followed all the way:
// attitude filters are about twice as wrong as the mean of the scans that made the map. Heights of the
// odometry drift slowly, so that most of a difference to the map is the odometry's.
constexpr float kGradientShare = 0.8f, kHeightShare = 0.9f;

Pose3 corrected(const Pose3& body, const Eigen::Vector2f& gradient, float height) {
  const double size = gradient.norm();
  const Eigen::Vector3d position = body.position - Eigen::Vector3d(0.0, 0.0, height);
  if (size < 1e-6) return {position, body.orientation};
  const Eigen::Vector3d axis(-gradient.y() / size, gradient.x() / size, 0.0);
  return {position, Eigen::Quaterniond(Eigen::AngleAxisd(std::atan(size), axis)) * body.orientation};
}

}  // namespace

Pose3 GroundRegistration::correct(const Pose3& body) const { return corrected(body, gradient_, height_); }

Pose3 GroundRegistration::apply(std::span<const Eigen::Vector3f> points, const Pose3& body,
                                const SurfaceMap& map) {
  const Pose3 before = corrected(body, gradient_, height_);
  const Eigen::Matrix3f turn = before.orientation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f at = before.position.cast<float>();
  samples_.clear();
  // An odd stride samples all rings when the points of a column follow each other.
  const std::size_t stride = (points.size() / kMaxSamples + 1) | 1;
  for (std::size_t n = 0; n < points.size(); n += stride) {
    const Eigen::Vector3f offset = turn * points[n];
    const float range = offset.head<2>().norm();
    if (!(range >= kFrom && range <= kTo)) continue;
    const Eigen::Vector3f place = at + offset;
    const GroundCell* cell = map.cell(route_cell(place.x()), route_cell(place.y()), place.z());
    if (!cell || !cell->known || !cell->measured || cell->blocked) continue;
    const float apart = place.z() - cell->z;
    if (std::abs(apart) <= kSame) samples_.emplace_back(offset.x(), offset.y(), apart);
  }
  // Without a fit the correction fades: it may itself be why there is none.
  const auto fade = [&] {
    gradient_ *= kGradientShare;
    height_ *= kHeightShare;
    return before;
  };
  if (samples_.size() < kEnoughSamples) return fade();
  const PlanePrior prior{0.0f, {0, 0}, kSame / 2, kMaxGradient / 3};
  const PlaneFit fit = fit_plane(samples_, prior, prior.gradient, kReturnNoise, kFirstScale, kLastScale);
  if (fit.inliers < kInliers) return fade();
  gradient_ = kGradientShare * (gradient_ + fit.gradient);
  height_ = std::clamp(kHeightShare * (height_ + fit.height), -kSame, kSame);
  if (const float size = gradient_.norm(); size > kMaxGradient) gradient_ *= kMaxGradient / size;
  return corrected(body, gradient_, height_);
}

}  // namespace adit::nav
