// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/geometry/round_down.hpp"

namespace adit::nav {

/// Class of a cell of the ground for one platform.
enum class CellClass : std::uint8_t {
  unknown,   ///< No scan showed the ground or an obstacle there.
  ground,    ///< Passable; LocalCell::cost rises with its roughness.
  slope,     ///< Steep ground; impassable where the cost is LocalCell::kImpassable.
  step,      ///< An edge; impassable where the cost is LocalCell::kImpassable.
  obstacle,  ///< Something stands or hangs there that the body cannot pass.
  drop,      ///< The ground is missing.
  mover,     ///< As `obstacle`, but it moves: it is no part of a map that lasts.
};
inline constexpr std::size_t kCellClasses = 7;

/// A cell of a LocalMap. Heights are those of the odometry frame, m.
struct LocalCell {
  static constexpr std::uint8_t kImpassable = 255;
  static constexpr float kAsideUnit = 0.05f / 250;  ///< m
  static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

  float low{kNone};                  ///< Of the ground, measured or inherited from its neighbours; NaN: none.
  float high{kNone};                 ///< Of the highest return from an obstacle; NaN: none.
  CellClass kind{};                  ///< See CellClass.
  std::uint8_t cost{};               ///< 1/254 of the platform's limit; kImpassable: no way.
  std::uint8_t drop_probability{};   ///< That the ground is missing, 1/255; 0: less than a half.
  bool measured : 1 {};              ///< `low` was measured.
  bool fresh : 1 {};                 ///< `low` was measured by the newest scan.
  bool peer : 1 {};                  ///< Within the outline of another robot of the team.
  std::int8_t aside_x{}, aside_y{};  ///< Surface of the obstacle from the cell's centre, kAsideUnit.

  bool impassable() const { return cost == kImpassable; }
};

/// A place that costs something to cross, odometry frame.
struct LocalPlace {
  float x{}, y{};    ///< Its exact position, m.
  float cost{1.0f};  ///< (0, 1]; 1: impassable.
  float age{};       ///< Time since an obstacle was first seen there, s; 0 for other classes.
  CellClass kind{};
};

/// The scan of which a LocalMap is the newest state.
struct LocalMapScan {
  double stamp_s{-std::numeric_limits<double>::infinity()};  ///< Its time, s.
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

  const LocalMapScan& scan() const { return scan_; }
  bool inside(int ix, int iy) const {
    return static_cast<unsigned>(ix - x0_) < kSide && static_cast<unsigned>(iy - y0_) < kSide;
  }
  /// The cell with these coordinates, which must be inside.
  const LocalCell& at(int ix, int iy) const { return cells_[index(ix, iy)]; }
  /// The cell of a place, m; null outside of the map.
  const LocalCell* find(float x, float y) const {
    const int ix = cell(x), iy = cell(y);
    return inside(ix, iy) ? &at(ix, iy) : nullptr;
  }
  static int cell(float metres) { return round_down(metres * (1.0f / kCell)); }
  static float centre(int i) { return (static_cast<float>(i) + 0.5f) * kCell; }
  /// Calls `visit(ix, iy, cell)` for each cell whose centre is at most `reach` (m) from the robot.
  template <class Visit>
  void visit(float reach, Visit&& visit) const {
    const auto bx = static_cast<float>(scan_.body.position.x()),
               by = static_cast<float>(scan_.body.position.y());
    for (int iy = y0_; iy < y0_ + kSide; ++iy)
      for (int ix = x0_; ix < x0_ + kSide; ++ix)
        if (const float dx = centre(ix) - bx, dy = centre(iy) - by; dx * dx + dy * dy <= reach * reach)
          visit(ix, iy, at(ix, iy));
  }
  /// Obstacles, drops, steep and rough ground, and steps. Several layers of one place have one entry each.
  std::span<const LocalPlace> places() const { return places_; }

 private:
  friend class LocalMapBuilder;
  static std::size_t index(int ix, int iy) {
    return static_cast<std::size_t>((iy & (kSide - 1)) * kSide + (ix & (kSide - 1)));
  }

  LocalMapScan scan_{};
  /// The cell with the smallest coordinates; nothing is inside of a map that was not made.
  int x0_{std::numeric_limits<int>::min() / 2}, y0_{x0_};
  std::vector<LocalCell> cells_{};
  std::vector<LocalPlace> places_{};
};

}  // namespace adit::nav
