// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/geometry/round_down.hpp"
#include "nav/terrain/cell_class.hpp"

namespace adit::nav {

/// A cell of a LocalMap. Heights are those of the odometry frame, m. Where the ground was not measured, a
/// cell can be `unknown` and still have the cost of the ground around it.
struct LocalCell {
  static constexpr std::uint8_t kImpassable = 255;
  static constexpr float kAsideUnit = 0.05f / 250;  ///< m
  static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

  float low{kNone};      ///< Height of the ground, measured or inherited; NaN: none.
  float high{kNone};     ///< Height of an obstacle's highest return; NaN: none, or the robot flies.
  CellClass kind{};      ///< See CellClass.
  std::uint8_t cost{};   ///< 1/254 of the platform's limit; kImpassable: the body cannot cross.
  bool measured : 1 {};  ///< `low` was measured.
  bool fresh : 1 {};     ///< `low` was measured by the newest scan.
  bool peer : 1 {};      ///< Where another robot of the team may be.
  std::int8_t aside_x{}, aside_y{};  ///< Surface of the obstacle from the cell's centre, kAsideUnit.

  bool impassable() const { return cost == kImpassable; }
};

/// A place that costs something to cross, odometry frame.
struct LocalPlace {
  float x{}, y{};    ///< Its exact position, m.
  float cost{1.0f};  ///< (0, 1]; 1: impassable.
  float age{};       ///< Time since an obstacle was first seen there, s; 0 for other classes.
  CellClass
      kind{};  ///< As of the cell, but `drop` also where the ground is only probably missing (cost < 1).
};

/// The scan of which a LocalMap is the newest state.
struct LocalMapScan {
  double stamp_s{-std::numeric_limits<double>::infinity()};  ///< When it entered the map, s.
  Pose3 body{};  ///< base_link then, odometry frame, by the pose that controls the body.
  /// The same by the robot's own odometry: what is at p here is at located * body^-1 * p in maps that last.
  Pose3 located{};
  std::uint32_t odom_epoch{};  ///< Epoch of the odometry frame.
  std::uint32_t jumps{};       ///< How often `located` jumped before.
};

/// What the scans of the last minute show of the ground around the robot, for one platform: a value that is
/// never changed once it is made, and that several threads may read. A square of 12.8 m of 5 cm cells along
/// the axes of the odometry frame, with the robot in its middle.
class LocalMap {
 public:
  static constexpr float kCell = 0.05f;  ///< m
  static constexpr int kSide = 256;      ///< Cells along each axis.
  /// Nothing is farther from the origin of the odometry frame, m.
  static constexpr float kFarthest = 1e6f;

  const LocalMapScan& scan() const { return scan_; }
  bool inside(int ix, int iy) const {
    const auto offset = [](int i, int from) {
      return static_cast<unsigned>(i) - static_cast<unsigned>(from);
    };
    return offset(ix, x0_) < kSide && offset(iy, y0_) < kSide;
  }
  /// The cell with these coordinates, which must be inside.
  const LocalCell& at(int ix, int iy) const { return cells_[index(ix, iy)]; }
  /// The cell of a place, m; null outside of the map.
  const LocalCell* find(float x, float y) const {
    if (!is_place(x, y)) return nullptr;
    const int ix = cell(x), iy = cell(y);
    return inside(ix, iy) ? &at(ix, iy) : nullptr;
  }
  /// False also for what is no number.
  static bool is_place(float x, float y) { return std::abs(x) < kFarthest && std::abs(y) < kFarthest; }
  /// The coordinate of the cell of one that is_place(), m.
  static int cell(float metres) { return round_down(metres * (1.0f / kCell)); }
  static float centre(int i) { return (static_cast<float>(i) + 0.5f) * kCell; }
  /// Calls `visit(ix, iy, cell)` for each cell whose centre is at most `reach` (m) from the robot.
  template <class Visit>
  void visit(float reach, Visit&& visit) const {
    if (!is_placed()) return;
    const auto bx = static_cast<float>(scan_.body.position.x()),
               by = static_cast<float>(scan_.body.position.y());
    const int cells = static_cast<int>(std::min(reach / kCell, static_cast<float>(kSide))) + 1;
    const int x = cell(bx), y = cell(by);
    for (int iy = std::max(y0_, y - cells); iy < std::min(y0_ + kSide, y + cells + 1); ++iy)
      for (int ix = std::max(x0_, x - cells); ix < std::min(x0_ + kSide, x + cells + 1); ++ix)
        if (const float dx = centre(ix) - bx, dy = centre(iy) - by; dx * dx + dy * dy <= reach * reach)
          visit(ix, iy, at(ix, iy));
  }
  /// Obstacles, drops, steep and rough ground, and steps. Several layers of one place have one entry each.
  std::span<const LocalPlace> places() const { return places_; }

 private:
  friend class LocalMapBuilder;
  bool is_placed() const {
    return is_place(static_cast<float>(scan_.body.position.x()), static_cast<float>(scan_.body.position.y()));
  }
  static std::size_t index(int ix, int iy) {
    return static_cast<std::size_t>((iy & (kSide - 1)) * kSide + (ix & (kSide - 1)));
  }

  LocalMapScan scan_{};
  static constexpr int kNowhere = std::numeric_limits<int>::min();

  /// The cell with the smallest coordinates; nothing is inside of a map that has no place.
  int x0_{kNowhere}, y0_{kNowhere};
  std::vector<LocalCell> cells_{};
  std::vector<LocalPlace> places_{};
};

}  // namespace adit::nav
