// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/geometry/pose.hpp"
#include "core/result/reason.hpp"

namespace adit::nav {

/// Where the local planner shall go.
struct Target {
  enum class Kind : std::uint8_t {
    none,       ///< nowhere: the plan is to stand
    goal,       ///< to a point
    direction,  ///< along a direction, as far as it goes (smart joystick)
  };
  Kind kind{Kind::none};
  Eigen::Vector2d goal{0, 0};   ///< odometry frame, m
  double direction{0};          ///< in the body frame, rad, counter-clockwise from ahead
  double speed{0};              ///< not faster than this, m/s; 0 of a goal: the platform's speed
  double tolerance{0};          ///< of a goal, m; 0: the planner's own
  bool on_route{false};         ///< A goal on a route, which leads there in about a straight line.
  std::optional<Pose2> gate{};  ///< a gap that leads to a goal: its middle, heading through; odometry frame
  bool held{false};             ///< the collision monitor keeps the robot from driving what was planned

  static Target to(const Eigen::Vector2d& goal, double speed = 0.0) {
    return {.kind = Kind::goal, .goal = goal, .speed = speed};
  }
  static Target along(double direction, double speed) {
    return {.kind = Kind::direction, .direction = direction, .speed = speed};
  }
};

/// A side of the body.
enum class Side : std::uint8_t { none, ahead, left, behind, right };

/// What the local planner found. Of bounded size, without pointers: copied at no more than a memcpy.
struct Plan {
  static constexpr std::size_t kMaxPath = 72;

  double stamp_s{0};            ///< of the pose that it was made for
  bool blocked{false};          ///< every way is blocked: `path` is empty
  Reason reason{Reason::none};  ///< Reason::blocked, start_in_collision, goal_missing (no target) or none
  Side side{Side::none};        ///< Where the obstacle is that keeps the robot from starting.
  bool arrived{false};          ///< within the tolerance of the goal: `path` is empty
  bool ends_at_goal{false};
  bool reverse{false};     ///< the path is driven backwards; its poses are those of the body
  bool turn_first{false};  ///< The path begins with a turn on the spot, however small it is.
  int turn{0};             ///< the side to turn to, should the path start behind: 1 left, -1 right, 0 either
  double max_speed{0};     ///< m/s
  double length{0};        ///< of the path, m
  double clearance{0};     ///< from the footprint to the nearest obstacle, m, at most 2
  int heading{0};          ///< which of the 36 headings, degrees from the body's x
  int group{-1};           ///< which group of the library
  int option{-1};          ///< which of the planner's libraries: 0 long and wide ... last short and a squeeze

  std::array<Pose2, kMaxPath> poses{};  ///< odometry frame, from the robot on
  std::uint32_t pose_count{0};

  std::span<const Pose2> path() const { return {poses.data(), pose_count}; }
};

}  // namespace adit::nav
