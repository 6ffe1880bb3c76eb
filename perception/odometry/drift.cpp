// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/drift.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "perception/odometry/so3.hpp"

namespace adit::perception {
namespace {

constexpr double kFullTurn = 1.5;  ///< A turn by so much also replaces what is in view, rad.

}  // namespace

void DriftAccount::add(const Eigen::Vector3d& moved, double turned, double reach, const Localizability& found,
                       const Matrix6& before, const Matrix6& after) {
  // An error of the heading becomes one of the position on the way.
  Matrix6 carry = Matrix6::Identity();
  carry.block<3, 3>(0, 3) = -skew(moved);
  sum_ = (carry * sum_ * carry.transpose()).eval();

  const double replaced = moved.norm() / std::max(1.0, reach) + turned / kFullTurn;
  Matrix6 open = Matrix6::Zero();  // Projects onto the directions that the lidar leaves open.
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    const auto grow = [&](int block, const Eigen::Vector3d& v, Observability degree, double sigma,
                          double bias) {
      if (degree == Observability::strong)
        sum_.block<3, 3>(block, block) += (sigma * sigma + bias * bias) * replaced * v * v.transpose();
      else
        open.block<3, 3>(block, block) += v * v.transpose();
    };
    grow(0, found.axes_t.col(axis), found.t[n], found.sigma_t[axis], kBiasT);
    grow(3, found.axes_r.col(axis), found.r[n], found.sigma_r[axis], kBiasR);
  }
  if (open.isZero()) return;
  // What the filter's own variance grew by there; where it fell, the drift until then remains. Along the
  // other directions it only breathes with the number of matches, which is no drift.
  const Eigen::SelfAdjointEigenSolver<Matrix6> grown(open * (after - before) * open);
  sum_ += grown.eigenvectors() * grown.eigenvalues().cwiseMax(0.0).asDiagonal() *
          grown.eigenvectors().transpose();
}

}  // namespace adit::perception
