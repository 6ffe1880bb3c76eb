#pragma once
#include <Eigen/Core>
#include <vector>

#include "sim/world/rectangle.hpp"

namespace adit::sim {

/// Somebody who walks: along a path to its end and back again, for ever.
struct PersonSpec {
  std::vector<Eigen::Vector2d> path{};  ///< world, m; 2 to 100 places
  double speed{1.5};                    ///< m/s, (0, 3]
};

/// A person in the true world: a box of 0.45 m that lidars see and robots can hit. People look where they go:
/// they wait rather than come near a robot, so a contact is a robot's fault.
class Person {
 public:
  static constexpr double size{0.45};    ///< m
  static constexpr double height{1.75};  ///< m
  static constexpr double respect{0.4};  ///< they come no nearer to a robot, m

  explicit Person(PersonSpec spec);
  /// Where the body would be after `dt` seconds; the person stays until take().
  Rectangle next(double dt) const;
  void take(double dt);
  Rectangle body() const { return at(way_); }

 private:
  Rectangle at(double way) const;

  PersonSpec spec_;
  double length_{};  ///< of the path, m
  double way_{};     ///< walked, of there and back, m
};

}  // namespace adit::sim
