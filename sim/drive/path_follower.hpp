// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "sim/drive/drive_spec.hpp"

namespace adit::sim {

/// Follows the steps of a scripted drive by pure pursuit (Coulter 1992, docs/references.md) on the true pose.
class PathFollower {
 public:
  PathFollower(std::vector<DriveStep> steps, const Platform& platform, const Pose2& start);

  /// Velocity to command at a true pose, `dt` seconds after the last call.
  Twist2 command(const Pose2& pose, double dt);
  /// All steps were done.
  bool done() const { return at_ == steps_.size(); }
  std::size_t step() const { return at_; }

 private:
  Twist2 drive(const DriveTo& to, const Pose2& pose);
  Twist2 turn(const TurnBy& by, const Pose2& pose);
  void finish(const Eigen::Vector2d& from);

  std::vector<DriveStep> steps_;
  Platform platform_;
  std::size_t at_{0};
  Eigen::Vector2d from_;  ///< Where the present step began, world, m.
  double turned_{};       ///< In the present TurnBy, rad.
  double yaw_{};          ///< At the last call, rad.
  double stood_{};        ///< In the present StandFor, s.
};

}  // namespace adit::sim
