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
  int part{};  ///< Of the keep_in areas, which are one piece of ground: -1; else the number of the keep_out
               ///< area.
};

/// The areas of a robot, at most kMax with different names. A copy shares them: it is cheap, and it costs
/// nothing while there are none.
class AreaSet {
 public:
  static constexpr std::size_t kMax = 16;
  /// Least distance that robots keep from forbidden ground, m.
  static constexpr double kMargin = 0.1;

  AreaSet() = default;
  bool empty() const { return !content_; }
  std::span<const Area> all() const;
  const Area* find(std::string_view name) const;
  /// Whether both have the same areas in the same order, with the same margins.
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

  /// The same areas, with another distance that robots keep from forbidden ground, m. Negative: robots may be
  /// on forbidden ground, no farther than so from permitted ground.
  AreaSet with_margin(double margin) const;
  /// The same, by area: `margin_of` is called with each of them. That of all keep_in areas must be the same.
  template <class Margin>
  AreaSet with_margins(Margin&& margin_of) const {
    std::vector<double> margins;
    for (const Area& area : all()) margins.push_back(margin_of(area));
    return with(std::move(margins));
  }

  /// Whether a robot may be at a place, m: it is on permitted ground, or as near to it as a negative margin
  /// allows.
  bool permits(const Eigen::Vector3d& place) const;
  /// Whether forbidden ground is at least the margin and `distance` away, m.
  bool permits(const Eigen::Vector3d& place, double distance) const;
  /// Whether no part of a convex outline at height z is on forbidden ground; without a margin.
  bool permits(std::span<const Eigen::Vector2d> outline, double z) const;
  /// Distance of a convex outline at height z from forbidden ground, m; negative: so far its farthest part is
  /// from permitted ground. Infinite without areas.
  double clearance(std::span<const Eigen::Vector2d> outline, double z) const;
  /// Whether robots may be anywhere within an area: looked for at the points of a grid.
  bool leaves_room(const Area& area) const;
  /// Factor of what is seen at a place: the product of the weights there; 0 where robots may not be.
  double weight(const Eigen::Vector3d& place) const;
  /// The margin of all()[index], m.
  double margin(std::size_t index) const;
  /// The margin of the areas whose border it is a piece of, m.
  double margin(const BorderPiece& piece) const;
  /// The border between permitted and forbidden ground at a height.
  std::span<const BorderPiece> border(double z) const;

 private:
  struct Content;
  explicit AreaSet(std::vector<Area> areas, std::vector<double> margins = {});
  AreaSet with(std::vector<double> margins) const;
  /// Whether `permits(part, place is on its permitted side, margin)` is true of all parts.
  template <class Permits>
  bool all_parts(const Eigen::Vector3d& place, Permits&& permits) const;
  /// Distance of a place from the border of a part, m.
  double to_border(const Eigen::Vector3d& place, int part) const;
  double clearance(const Eigen::Vector3d& place) const;
  std::shared_ptr<const Content> content_{};  ///< Null: there are no areas.
};

/// Corners of a platform's footprint, grown by `margin` on every side, m.
std::vector<Eigen::Vector2d> outline(const Platform& platform, const Pose2& pose, double margin = 0.0);

/// Distance from the middle of a platform that stands at some heading to its nearest side, m.
inline double least_reach(const Platform& platform) { return std::min(platform.length, platform.width) / 2; }

/// Writes points along the border at height z, the margin on its permitted side and at most 0.1 m apart, up
/// to `range` metres from a place. A planner that passes none of them keeps the distance.
void sample_border(const AreaSet& areas, const Eigen::Vector3d& place, double range,
                   std::vector<Eigen::Vector2f>& points);

}  // namespace adit::nav
