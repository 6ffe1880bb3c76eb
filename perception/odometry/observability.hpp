// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>

#include "perception/odometry/odometry_state.hpp"

namespace adit::perception {

/// Bounds between the degrees of observability; translation in m, rotation in rad.
struct ObservabilityParams {
  double strong_t{0.03}, weak_t{0.10};
  double strong_r{0.003}, weak_r{0.010};
};

/// One residual of a cloud on a plane, as far as observability depends on it.
struct ResidualDirection {
  Eigen::Vector3f normal;  ///< Of the plane, odom.
  Eigen::Vector3f arm;     ///< From the body to the point, odom, m.
  float weight;            ///< 1 / variance, 1/m2.
};

/// Judges which directions a cloud determines. The eigenvectors of the Schur complements of translation and
/// rotation are the candidates (DCReg, Hu et al. 2025, so that units of rotation do not hide a direction of
/// translation). Along each of them only those residuals count whose plane faces it (X-ICP, Tuna et al.
/// 2022): a thousand points on a smooth wall determine nothing along it, however their normals scatter.
///
/// @param information  Of the pose: translation, rotation about the body, odom axes.
/// @param inflation    Variance of the mean of residuals that are not independent, per that of independent
///                     ones, [1, inf).
Localizability judge(const Eigen::Matrix<double, 6, 6>& information,
                     std::span<const ResidualDirection> residuals, double inflation,
                     const ObservabilityParams& params);

}  // namespace adit::perception
