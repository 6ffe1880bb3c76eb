// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "nav/control/controller.hpp"

namespace adit::nav {

/// The simple controller: pure pursuit (R. C. Coulter, CMU-RI-TR-92-01) with the speed regulated by
/// curvature, remaining path length and the plan's limit (S. Macenski et al., "Regulated pure pursuit",
/// Autonomous Robots 2023).
class PurePursuit final : public Controller {
 public:
  using Controller::Controller;

 protected:
  Twist2 track(const Pose2& odom, const Place& place, double dt) override;
};

}  // namespace adit::nav
