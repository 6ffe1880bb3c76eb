// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"

namespace adit::nav {

/// How the motions of a lattice are grown.
struct MotionSetParams {
  double step{0.25};       ///< length of one motion, m, [0.15, 0.5]
  double curvature{1.5};   ///< the largest of a robot that could turn on the spot, rad/m, (0, 4]
  double car_share{0.92};  ///< a car's: share of what its steering gives, so that it can correct, (0, 1]
};

/// The trajectory library of a robot that may not turn on the spot: short motions between curvatures, ahead
/// and backwards, of which a search makes paths. From one motion to the next the curvature changes by a
/// level at most, linearly along the way (a clothoid), since wheels are not steered at once; where the robot
/// stands between two directions they may be steered at will. Poses are those of the rear axle of a car, of
/// base_link otherwise.
class MotionSet {
 public:
  static constexpr int kLevels = 7;  ///< of curvature; the middle one is straight
  static constexpr int kPoses = 5;   ///< of one motion, evenly spaced, its end the last
  struct Motion {
    std::array<Pose2, kPoses> poses{};  ///< from the motion's start
  };

  explicit MotionSet(const Platform& platform, const MotionSetParams& params = {});

  /// The motion from a level, [0, kLevels), to another one; `direction`: 1 or -1.
  const Motion& motion(int from, int to, int direction) const {
    return motions_[static_cast<std::size_t>(((direction > 0 ? 0 : kLevels) + from) * kLevels + to)];
  }
  double curvature(int level) const { return largest_ * (level - kLevels / 2) / (kLevels / 2); }
  /// The level nearest to a curvature, rad/m.
  int level(double curvature) const;
  double step() const { return step_; }
  double spacing() const { return step_ / kPoses; }

 private:
  double step_, largest_;
  std::vector<Motion> motions_{};
};

}  // namespace adit::nav
