// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <span>

#include "core/geometry/staircase.hpp"

namespace adit::perception {

/// Points of one lidar at one instant, and where their rays began, in one level frame, m.
struct StairsRays {
  Eigen::Vector3f eye{Eigen::Vector3f::Zero()};
  std::span<const Eigen::Vector3f> points{};
};

/// What rays show of a staircase that is known.
struct StairsCheck {
  enum class Riser {
    unseen,
    there,  ///< The ground behind it is a step higher than the ground before it.
    level,  ///< The ground goes on level: there is no riser.
  };
  Riser below{}, foot{}, top{},
      above{};  ///< `below` and `above`: one step beyond the lowest and highest one.
  /// Rays that crossed the flight and ended clearly behind it, and those that ended on it.
  int through{}, on{};

  /// Rays pass where the steps should be. Rays that end before them say nothing, nor do those without return.
  bool gone() const { return through >= kLeastThrough && through > kThroughPerOn * on; }
  static constexpr int kLeastThrough = 40;
  static constexpr int kThroughPerOn = 4;  ///< Through treads of grating pass as many as end on them.
};

StairsCheck check_stairs(const Staircase& stairs, std::span<const StairsRays> scans);

}  // namespace adit::perception
