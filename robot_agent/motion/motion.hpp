#pragma once
#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <variant>

#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"

namespace adit::agent {

/// No motion: the output is zero, at once.
struct Stand {
  bool operator==(const Stand&) const = default;
};
/// A velocity for the wheels, body frame, cut to the platform's limits.
struct Velocity {
  Twist2 twist{};
  bool by_program{false};  ///< nobody sees where it leads: the collision monitor stops it, not warns
  bool operator==(const Velocity&) const = default;
};
/// A stick that says where to, for the local planner: direction and speed in the body frame, turn rate.
struct Guidance {
  Twist2 stick{};
  bool operator==(const Guidance&) const = default;
};
/// A place to drive to: map frame, m; z NaN: the floor that the robot is on.
struct GoTo {
  Eigen::Vector3d goal{0.0, 0.0, std::numeric_limits<double>::quiet_NaN()};
  bool operator==(const GoTo& other) const {
    const bool same_floor =
        goal.z() == other.goal.z() || (std::isnan(goal.z()) && std::isnan(other.goal.z()));
    return goal.head<2>() == other.goal.head<2>() && same_floor;
  }
};

/// How navigation gets on with the place that was asked for last.
struct Progress {
  bool arrived{};
  bool blocked{};      ///< every path is blocked
  bool unreachable{};  ///< no path leads there, not even through what was not seen yet; then `blocked`, too
  bool operator==(const Progress&) const = default;
};

/// What a source asks of navigation.
using Motion = std::variant<Stand, Velocity, Guidance, GoTo>;

/// The right to write to navigation. Only the mux can make one (rule 5).
class MuxKey {
  friend class Mux;
  explicit MuxKey() {}  // user-provided: nobody else gets one by braces either
};

/// The one way into navigation.
class NavigationInput {
 public:
  virtual ~NavigationInput() = default;
  virtual void accept(MuxKey, const Motion& motion, Time now) = 0;
};

}  // namespace adit::agent
