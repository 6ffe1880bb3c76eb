// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>

namespace adit::nav {

/// A plane z = height + gradient . (x, y) and its uncertainty.
struct PlaneFit {
  float height{0};                 ///< At the origin of the samples, m.
  Eigen::Vector2f gradient{0, 0};  ///< Rise per metre along x and y.
  float sigma_height{1e3f};        ///< Standard deviation of the height, m.
  float sigma_gradient{1e3f};      ///< Of the gradient in its less certain direction.
  float inliers{0};                ///< Fraction of the samples close to the plane, [0, 1].
};

/// Prior of a plane fit.
struct PlanePrior {
  float height{0};
  Eigen::Vector2f gradient{0, 0};
  float sigma_height{0.02f};
  float sigma_gradient{0.05f};
};

/// Fits a plane to samples (x, y, z) by least squares with Geman-McClure weights, whose scale shrinks from
/// `first` to `last` (m) over the iterations (graduated non-convexity: H. Yang et al., *Graduated
/// Non-Convexity for Robust Spatial Perception*, 2020). The prior is one more measurement. The first
/// iteration weights the samples by their distance to the plane with gradient `start`, so a wall or a lower
/// floor with fewer samples does not tilt the result. Deterministic; allocates nothing. `noise`: standard
/// deviation of one sample, m.
PlaneFit fit_plane(std::span<const Eigen::Vector3f> samples, const PlanePrior& prior,
                   const Eigen::Vector2f& start, float noise, float first, float last);

/// Searches a lattice of gradients within `reach` of the prior's for the plane through the prior's height
/// with the most samples close to it. The result starts fit_plane() when only the body's attitude is known.
/// Samples below a plane count against it: the robot stands on the upper of two floors, and a plane that cuts
/// through the ground has half of it below.
Eigen::Vector2f search_gradient(std::span<const Eigen::Vector3f> samples, const PlanePrior& prior,
                                float tolerance, float reach);

}  // namespace adit::nav
