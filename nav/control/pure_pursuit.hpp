// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "nav/control/controller.hpp"

namespace adit::nav {

/// Parameters of PurePursuit.
struct PurePursuitParams {
  ControllerParams common{};
  double lookahead{0.35};      ///< Minimum lookahead distance, m, [0.1, 2].
  double lookahead_time{0.5};  ///< Added lookahead per speed, s, [0, 2].
  double yaw_gain{1.8};        ///< Heading gain while a holonomic robot drives, 1/s, [0, 10].
};

/// The simple controller: pure pursuit (R. C. Coulter, CMU-RI-TR-92-01) with the speed regulated by
/// curvature, remaining path length and the plan's limit (S. Macenski et al., "Regulated pure pursuit",
/// Autonomous Robots 2023).
class PurePursuit final : public Controller {
 public:
  explicit PurePursuit(const Platform& platform, const PurePursuitParams& params = {})
      : Controller(platform, params.common), params_(params) {}

 protected:
  Twist2 track(const Pose2& odom, const Place& place, double dt) override;

 private:
  PurePursuitParams params_;
};

}  // namespace adit::nav
