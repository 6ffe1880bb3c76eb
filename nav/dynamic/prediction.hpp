// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "nav/dynamic/tracker.hpp"
#include "nav/plan.hpp"
#include "nav/terrain/obstacle_point.hpp"

namespace adit::nav {

struct PredictionParams {
  double horizon{2.5};         ///< looks this far ahead, s, [0, 5]
  double sure{1.2};            ///< until then a place is taken, later it is avoided, s, [0, horizon]
  double slack{0.4};           ///< the robot may be so much nearer or farther than reckoned, m, [0, 2]
  double thick{0.25};          ///< what moves is so much thicker than its side that is seen, m, [0, 1]
  double reaction{0.25};       ///< from a step of a mover until the robot begins to brake, s, [0, 1]
  double braking_share{0.75};  ///< of the platform's acceleration, (0, 1]
  double swerve{0.5};          ///< what moves may come nearer by so much faster than it does, m/s, [0, 3]
  double stepping{0.5};        ///< and so fast whatever it does now, m/s, [0, 3]
  double creep{0.3};           ///< so fast the robot may come near it, m/s, (0, 1]
  double aside{0.9};           ///< what comes head on is given the left side, so wide, m, [0, 2]
};

/// Where what moves will be when the robot can be there, too, as obstacles for a planner that knows of
/// places and not of times: a place counts when its distance is a way that the robot, now at `speed` m/s, can
/// have made when the mover gets there. So the robot passes behind what crosses, slows down, or waits. What
/// comes head on makes the places on its left hard to cross: two robots, or a robot and a person, that do not
/// know of each other keep right, and do not dodge to the same side for ever.
///
/// `age`: since the movers were seen, s. `pose`: of the robot, odometry frame. Adds to `out`, robot's frame,
/// no more than its capacity holds.
void predict(std::span<const Mover> movers, double age, const Pose2& pose, double speed,
             const Platform& platform, std::vector<ObstaclePoint>& out, const PredictionParams& params = {});

/// How fast `plan` may be driven beside what moves, or did so a moment ago, m/s: so that the robot stands
/// before somebody who steps in its way from where he is then gets there. After the protective separation
/// distance of ISO 13855 and ISO/TS 15066: way to a stop, and the other's way in that time.
double speed_beside(std::span<const Mover> movers, double age, const Plan& plan, const Platform& platform,
                    const PredictionParams& params = {});

}  // namespace adit::nav
