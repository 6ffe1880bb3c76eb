// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "sim/cloud/tum_file.hpp"

namespace adit::sim {

/// Statistics of errors, as evo prints them (Grupp 2017, docs/references.md).
struct ErrorStatistics {
  double rmse{}, mean{}, median{}, std{}, min{}, max{}, sse{};
};

struct EvaluationParams {
  double max_diff{0.01};  ///< Stamps that differ by more do not belong together, s, (0, 10].
  bool align{false};      ///< Moves the estimate onto the truth first (Umeyama 1991, without scale).
  /// Poses between which relative errors are taken: `delta` poses apart, or at least `delta` metres of the
  /// estimated path. Consecutive pairs.
  double delta{1.0};
  bool delta_in_metres{false};
};

struct Evaluation {
  std::size_t poses{};        ///< With a stamp in both.
  std::size_t pairs{};        ///< Of relative errors.
  ErrorStatistics ate{};      ///< Absolute error of the position, m.
  ErrorStatistics ate_deg{};  ///< Absolute error of the orientation, degrees.
  ErrorStatistics rpe{};      ///< Relative error of the position, m.
  ErrorStatistics rpe_deg{};  ///< Relative error of the orientation, degrees.
  double length{};            ///< Of the true path through these poses, m.
  Pose3 T_truth_estimate{};   ///< Alignment; identity without.
};

/// Statistics of a list that is not empty.
ErrorStatistics statistics(std::span<const double> errors);

/// Least-squares motion from points to others (Umeyama 1991, without scale). Reason::bad_argument for fewer
/// than three points, or points on one line.
Result<Pose3> umeyama(std::span<const Eigen::Vector3d> from, std::span<const Eigen::Vector3d> to);

/// Absolute and relative errors of a trajectory: evo_ape and evo_rpe with `tum`, digit for digit. Stamps are
/// associated as there: each pose of the shorter trajectory with the one nearest in time of the longer.
/// Reason::bad_argument when nothing belongs together, a delta leaves no pair, or the path cannot be aligned.
Result<Evaluation> evaluate(std::span<const StampedPose> truth, std::span<const StampedPose> estimate,
                            const EvaluationParams& params);

}  // namespace adit::sim
