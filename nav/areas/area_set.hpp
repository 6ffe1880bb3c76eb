// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "nav/areas/area.hpp"

namespace adit::nav {

/// A piece of the border between permitted ground, on its left, and forbidden ground.
struct BorderPiece {
  Eigen::Vector2d from{0, 0}, to{0, 0};  ///< m
};

/// The areas of a robot, at most kMax with different names. A copy shares them: it is cheap, and it costs
/// nothing while there are none.
class AreaSet {
 public:
  static constexpr std::size_t kMax = 16;
  /// Distance that robots keep from forbidden ground, m.
  static constexpr double kMargin = 0.1;

  AreaSet() = default;
  bool empty() const { return !content_; }
  std::span<const Area> all() const;
  const Area* find(std::string_view name) const;
  bool operator==(const AreaSet& other) const;
  /// Whether both are copies of one set; quicker than ==.
  bool same(const AreaSet& other) const { return content_ == other.content_; }

  /// Adds an area that was checked(), or replaces the one of its name. Error: bad_argument if there are too
  /// many.
  Result<void> add(Area area);
  /// Returns false if there is no area of that name.
  bool remove(std::string_view name);
  /// The areas that `keep` selects.
  template <class Keep>
  AreaSet only(Keep&& keep) const {
    std::vector<Area> chosen;
    for (const Area& area : all())
      if (keep(area)) chosen.push_back(area);
    return AreaSet(std::move(chosen));
  }
  /// The areas in another frame, whose origin is `z` higher than this one's, m.
  AreaSet in_frame(const Pose2& T_other_this, double z) const;

  /// Whether a robot may be at a place, m.
  bool permits(const Eigen::Vector3d& place) const;
  /// Whether it may, and no forbidden ground is nearer than `distance`, m.
  bool permits(const Eigen::Vector3d& place, double distance) const;
  /// Whether no part of a convex outline at height z is on forbidden ground.
  bool permits(std::span<const Eigen::Vector2d> outline, double z) const;
  /// Whether robots may be anywhere within an area: looked for at the points of a grid.
  bool leaves_room(const Area& area) const;
  /// Factor of what is seen at a place: the product of the weights there; 0 where robots may not be.
  double weight(const Eigen::Vector3d& place) const;
  /// The border between permitted and forbidden ground at a height.
  std::span<const BorderPiece> border(double z) const;

 private:
  struct Content;
  explicit AreaSet(std::vector<Area> areas);
  std::shared_ptr<const Content> content_{};  ///< Null: there are no areas.
};

/// Corners of a platform's footprint, grown by `margin` on every side, m.
std::vector<Eigen::Vector2d> outline(const Platform& platform, const Pose2& pose, double margin = 0.0);

/// Least distance from forbidden ground to a place at which a platform can stand at some heading, m.
inline double least_reach(const Platform& platform) {
  return std::min(platform.length, platform.width) / 2 + AreaSet::kMargin;
}

/// Writes points along the border at height z, AreaSet::kMargin on its permitted side and at most 0.1 m
/// apart, up to `range` metres from a place. A planner that passes none of them keeps the distance.
void sample_border(const AreaSet& areas, const Eigen::Vector3d& place, double range,
                   std::vector<Eigen::Vector2f>& points);

}  // namespace adit::nav
