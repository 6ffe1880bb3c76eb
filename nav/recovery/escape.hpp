// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "nav/geometry/footprint.hpp"
#include "nav/planners/hybrid_astar/solid_points.hpp"
#include "nav/planners/plan.hpp"

namespace adit::nav {

/// Plans a path out of a place where the robot is closer to obstacles than any planner accepts, or in
/// contact. A search (Dijkstra's) over short motions, straight, curved and on the spot, finds the nearest
/// pose with `kClear` beside the whole body. On the way there the body may be as close to obstacles as at the
/// start, and no closer. The size is fixed, and nothing is allocated after construction.
class Escape {
 public:
  static constexpr double kClear = 0.10;  ///< m
  static constexpr double kSpeed = 0.1;   ///< m/s

  explicit Escape(const Platform& platform);

  /// Plans the first part of the path that is driven in one direction. Returns nothing if there is no path
  /// within 1.2 m, or `kClear` is free already. `pose`: odometry frame; `obstacles`: robot's frame at `pose`.
  std::optional<Plan> plan(const Pose2& pose, std::span<const ObstaclePoint> obstacles);
  /// Side of the nearest obstacle; none: at least `kClear` is free.
  Side side_of(std::span<const ObstaclePoint> obstacles) const;

 private:
  struct Node {
    Pose2 pose{};
    float cost{};
    float depth{};  ///< Of the deepest obstacle in the body, m, negative outside.
    float least{};  ///< Its minimum along the path, m.
    std::int32_t parent{-1};
    std::int8_t direction{};  ///< Driving direction that leads here, 1 or -1; 0: a turn on the spot.
  };
  struct Open {
    float cost;
    std::int32_t node;
    bool operator<(const Open& other) const {
      return cost != other.cost ? cost > other.cost : node > other.node;
    }
  };
  static constexpr int kSide = 48, kTurns = 72;
  static constexpr std::size_t kMaxNodes = 12'000;

  void expand(std::int32_t index);
  void offer(std::int32_t from, const Pose2& motion, int direction, float cost);
  Plan write(std::int32_t index, const Pose2& pose) const;

  Platform platform_;
  Footprint body_;
  double bend_;  ///< Maximum curvature, rad/m.
  SolidPoints points_{};
  std::vector<Node> nodes_{};
  std::vector<Open> open_{};
  std::vector<std::uint32_t> closed_;
  std::uint32_t round_{0};
};

}  // namespace adit::nav
