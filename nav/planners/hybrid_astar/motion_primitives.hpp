// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"

namespace adit::nav {

/// Motion primitives for robots of any drive: short motions between curvatures, forwards and backwards, and
/// turns on the spot for robots that can, from which a search builds paths. The curvature changes by at most
/// one level per motion, linearly along the path (a clothoid), because wheels do not steer instantly. While
/// the robot stops to change direction, they may be steered to any level. Poses are those of a car's rear
/// axle, or of base_link for other drives.
class MotionPrimitives {
 public:
  static constexpr int kLevels = 7;                   ///< Number of curvatures; the middle one is straight.
  static constexpr int kPoses = 5;                    ///< Per motion, evenly spaced; the last one is its end.
  static constexpr double kTurn = M_PI / 4;           ///< rad
  static constexpr double kStep = 0.25;               ///< Length of one motion, m.
  static constexpr double kSpacing = kStep / kPoses;  ///< m
  /// The poses of one motion, relative to its start.
  struct MotionPrimitive {
    std::array<Pose2, kPoses> poses{};
  };

  explicit MotionPrimitives(const Platform& platform);

  /// The motion from one curvature index, [0, kLevels), to another. `direction`: 1 or -1.
  const MotionPrimitive& motion(int from, int to, int direction) const {
    return primitives_[((direction > 0 ? 0 : kLevels) + from) * kLevels + to];
  }
  /// A turn on the spot by kTurn. `side`: 1 left, -1 right.
  const MotionPrimitive& turn(int side) const { return turns_[side > 0 ? 0 : 1]; }
  double curvature(int level) const { return largest_ * (level - kLevels / 2) / (kLevels / 2); }
  /// Index of the nearest curvature; `curvature`: rad/m.
  int level(double curvature) const;

 private:
  double largest_;  ///< rad/m
  std::vector<MotionPrimitive> primitives_{};
  std::array<MotionPrimitive, 2> turns_{};
};

}  // namespace adit::nav
