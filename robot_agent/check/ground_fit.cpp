// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/check/ground_fit.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <utility>

#include "core/time/random.hpp"

namespace adit::agent {
namespace {

constexpr float kNearest = 0.8f, kFarthest = 5.0f;  ///< Horizontal distance, m.
constexpr float kHighest = 3.0f;                    ///< Above and below base_link, m.
constexpr double kSteepestGround =
    0.27;  ///< Rise per metre: a plane that leans by more than 15 degrees is a wall.
constexpr double kNearPlane = 0.05;  ///< Of the plane, m.
constexpr std::size_t kFewestReturns = 100;
constexpr int kTriples = 300;  ///< Half of the returns are ground: all triples miss it once in 10^17.

double above(const GroundFit::Plane& plane, const Eigen::Vector3f& p) {
  return double{p.z()} - plane.height - plane.rise.dot(p.head<2>().cast<double>());
}

/// The plane through points, least squares; nothing when they lie on a line.
template <class Points>
std::optional<GroundFit::Plane> through(const Points& points) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d row(double{p.x()}, double{p.y()}, 1);
    A += row * row.transpose();
    b += double{p.z()} * row;
  }
  const Eigen::Vector3d x = A.ldlt().solve(b);
  if (!x.allFinite() || x.head<2>().norm() > kSteepestGround) return std::nullopt;
  return GroundFit::Plane{x.z(), x.head<2>()};
}

}  // namespace

void GroundFit::add(const Eigen::Vector3f& point) {
  const float range = point.head<2>().norm();
  // False for what is not a number.
  if (!(range >= kNearest && range <= kFarthest && std::fabs(point.z()) < kHighest)) return;
  if (points_.size() < kCapacity) points_.push_back(point);
}

// RANSAC (Fischler, Bolles 1981): of planes through three returns, the one with the most returns near it.
std::optional<GroundFit::Plane> GroundFit::plane() const {
  if (points_.size() < kFewestReturns) return std::nullopt;
  Random random(1);
  std::vector<Eigen::Vector3f> best;
  for (int n = 0; n < kTriples; ++n) {
    std::array<Eigen::Vector3f, 3> triple;
    for (Eigen::Vector3f& p : triple) p = points_[random.next() % points_.size()];
    const auto plane = through(triple);
    if (!plane) continue;
    std::vector<Eigen::Vector3f> near;
    for (const Eigen::Vector3f& p : points_)
      if (std::fabs(above(*plane, p)) <= kNearPlane) near.push_back(p);
    if (near.size() > best.size()) best = std::move(near);
  }
  if (best.size() < kFewestReturns) return std::nullopt;
  return through(best);
}

}  // namespace adit::agent
