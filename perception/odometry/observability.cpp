// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/observability.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace adit::perception {
namespace {

constexpr float kFacing = 0.5f;    ///< Cosine between a plane's normal and a direction that it determines.
constexpr float kTurning = 0.35f;  ///< The same for an axis: between the normal and the way of the point.
constexpr int kLeastFacing = 15;   ///< Fewer residuals may all be on planes with wrong normals.
constexpr double kUnknown = 1e3;   ///< Standard deviation where nothing is known, m or rad.

Observability degree(double sigma, double strong, double weak) {
  return sigma < strong ? Observability::strong : sigma < weak ? Observability::weak : Observability::none;
}

Eigen::Matrix3d schur(const Eigen::Matrix3d& a, const Eigen::Matrix3d& cross, const Eigen::Matrix3d& b) {
  // Regularised: where nothing is known of the other part, nothing is known of this one.
  const Eigen::Matrix3d known = b + 1e-6 * (1.0 + b.trace()) * Eigen::Matrix3d::Identity();
  return a - cross * known.inverse() * cross.transpose();
}

}  // namespace

Localizability judge(const Eigen::Matrix<double, 6, 6>& information,
                     std::span<const ResidualDirection> residuals, double inflation,
                     const ObservabilityParams& params) {
  Localizability found;
  const Eigen::Matrix3d tt = information.block<3, 3>(0, 0), tr = information.block<3, 3>(0, 3),
                        rr = information.block<3, 3>(3, 3);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> t(schur(tt, tr, rr)), r(schur(rr, tr.transpose(), tt));
  found.axes_t = t.eigenvectors();
  found.axes_r = r.eigenvectors();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3f v = found.axes_t.col(axis).cast<float>(), u = found.axes_r.col(axis).cast<float>();
    float along = 0, about = 0;
    int facing_count = 0, turning_count = 0;
    for (const ResidualDirection& each : residuals) {
      const float facing = each.normal.dot(v);
      if (std::abs(facing) > kFacing) {
        along += each.weight * facing * facing;
        ++facing_count;
      }
      // How far the point moves towards the plane, per its way about the axis: the part of the arm along the
      // axis moves nothing.
      const Eigen::Vector3f moves = u.cross(each.arm);
      const float turning = each.normal.dot(moves);
      if (turning * turning > kTurning * kTurning * moves.squaredNorm()) {
        about += each.weight * turning * turning;
        ++turning_count;
      }
    }
    // What the facing residuals say, and not more than all of them together say.
    const auto sigma = [&](double facing, int count, double all) {
      const double known = std::min(facing, std::max(0.0, all));
      return known > 0 && count >= kLeastFacing ? std::min(kUnknown, std::sqrt(inflation / known)) : kUnknown;
    };
    found.sigma_t[axis] = sigma(along, facing_count, t.eigenvalues()[axis]);
    found.sigma_r[axis] = sigma(about, turning_count, r.eigenvalues()[axis]);
    const auto n = static_cast<std::size_t>(axis);
    found.t[n] = degree(found.sigma_t[axis], params.strong_t, params.weak_t);
    found.r[n] = degree(found.sigma_r[axis], params.strong_r, params.weak_r);
  }
  return found;
}

}  // namespace adit::perception
