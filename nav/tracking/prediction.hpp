// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "nav/planners/plan.hpp"
#include "nav/terrain/obstacle_point.hpp"
#include "nav/tracking/tracker.hpp"

namespace adit::nav {

/// Parameters of predict() and speed_beside().
struct PredictionParams {
  double horizon{2.5};     ///< Prediction horizon, s, [0, 5].
  double sure{1.2};        ///< Predicted places block up to this time and only cost later, s, [0, horizon].
  double slack{0.4};       ///< Uncertainty of the robot's own progress along its path, m, [0, 2].
  double thickness{0.25};  ///< Depth added behind the visible side of a mover, m, [0, 1].
  double reaction{0.25};   ///< Latency from a change of a mover's velocity to the robot's braking, s, [0, 1].
  double braking_share{0.75};  ///< Fraction of the platform's acceleration used for braking, (0, 1].
  double swerve{0.5};          ///< Movers may approach this much faster than they do now, m/s, [0, 3].
  double stepping{0.5};        ///< Minimum approach speed that is assumed of a mover, m/s, [0, 3].
  double creep{0.3};           ///< Speed at which the robot may always approach a mover, m/s, (0, 1].
  double aside{0.9};           ///< Width left free for an oncoming mover on the robot's left, m, [0, 2].
};

/// Predicts where movers will be when the robot can be there too, as obstacles for a planner without a notion
/// of time. A place counts when its distance is one that the robot, now at `speed` m/s, can have travelled
/// when the mover gets there. So the robot passes behind crossing traffic, slows down, or waits. Oncoming
/// movers raise the cost of the places on the robot's left: two robots, or a robot and a person, that do not
/// know of each other keep right and do not dodge to the same side for ever.
///
/// `age`: time since the movers were observed, s. `pose`: of the robot, odometry frame. Adds to `out`
/// (robot's frame) up to its capacity.
void predict(std::span<const Mover> movers, double age, const Pose2& pose, double speed,
             const Platform& platform, std::vector<ObstaclePoint>& out, const PredictionParams& params = {});

/// Speed limit of `plan` beside movers, m/s: the robot can stop before a person who steps into its path from
/// the present position gets there. Follows the protective separation distance of ISO 13855 and ISO/TS 15066:
/// the robot's stopping distance and the distance that the person walks in that time.
double speed_beside(std::span<const Mover> movers, double age, const Plan& plan, const Platform& platform,
                    const PredictionParams& params = {});

}  // namespace adit::nav
