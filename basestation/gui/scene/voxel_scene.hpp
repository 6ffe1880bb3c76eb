// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "basestation/gui/scene/orbit_camera.hpp"
#include "basestation/model/map_tiles.hpp"

namespace adit::gui {

/// The occupied voxels of the map for drawing: in bricks, each at several levels of detail. At level k a
/// voxel is occupied where any of the 2 x 2 x 2 voxels of the level below is.
class VoxelScene {
 public:
  static constexpr int kLevels = 4;
  static constexpr int kSide = 32;  ///< Columns of voxels along each side of a brick.

  /// The sides of a voxel that may be seen, as bits: towards low and high x, y and z.
  enum Side : std::uint16_t { low_x = 1, high_x = 2, low_y = 4, high_y = 8, bottom = 16, top = 32, all = 63 };
  /// A voxel of a brick, in voxels of its level from the brick's corner; z from the map's origin.
  struct Voxel {
    std::uint16_t x : 5 {}, y : 5 {};
    std::uint16_t sides : 6 {};  ///< Those without a neighbour in the same tile.
    std::int16_t z{};
    auto operator<=>(const Voxel&) const = default;
  };
  struct Brick {
    double x{}, y{};       ///< Its corner, map frame, m.
    double low{}, high{};  ///< Heights of its lowest and its highest voxel, m.
    std::array<std::vector<Voxel>, kLevels> levels{};
    std::array<int, 2> first{}, last{};  ///< Columns and rows of its outermost voxels of level 0.
    std::map<int, int> heights{};        ///< Number of voxels of level 0, by z.
  };

  /// Takes a newer map; only tiles that changed are read again.
  void show(const station::TileMap& map);
  double edge() const { return edge_; }  ///< Of a voxel of level 0, m.
  std::size_t voxels() const { return voxels_; }
  bool empty() const { return voxels_ == 0; }
  /// All bricks.
  std::vector<const Brick*> bricks() const;
  /// Corners of the box around all voxels, map frame, m; of no meaning while it is empty.
  Point3 low() const { return low_; }
  Point3 high() const { return high_; }
  /// Number of voxels by z.
  const std::map<int, int>& heights() const { return heights_; }
  /// Corners of the boxes around the voxels of each brick between two heights, map frame, m.
  std::vector<Point3> corners(double from, double to) const;

 private:
  struct Tile {
    std::shared_ptr<const station::MapTile> tile{};
    std::vector<Brick> bricks{};
  };
  void measure();

  std::map<std::pair<int, int>, Tile> tiles_{};
  double edge_{0.2};
  std::size_t voxels_{0};
  Point3 low_{}, high_{};
  std::map<int, int> heights_{};
};

}  // namespace adit::gui
