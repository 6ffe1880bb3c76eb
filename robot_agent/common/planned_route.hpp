// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace adit::agent {

/// A requested route as it is sent to stations. Map frame, m.
struct PlannedRoute {
  static constexpr std::size_t kMaxCorners = 24;  ///< An acknowledgement has no room for more.

  double length{};                        ///< m
  double unknown_length{};                ///< Length through space that was not observed yet, m.
  std::size_t corners{};                  ///< Of the complete route, its start and its goal included.
  std::vector<Eigen::Vector3d> points{};  ///< The first corners, at most kMaxCorners.
};

}  // namespace adit::agent
