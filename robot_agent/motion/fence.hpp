// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "nav/areas/area_set.hpp"
#include "robot_agent/motion/frames.hpp"

namespace adit::agent {

/// A robot's areas in the odometry frame, and those of them that bind it now.
///
/// An area ceases to bind when the middle of the body is on its forbidden side, as after manual driving: then
/// the robot may drive back by any route. The area binds again as soon as the complete body, with
/// AreaSet::kMargin around it, is on its permitted side. All `keep_in` areas bind together, because they are
/// one piece of ground.
class Fence {
 public:
  explicit Fence(const Platform& platform) : platform_(platform) {}

  /// Follows the areas (map frame) and the robot. Costs nothing while there are no areas.
  void update(const nav::AreaSet& areas, const Frames& frames);

  bool empty() const { return all_.empty(); }
  const nav::AreaSet& all() const { return all_; }
  const nav::AreaSet& binding() const { return binding_; }
  /// Whether no part of the body is on forbidden ground.
  bool is_obeyed() const { return obeyed_; }
  /// Points along the border of the areas that bind, up to `range` metres from the body: see
  /// nav::sample_border.
  std::vector<Eigen::Vector2f> border(const Frames& frames, double range) const;

 private:
  /// Areas that bind together.
  struct Part {
    nav::AreaSet areas;
    bool binds{true};
  };
  void convert(const nav::AreaSet& areas, const Frames& frames);

  Platform platform_;
  nav::AreaSet source_{};      ///< Map frame.
  std::uint32_t map_epoch_{};  ///< Of the conversion.
  nav::AreaSet all_{}, binding_{};
  std::vector<Part> parts_{};
  bool obeyed_{true};
};

}  // namespace adit::agent
