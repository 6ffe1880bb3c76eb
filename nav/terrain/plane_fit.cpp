// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/plane_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace adit::nav {

PlaneFit fit_plane(std::span<const Eigen::Vector3f> samples, const PlanePrior& prior,
                   const Eigen::Vector2f& start, float noise, float first, float last) {
  constexpr int kIterations = 5;
  // Neighbouring cells share errors: this many of them count as one measurement.
  constexpr float kDecorrelated = 4.0f;
  const float w_height = 1.0f / (prior.sigma_height * prior.sigma_height);
  const float w_gradient = 1.0f / (prior.sigma_gradient * prior.sigma_gradient);
  const float w_sample = 1.0f / (noise * noise * kDecorrelated);
  float a = prior.height, gx = start.x(), gy = start.y();
  const float shrink = std::pow(last / first, 1.0f / static_cast<float>(kIterations - 1));
  float scale = first;
  PlaneFit fit;
  Eigen::Matrix3f information;
  for (int i = 0; i < kIterations; ++i, scale *= shrink) {
    const float c2 = scale * scale;
    float n = 0, sx = 0, sy = 0, sz = 0, sxx = 0, sxy = 0, syy = 0, sxz = 0, syz = 0;
    for (const Eigen::Vector3f& s : samples) {
      const float e = s.z() - (a + gx * s.x() + gy * s.y());
      const float share = c2 / (c2 + e * e), w = share * share;
      const float wx = w * s.x(), wy = w * s.y();
      n += w;
      sx += wx;
      sy += wy;
      sz += w * s.z();
      sxx += wx * s.x();
      sxy += wx * s.y();
      syy += wy * s.y();
      sxz += wx * s.z();
      syz += wy * s.z();
    }
    information << n, sx, sy, sx, sxx, sxy, sy, sxy, syy;
    information *= w_sample;
    information.diagonal() += Eigen::Vector3f(w_height, w_gradient, w_gradient);
    const Eigen::Vector3f right = w_sample * Eigen::Vector3f(sz, sxz, syz) +
                                  Eigen::Vector3f(w_height * prior.height, w_gradient * prior.gradient.x(),
                                                  w_gradient * prior.gradient.y());
    const Eigen::Vector3f best = information.llt().solve(right);
    a = best.x(), gx = best.y(), gy = best.z();
  }
  int near = 0;
  for (const Eigen::Vector3f& s : samples)
    near += std::fabs(s.z() - (a + gx * s.x() + gy * s.y())) < 2 * last;
  fit.inliers = samples.empty() ? 0.0f : static_cast<float>(near) / static_cast<float>(samples.size());
  const Eigen::Matrix3f covariance = information.inverse();
  fit.height = a;
  fit.gradient = {gx, gy};
  fit.sigma_height = std::sqrt(std::max(0.0f, covariance(0, 0)));
  const float mean = 0.5f * (covariance(1, 1) + covariance(2, 2));
  const float apart = 0.5f * (covariance(1, 1) - covariance(2, 2));
  fit.sigma_gradient =
      std::sqrt(std::max(0.0f, mean + std::sqrt(apart * apart + covariance(1, 2) * covariance(1, 2))));
  return fit;
}

Eigen::Vector2f search_gradient(std::span<const Eigen::Vector3f> samples, const PlanePrior& prior,
                                float tolerance, float reach) {
  constexpr int kLattice = 6;                     // Gradients of the lattice to each side of the prior's.
  const float between = 0.5f * reach / kLattice;  // From a true gradient to the nearest one of the lattice.
  Eigen::Vector2f best = prior.gradient;
  float most = -1e9f;
  for (int i = -kLattice; i <= kLattice; ++i)
    for (int j = -kLattice; j <= kLattice; ++j) {
      const Eigen::Vector2f off = reach / kLattice * Eigen::Vector2f(i, j);
      if (off.norm() > reach) continue;
      const Eigen::Vector2f g = prior.gradient + off;
      float score = 0;
      for (const Eigen::Vector3f& s : samples) {
        const float e = s.z() - (prior.height + g.x() * s.x() + g.y() * s.y());
        const float near = tolerance + between * std::max(std::fabs(s.x()), std::fabs(s.y()));
        score += std::fabs(e) < near ? 1.0f : e < 0 ? -0.5f : 0.0f;
      }
      // Among planes with equally many close samples, prefers the one nearest to the prior.
      const float unlikely = off.norm() / prior.sigma_gradient;
      score -= 0.02f * static_cast<float>(samples.size()) * unlikely * unlikely / 2;
      if (score > most) {
        most = score;
        best = g;
      }
    }
  return best;
}

}  // namespace adit::nav
