#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace adit::agent {

/// A route that somebody asked for, as it travels to stations. Map frame, m.
struct PlannedRoute {
  static constexpr std::size_t kMaxCorners = 24;  ///< an acknowledgement has no room for more

  double length{};                        ///< m
  double unknown_length{};                ///< of it through space that was not seen yet, m
  std::size_t corners{};                  ///< of the complete route, its start and its goal included
  std::vector<Eigen::Vector3d> points{};  ///< the first corners, at most kMaxCorners
};

}  // namespace adit::agent
