#pragma once
#include <Eigen/Core>
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
/// A place for the local planner: map frame, m.
struct GoTo {
  Eigen::Vector2d goal{0.0, 0.0};
  bool operator==(const GoTo& other) const { return goal == other.goal; }
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
