// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "perception/odometry/observability.hpp"
#include "perception/odometry/odometry_state.hpp"
#include "perception/voxel/voxel_planes.hpp"

namespace adit::perception {

/// Parameters of Registration.
struct RegistrationParams {
  double range_noise{0.02};     ///< Standard deviation of a range, m, (0, 0.5].
  double bearing_noise{0.003};  ///< Standard deviation of a bearing, with mounting and timing, rad, [0, 0.1].
  double gate{3.0};             ///< A point farther from its plane matches nothing, standard deviations.
  double huber{2.0};            ///< From here on a residual weighs less, standard deviations.
  bool has_prior{true};         ///< Other sensors rule what the cloud does not determine well.
  int max_iterations{4};        ///< [1, 50]
  ObservabilityParams observability{};
};

/// Result of a registration: the pose of a cloud on the map.
struct Registered {
  Pose3 pose{};
  /// Of the pose, in translation (target axes) and rotation (body axes, right-perturbed). Directions that the
  /// cloud does not determine have none.
  Eigen::Matrix<double, 6, 6> information{Eigen::Matrix<double, 6, 6>::Zero()};
  Localizability localizability{};
  std::size_t matched{};  ///< Points on a plane.
  std::size_t near{};     ///< Points where there is a plane.
  int iterations{};
  bool converged{};
};

/// How far points lie beside their places because their times are not known: the body's motion over one
/// standard deviation of the times, in body axes.
struct Smear {
  Eigen::Vector3d way{0, 0, 0};   ///< m
  Eigen::Vector3d turn{0, 0, 0};  ///< rad
};

/// Lays clouds onto a map of planes: Gauss-Newton on point-to-plane distances with Huber's weights, in which
/// a direction that the cloud does not determine keeps the value of the prior (solution remapping, Zhang et
/// al. 2016).
class Registration {
 public:
  explicit Registration(const RegistrationParams& params) : params_(params) {}

  /// @param points  Body frame, m.
  /// @param prior   Pose from which the search begins.
  /// @param prior_information  Of the prior, as Registered::information; zero: none.
  /// @param window  A point this much farther than the gate from its plane still matches, m.
  /// @param top     Size of the largest voxels whose planes count, as in VoxelPlanes::find.
  Registered align(const VoxelPlanes& target, std::span<const Eigen::Vector3f> points, const Pose3& prior,
                   const Eigen::Matrix<double, 6, 6>& prior_information, double window, int top);
  Registered align(const VoxelPlanes& target, std::span<const Eigen::Vector3f> points, const Pose3& prior,
                   const Eigen::Matrix<double, 6, 6>& prior_information, double window) {
    return align(target, points, prior, prior_information, window, target.levels() - 1);
  }

  /// Sets the smear of the clouds that follow; none at first.
  void set_smear(const Smear& smear) { smear_ = smear; }

 private:
  struct Match {
    Eigen::Vector3d point;   ///< Body frame.
    Eigen::Vector3d centre;  ///< Of the plane.
    Eigen::Vector3d normal;
    double variance;
  };
  void match(const VoxelPlanes& target, std::span<const Eigen::Vector3f> points, const Pose3& pose,
             double window, int top);
  double inflation(const Pose3& pose);

  RegistrationParams params_;
  Smear smear_{};
  std::vector<Match> matches_{};
  std::vector<ResidualDirection> directions_{};
  std::vector<std::uint64_t> patches_{};
  std::size_t near_{};
};

}  // namespace adit::perception
