// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "core/geometry/pose.hpp"
#include "core/result/reason.hpp"
#include "core/time/time.hpp"
#include "nav/recovery/recovery.hpp"

namespace adit::agent {

/// No motion: the output is zero immediately.
struct Stand {
  bool operator==(const Stand&) const = default;
};
/// A velocity command, body frame, limited to the platform's limits.
struct Velocity {
  Twist2 twist{};
  /// No operator watches the motion: the collision monitor stops the robot instead of warning.
  bool by_program{false};
  bool operator==(const Velocity&) const = default;
};
/// A stick command for the local planner: direction and speed in the body frame, and turn rate.
struct Guidance {
  Twist2 stick{};
  bool operator==(const Guidance&) const = default;
};
/// A place to drive to: map frame, m; z NaN: the floor that the robot is on.
struct GoTo {
  Eigen::Vector3d goal{0.0, 0.0, std::numeric_limits<double>::quiet_NaN()};
  /// Number of the goal, of its mode: a place of the same number is the same goal, although it lies elsewhere
  /// now. 0: each place is another goal.
  std::uint32_t id{};
  /// Heading in which the robot is to stand there, rad, if it can turn on the spot.
  std::optional<double> yaw{};
  double tolerance{};  ///< Of the place, m; 0: the planner's.
  double max_speed{};  ///< Limit, m/s; 0: the platform's.
  bool pass{};         ///< More places follow: the robot need not stop at this one.
  /// A longer route is none: the place counts as unreachable while there is no shorter one, m.
  double max_route{std::numeric_limits<double>::infinity()};
  /// The place lies farther along the same path as the one before: until its route is known, the robot heads
  /// for that one.
  bool continues{false};
  bool operator==(const GoTo& other) const {
    const bool same_floor =
        goal.z() == other.goal.z() || (std::isnan(goal.z()) && std::isnan(other.goal.z()));
    return goal.head<2>() == other.goal.head<2>() && same_floor && max_route == other.max_route &&
           yaw == other.yaw && tolerance == other.tolerance && max_speed == other.max_speed &&
           pass == other.pass;
  }
};

/// Navigation's progress towards the place that was requested last.
struct Progress {
  bool arrived{};
  bool blocked{};        ///< Every path is blocked.
  bool goal_seen{true};  ///< The ground at the goal is known.
  Reason reason{};   ///< Why it makes no progress: see nav::Recovery. None: nothing is to be reported yet.
  Reason refusal{};  ///< With goal_unreachable: what is wrong with the goal itself, if that is known.
  std::string refusal_text{};  ///< Names what `refusal` is about; empty: nothing more is known.
  nav::RecoveryState recovery{nav::RecoveryState::drive};
  nav::Cause cause{};        ///< With `blocked`: what is in the way.
  nav::Side in_collision{};  ///< With start_in_collision: on this side something touches it, or nearly.
  bool operator==(const Progress&) const = default;

  /// No path leads there, not even through unobserved space.
  bool unreachable() const { return reason == Reason::goal_unreachable; }
  bool gave_up() const { return recovery == nav::RecoveryState::give_up; }
};

/// A motion that a source requests from navigation.
using Motion = std::variant<Stand, Velocity, Guidance, GoTo>;

/// The permission to write to navigation (passkey idiom). Only the mux can construct it (rule 5).
class MuxKey {
  friend class Mux;
  explicit MuxKey() {}  // User-provided, so that braces cannot construct it elsewhere.
};

/// The only input interface of navigation.
class NavigationInput {
 public:
  virtual ~NavigationInput() = default;
  virtual void accept(MuxKey, const Motion& motion, Time now) = 0;
};

}  // namespace adit::agent
