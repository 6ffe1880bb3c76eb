// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/result/result.hpp"
#include "sim/world/world.hpp"

namespace adit::bench {

/// A world, and a place in it where a robot can begin.
struct Ground {
  sim::World world;
  Eigen::Vector2d start{0, 0};  ///< m

  static constexpr double kHeadroom = 0.8;  ///< Of the robot, m.
  /// Height of the ground, m; 0 where there is none.
  double height(const Eigen::Vector2d& at) const;
  /// Whether the robot, 1 m wide, can be there; `z`: height of the ground beside it, m.
  bool can_stand(const Eigen::Vector2d& at, double z) const;
};

/// The file geb079.bt.
Result<std::filesystem::path> building_file();
/// A generated world (kind and seed; "streets": 104 x 104 m of them) or, "geb079", that building.
Result<Ground> make_ground(std::string_view name, std::uint64_t seed);

}  // namespace adit::bench
