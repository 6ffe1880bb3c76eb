// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "sim/world/rectangle.hpp"

namespace adit::sim {

/// Somebody who walks: along a path to its end and back again, for ever.
struct PersonSpec {
  std::vector<Eigen::Vector2d> path{};  ///< World frame, m; 2 to 100 places.
  double speed{1.5};                    ///< m/s, (0, 3]
  bool yields{true};                    ///< Waits instead of approaching a robot.
};

/// A person in the true world: a box of 0.45 m that lidars see and robots can hit. Those who yield look where
/// they go; the others walk into whatever stands in their way, lean on it, and turn about after a while.
class Person {
 public:
  static constexpr double kSize{0.45};     ///< m
  static constexpr double kHeight{1.75};   ///< m
  static constexpr double kRespect{0.4};   ///< Smallest distance to a robot of those who yield, m.
  static constexpr double kPatience{2.0};  ///< The others lean against a robot this long, s.

  explicit Person(PersonSpec spec);
  /// Where the body would be after `dt` seconds; the person stays until take().
  Rectangle next(double dt) const;
  void take(double dt);
  /// Stays where it is for this step.
  void wait() { before_ = way_; }
  /// Somebody is in the way of one who does not yield: leans on him for this step.
  void lean(double dt);
  Rectangle body() const { return at(way_); }
  /// Where the body was a step ago.
  Rectangle before() const { return at(before_); }
  bool yields() const { return spec_.yields; }

 private:
  Rectangle at(double way) const;

  PersonSpec spec_;
  double length_{};  ///< Length of the path, m.
  double way_{};     ///< Distance walked, of there and back, m.
  double before_{};  ///< The same one step earlier.
  double leant_{};   ///< s
};

}  // namespace adit::sim
