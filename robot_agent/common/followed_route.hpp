// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace adit::agent {

/// The rest of the route that a robot follows, as it is sent to stations. Map frame, m.
struct FollowedRoute {
  static constexpr std::size_t kMaxCorners = 32;  ///< Of `points`; more are not sent.

  std::uint32_t goal_id{};                ///< As in the robot's behaviour.
  std::size_t corners{};                  ///< Of the complete rest; 0: the robot follows no route.
  std::vector<Eigen::Vector3d> points{};  ///< The first corners, from the robot on.
  std::uint32_t unknown{};                ///< Bit i: the leg from corner i leads through unknown space.
};

}  // namespace adit::agent
