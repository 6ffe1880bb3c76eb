// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/hybrid_astar/motion_primitives.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr double kSpotCurvature = 1.5;  // Largest curvature of a robot that can turn on the spot, 1/m.
constexpr double kCarShare = 0.92;      // Of a car's largest curvature: the rest is left to correct errors.

}  // namespace

MotionPrimitives::MotionPrimitives(const Platform& platform)
    : largest_(platform.turns_on_spot() ? kSpotCurvature : kCarShare / platform.least_radius()) {
  if (platform.path_curvature > 0) largest_ = std::min(largest_, platform.path_curvature);
  for (const int direction : {1, -1})
    for (int from = 0; from < kLevels; ++from)
      for (int to = 0; to < kLevels; ++to) {
        MotionPrimitive motion{};
        // Indices that differ by more: the robot steered while it was stationary.
        const double begin = std::abs(from - to) <= 1 ? curvature(from) : curvature(to);
        Pose2 pose{};
        const double ds = direction * kSpacing;
        for (int i = 0; i < kPoses; ++i) {
          const double bend = begin + (curvature(to) - begin) * (i + 0.5) / kPoses;
          const double turn = ds * bend;
          pose = pose * Pose2{ds * std::cos(turn / 2), ds * std::sin(turn / 2), turn};
          motion.poses[i] = pose;
        }
        primitives_.push_back(motion);
      }
  for (const int side : {1, -1})
    for (int i = 0; i < kPoses; ++i)
      turns_[side > 0 ? 0 : 1].poses[i] = {0, 0, side * kTurn * (i + 1) / kPoses};
}

int MotionPrimitives::level(double curvature) const {
  const double exact = curvature / largest_ * (kLevels / 2) + kLevels / 2;
  return std::clamp(static_cast<int>(std::lround(exact)), 0, kLevels - 1);
}

}  // namespace adit::nav
