// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/geometry/pose.hpp"

namespace adit::nav {

/// The local planner's target.
struct Target {
  /// What the robot is to reach.
  enum class Kind : std::uint8_t {
    none,       ///< No target: the robot stops.
    goal,       ///< A point.
    direction,  ///< A direction, as far as it is free (smart joystick).
    back_up,    ///< Back along the way that the robot came.
    leave,      ///< Away from the obstacles that nearly touch the robot.
  };
  Kind kind{Kind::none};
  Eigen::Vector2d goal{0, 0};  ///< Odometry frame, m.
  double direction{0};         ///< Body frame, rad, counter-clockwise from ahead.
  double speed{0};             ///< Speed limit, m/s; 0 for a goal: the platform's speed.
  double tolerance{0};         ///< Goal tolerance, m; 0: the planner's default.
  /// Number of the route that leads to the goal in about a straight line; 0: there is none.
  std::uint32_t route{0};
  bool last{true};      ///< The route ends at the goal.
  double end_speed{0};  ///< Speed at the goal that the rest of the route permits, m/s.
  bool nudges{false};   ///< Without a path to the goal, away from obstacles that nearly touch the robot.
  std::optional<Pose2> passage{};  ///< Narrow passage before the goal: centre and heading, odometry frame.

  static Target to(const Eigen::Vector2d& goal, double speed = 0.0) {
    return {.kind = Kind::goal, .goal = goal, .speed = speed};
  }
  static Target along(double direction, double speed) {
    return {.kind = Kind::direction, .direction = direction, .speed = speed};
  }
};

/// What keeps a robot from its target.
enum class Cause : std::uint8_t {
  none,
  mover,   ///< Something that moves.
  peer,    ///< Another robot of the team.
  fixed,   ///< An obstacle.
  border,  ///< The border of an area.
};

/// A side of the body.
enum class Side : std::uint8_t { none, ahead, left, behind, right };

/// Result of the local planner. Its size is bounded and it has no pointers, so a copy is a memcpy.
struct Plan {
  static constexpr std::size_t kMaxPath = 72;

  double stamp_s{0};      ///< Time of the pose that the plan starts from, s.
  bool blocked{false};    ///< No path is free: `path` is empty.
  bool nudge{false};      ///< The path leads away from obstacles, and not to the target.
  Side side{Side::none};  ///< Side of the obstacle that prevents the robot from starting.
  bool arrived{false};    ///< The robot is within the tolerance of the goal: `path` is empty.
  bool ends_at_goal{false};
  double end_speed{0};       ///< Permitted speed at the end of the path, m/s.
  double reached{0};         ///< How far along the straight line to the target the path leads, m.
  Cause cause{Cause::none};  ///< What is nearest on that line: of a blocked plan, or near by.
  double cause_ahead{0};     ///< How far away that is, m.
  bool reverse{false};       ///< The path is driven backwards; its poses are those of the body.
  bool turn_first{false};    ///< The path begins with a turn on the spot, however small it is.
  int turn{0};               ///< Side of the turn if the path starts behind: 1 left, -1 right, 0 either.
  double max_speed{0};       ///< m/s
  double length{0};          ///< Length of the path, m.
  double clearance{0};       ///< Distance from the footprint to the nearest obstacle, m, at most 2.

  std::array<Pose2, kMaxPath> poses{};  ///< Odometry frame, from the robot on.
  std::uint32_t pose_count{0};

  std::span<const Pose2> path() const { return {poses.data(), pose_count}; }
};

}  // namespace adit::nav
