// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"

namespace adit::nav {

/// Parameters of the motion primitives.
struct MotionPrimitiveParams {
  double step{0.25};      ///< Length of one motion, m, [0.15, 0.5].
  double curvature{1.5};  ///< Maximum curvature of a robot that can turn on the spot, rad/m, (0, 4].
  /// Fraction of a car's maximum curvature that is used, so that it can correct errors, (0, 1].
  double car_share{0.92};
};

/// Motion primitives for robots of any drive: short motions between curvatures, forwards and backwards, and
/// turns on the spot for robots that can, from which a search builds paths. The curvature changes by at most
/// one level per motion, linearly along the path (a clothoid), because wheels do not steer instantly. While
/// the robot stops to change direction, they may be steered to any level. Poses are those of a car's rear
/// axle, or of base_link for other drives.
class MotionPrimitives {
 public:
  static constexpr int kLevels = 7;          ///< Number of curvatures; the middle one is straight.
  static constexpr int kPoses = 5;           ///< Per motion, evenly spaced; the last one is its end.
  static constexpr double kTurn = M_PI / 4;  ///< rad
  /// The poses of one motion, relative to its start.
  struct MotionPrimitive {
    std::array<Pose2, kPoses> poses{};
  };

  explicit MotionPrimitives(const Platform& platform, const MotionPrimitiveParams& params = {});

  /// The motion from one curvature index, [0, kLevels), to another. `direction`: 1 or -1.
  const MotionPrimitive& motion(int from, int to, int direction) const {
    return primitives_[static_cast<std::size_t>(((direction > 0 ? 0 : kLevels) + from) * kLevels + to)];
  }
  /// A turn on the spot by kTurn. `side`: 1 left, -1 right.
  const MotionPrimitive& turn(int side) const { return turns_[side > 0 ? 0 : 1]; }
  double curvature(int level) const { return largest_ * (level - kLevels / 2) / (kLevels / 2); }
  /// Index of the nearest curvature; `curvature`: rad/m.
  int level(double curvature) const;
  double step() const { return step_; }
  double spacing() const { return step_ / kPoses; }

 private:
  double step_, largest_;
  std::vector<MotionPrimitive> primitives_{};
  std::array<MotionPrimitive, 2> turns_{};
};

}  // namespace adit::nav
