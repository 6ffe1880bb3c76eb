// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/config/platform.hpp"
#include "nav/planners/planner.hpp"

namespace adit::nav {

/// A minimal planner: drives straight along the free direction nearest to the target. After J. Borenstein and
/// Y. Koren, "The vector field histogram", 1991, with corridors in place of a histogram. The robot counts as
/// a disc, so it passes only gaps wider than its diagonal.
class VfhPlanner final : public Planner {
 public:
  explicit VfhPlanner(const Platform& platform) : platform_(platform) {}
  Plan plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
            double stamp_s) override;

 private:
  double free_along(double heading, std::span<const ObstaclePoint> obstacles) const;
  Platform platform_;
};

}  // namespace adit::nav
