// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "nav/areas/area_set.hpp"
#include "robot_agent/motion/frames.hpp"

namespace adit::agent {

/// A robot's areas in the odometry frame, with the distance from their borders that binds it now.
///
/// The body stays AreaSet::kMargin and three standard deviations of its place away from forbidden ground. A
/// body that is nearer, or on forbidden ground, as after a correction of the map or manual driving, may come
/// back by any way that leads no farther out: the border is moved out to where it is, and follows it back. It
/// is moved out again only when the areas change, a correction of the map moves the body by more than a step
/// beyond it, or the robot is not bound. All `keep_in` areas are one piece of ground.
class Fence {
 public:
  /// The border is moved out in steps, and one of them farther, so that the body does not touch it, m.
  static constexpr double kStep = 0.05;
  /// A body that is farther out than this does not come back by itself, m.
  static constexpr double kFarthestOut = 1.0;

  explicit Fence(const Platform& platform) : platform_(platform) {}

  /// Follows the areas (map frame) and the robot. Costs nothing while there are no areas.
  /// @param sigma  Standard deviation of the place in the map, m; may be infinite.
  /// @param bound  The robot drives by itself.
  void update(const nav::AreaSet& areas, const Frames& frames, double sigma, bool bound);

  bool empty() const { return all_.empty(); }
  /// With the distance that a robot keeps that is well within them: for goals, and for what is to be
  /// explored.
  const nav::AreaSet& all() const { return all_; }
  /// With the distance that binds the body now.
  const nav::AreaSet& binding() const { return binding_; }
  /// The same for the cells of the route map, of which a border that was moved out leaves one more open: the
  /// local planner and the monitor keep the distance.
  const nav::AreaSet& routable() const { return routable_; }
  /// Whether no part of the body is on forbidden ground.
  bool is_obeyed() const { return out_ <= 0.0; }
  /// Whether the body is so far on forbidden ground that an operator decides how it comes back.
  bool is_far_out() const { return out_ > kFarthestOut; }
  /// Points along the border of the areas that bind, up to `range` metres from the body: see
  /// nav::sample_border.
  std::vector<Eigen::Vector2f> border(const Frames& frames, double range) const;

  /// The distance from forbidden ground for that uncertainty, m.
  static double margin(double sigma);

 private:
  /// Areas with one margin.
  struct Part {
    nav::AreaSet areas;
    std::optional<double> margin{};  ///< Of the border, m; unset: it follows from where the body is.
  };
  void convert(const nav::AreaSet& areas, const Frames& frames);
  nav::AreaSet with_margins(double farther) const;

  Platform platform_;
  nav::AreaSet source_{};      ///< Map frame.
  std::uint32_t map_epoch_{};  ///< Of the conversion.
  double margin_{nav::AreaSet::kMargin};
  nav::AreaSet all_{}, binding_{}, routable_{};
  std::vector<Part> parts_{};
  double out_{};  ///< So far the body is on forbidden ground; negative: away from it, m.
};

}  // namespace adit::agent
