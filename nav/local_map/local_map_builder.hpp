// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "nav/local_map/local_map.hpp"
#include "nav/terrain/air_map.hpp"
#include "nav/terrain/terrain_map.hpp"

namespace adit::nav {

/// What is in the way but no part of the ground, odometry frame, m.
struct LocalMapOthers {
  std::span<const Eigen::Vector2f> moving{};  ///< Surfaces of what moves.
  std::span<const Eigen::Vector3f> peers{};   ///< Centre and radius of the other robots: marked, not deleted.
};

/// Makes LocalMaps of the layers of a terrain map, or of an air map. It has no thread and no clock, and its
/// calls must not overlap. Any thread may release a map, and its memory serves a later one.
class LocalMapBuilder {
 public:
  /// The state of `terrain`, to which `scan` was added last.
  std::shared_ptr<const LocalMap> make(const TerrainMap& terrain, const LocalMapScan& scan,
                                       const LocalMapOthers& others = {});
  /// The same for a flying robot: what is at the height of its body is an obstacle, and no ground is known.
  std::shared_ptr<const LocalMap> make(const AirMap& air, const LocalMapScan& scan,
                                       const LocalMapOthers& others = {});
  /// Class of each cell of the window of the ground of the terrain of the last make(), by index. Obstacles
  /// are left out, because they have cells of their own.
  std::span<const CellClass> ground_classes() const { return kinds_; }

 private:
  std::shared_ptr<LocalMap> begin(const LocalMapScan& scan);
  void write_places(const TerrainMap& terrain, std::vector<LocalPlace>& places);
  static void clear(LocalMap& map);
  /// Writes all cells: those without ground are as cleared.
  void write_ground(const TerrainMap& terrain, LocalMap& map);
  static void write_obstacles(const TerrainMap& terrain, LocalMap& map);
  static void mark(const LocalMapOthers& others, LocalMap& map);
  /// Calls `change(cell)` for each cell whose centre is at most `radius` (m) from a place.
  template <class Change>
  static void visit_disc(LocalMap& map, const Eigen::Vector2f& at, float radius, Change&& change);

  std::vector<std::shared_ptr<LocalMap>> made_{};  ///< Used again when nothing else holds them.
  // By index in the ground's window.
  std::vector<CellClass> kinds_{};
  std::vector<std::uint8_t> costs_{};
};

}  // namespace adit::nav
