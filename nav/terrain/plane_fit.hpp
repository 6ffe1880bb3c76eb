// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>

namespace adit::nav {

/// A plane over the robot's surroundings, z = height + gradient . (x, y), and how well it is known.
struct PlaneFit {
  float height{0};                 ///< at the origin of the samples, m
  Eigen::Vector2f gradient{0, 0};  ///< rise per metre along x and y
  float sigma_height{1e3f};        ///< standard deviation of the height, m
  float sigma_gradient{1e3f};      ///< of the gradient in its worse direction
  float inliers{0};                ///< share of the samples that lie close to it, [0, 1]
};

/// What is believed of a plane before its samples are seen.
struct PlanePrior {
  float height{0};
  Eigen::Vector2f gradient{0, 0};
  float sigma_height{0.02f};
  float sigma_gradient{0.05f};
};

/// Fits a plane to samples (x, y, z) by least squares with Geman-McClure weights, whose scale shrinks from
/// `first` to `last` (m) over the iterations (graduated non-convexity: H. Yang et al., *Graduated
/// Non-Convexity for Robust Spatial Perception*, 2020), and with the prior as one more measurement. Samples
/// near the plane with the gradient `start` decide at first, so that a wall or a lower floor that holds fewer
/// of them does not tilt the result. Deterministic; allocates nothing. `noise`: of one sample, m.
PlaneFit fit_plane(std::span<const Eigen::Vector3f> samples, const PlanePrior& prior,
                   const Eigen::Vector2f& start, float noise, float first, float last);

/// The gradient around the prior's whose plane through its height has the most samples close to it, from a
/// lattice of gradients within `reach`: the start of fit_plane() where nothing is known of the ground but
/// how the body leans. Samples below a plane count against it: of two floors the lower one is not the one
/// that a robot stands on, but a plane that cuts through the ground has half of it below.
Eigen::Vector2f search_gradient(std::span<const Eigen::Vector3f> samples, const PlanePrior& prior,
                                float tolerance, float reach);

}  // namespace adit::nav
