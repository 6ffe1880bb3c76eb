// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/registration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "perception/odometry/so3.hpp"
#include "perception/voxel/flat_hash.hpp"

namespace adit::perception {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kMoved = 0.02, kTurned = 0.0035;  ///< Motion after which points are matched again, m, rad.
constexpr double kSettledT = 1e-3, kSettledR = 1.7e-4;  ///< The search ends, m, rad.

/// Removes the directions that the cloud does not determine well: an error of a few planes there is no noise,
/// and the prior by wheels and inertia is better. A turn that is known a little remains: without it roll and
/// pitch follow the noise of the driver's attitude where floor and ceiling are far away.
Matrix6 remap(const Localizability& found, const Eigen::Matrix3d& R) {
  Matrix6 keep = Matrix6::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    const Eigen::Vector3d v = found.axes_t.col(axis), u = R.transpose() * found.axes_r.col(axis);
    if (found.t[n] != Observability::strong) keep.block<3, 3>(0, 0) -= v * v.transpose();
    if (found.r[n] == Observability::none) keep.block<3, 3>(3, 3) -= u * u.transpose();
  }
  return keep;
}

}  // namespace

void Registration::match(const VoxelPlanes& target, std::span<const Eigen::Vector3f> points,
                         const Pose3& pose, double window, int top) {
  matches_.clear();
  near_ = 0;
  const Eigen::Matrix3d R = pose.orientation.toRotationMatrix();
  for (const Eigen::Vector3f& each : points) {
    const Eigen::Vector3d p = each.cast<double>();
    const Eigen::Vector3d place = R * p + pose.position;
    const auto plane = target.find(place, top);
    if (!plane) continue;
    ++near_;
    const Eigen::Vector3d d = place - plane->centre;
    const double noise = params_.range_noise * params_.range_noise +
                         params_.bearing_noise * params_.bearing_noise * p.squaredNorm();
    const Eigen::Vector3d smear = R * (smear_.way + smear_.turn.cross(p));
    const auto add = [&](const Eigen::Vector3f& across, double variance) {
      const Eigen::Vector3d normal = across.cast<double>();
      const double beside = normal.dot(smear);
      variance += beside * beside;
      const double gate = params_.gate * std::sqrt(variance) + window;
      if (std::abs(normal.dot(d)) <= gate) matches_.push_back({p, plane->centre, normal, variance});
    };
    // The normal of few points is uncertain, the more so where their extent is small.
    const double lean = plane->line ? 0.0 : plane->variance / (plane->count * plane->extent_along);
    add(plane->normal, noise + plane->variance + lean * d.squaredNorm());
    if (plane->line) add(plane->along, noise + plane->extent_along);
  }
}

double Registration::inflation(const Pose3& pose) {
  // The residuals on one patch share the errors of its plane: each patch of 1 m counts as one measurement.
  patches_.clear();
  for (const Match& m : matches_) {
    const Eigen::Vector3i at = (pose * m.point).array().floor().cast<int>();
    patches_.push_back(voxel_key(at.x(), at.y(), at.z()));
  }
  std::sort(patches_.begin(), patches_.end());
  const auto distinct = std::unique(patches_.begin(), patches_.end()) - patches_.begin();
  return distinct > 0 ? std::max(1.0, static_cast<double>(matches_.size()) / static_cast<double>(distinct))
                      : 1.0;
}

Registered Registration::align(const VoxelPlanes& target, std::span<const Eigen::Vector3f> points,
                               const Pose3& prior, const Matrix6& prior_information, double window, int top) {
  Registered out;
  out.pose = prior;
  Pose3 matched_at = prior;
  double inflated = 1.0;
  Matrix6 keep = Matrix6::Identity();
  match(target, points, prior, window, top);
  for (out.iterations = 1; out.iterations <= params_.max_iterations; ++out.iterations) {
    const Eigen::Matrix3d R = out.pose.orientation.toRotationMatrix();
    Matrix6 A = Matrix6::Zero();
    Vector6 b = Vector6::Zero();
    const bool first = out.iterations == 1;
    if (first) directions_.clear();
    for (const Match& m : matches_) {
      const Eigen::Vector3d arm = R * m.point;
      const double r = m.normal.dot(arm + out.pose.position - m.centre);
      const double size = std::abs(r) / std::sqrt(m.variance);
      const double weight = (size > params_.huber ? params_.huber / size : 1.0) / m.variance;
      Vector6 J;
      J.head<3>() = m.normal;
      J.tail<3>() = m.point.cross(R.transpose() * m.normal);
      const Vector6 wJ = weight * J;
      for (int row = 0; row < 6; ++row)
        for (int column = row; column < 6; ++column) A(row, column) += wJ[row] * J[column];
      b -= r * wJ;
      if (first)
        directions_.push_back({m.normal.cast<float>(), arm.cast<float>(), static_cast<float>(weight)});
    }
    A = A.selfadjointView<Eigen::Upper>();
    if (first) {
      inflated = inflation(out.pose);
      Matrix6 turn = Matrix6::Identity();
      turn.block<3, 3>(3, 3) = R;
      out.localizability = judge(turn * A * turn.transpose(), directions_, inflated, params_.observability);
      if (params_.has_prior) keep = remap(out.localizability, R);
    }
    out.information = keep * A * keep / inflated;
    // The prior pulls towards its own pose.
    const Vector6 lidar = keep * b / inflated;
    Vector6 off;
    off.head<3>() = prior.position - out.pose.position;
    off.tail<3>() = log_so3(out.pose.orientation.conjugate() * prior.orientation);
    const Matrix6 all = out.information + prior_information + 1e-9 * Matrix6::Identity();
    const Vector6 step = all.ldlt().solve(lidar + prior_information * off);
    if (!step.allFinite()) break;
    out.pose.position += step.head<3>();
    out.pose.orientation = (out.pose.orientation * exp_so3(step.tail<3>())).normalized();
    if (step.head<3>().norm() < kSettledT && step.tail<3>().norm() < kSettledR) {
      out.converged = true;
      break;
    }
    const Pose3 moved = matched_at.inverse() * out.pose;
    if (moved.position.norm() > kMoved || log_so3(moved.orientation).norm() > kTurned) {
      match(target, points, out.pose, window, top);
      matched_at = out.pose;
    }
  }
  out.matched = matches_.size();
  out.near = near_;
  return out;
}

}  // namespace adit::perception
