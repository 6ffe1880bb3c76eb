// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/drift.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "perception/odometry/so3.hpp"

namespace adit::perception {
namespace {

// Errors of a registration that its residuals do not show: bias of the lidar, of its mounting and of its
// times, as the simulator's and the drivers' documentation state them (1 cm; 0.05 degrees).
constexpr double kBiasT = 0.01, kBiasR = 0.0009;
constexpr double kFullTurn = 1.5;  ///< A turn by so much also replaces what is in view, rad.

}  // namespace

void DriftAccount::add(const Eigen::Vector3d& moved, double turned, double reach, const Localizability& found,
                       const Matrix6& before, const Matrix6& after) {
  // An error of the heading becomes one of the position on the way.
  Matrix6 carry = Matrix6::Identity();
  carry.block<3, 3>(0, 3) = -skew(moved);
  sum_ = (carry * sum_ * carry.transpose()).eval();

  const double replaced = moved.norm() / std::max(1.0, reach) + turned / kFullTurn;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    const auto grow = [&](int block, const Eigen::Vector3d& v, Observability degree, double sigma,
                          double bias) {
      if (degree == Observability::none) return;
      const double variance = (sigma * sigma + bias * bias) * replaced;
      sum_.block<3, 3>(block, block) += variance * v * v.transpose();
    };
    grow(0, found.axes_t.col(axis), found.t[n], found.sigma_t[axis], kBiasT);
    grow(3, found.axes_r.col(axis), found.r[n], found.sigma_r[axis], kBiasR);
  }
  // What the filter's own variance grew by; where it fell, the drift until then remains.
  const Eigen::SelfAdjointEigenSolver<Matrix6> grown(after - before);
  sum_ += grown.eigenvectors() * grown.eigenvalues().cwiseMax(0.0).asDiagonal() *
          grown.eigenvectors().transpose();
}

}  // namespace adit::perception
