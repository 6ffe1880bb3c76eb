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

  /// A voxel of a brick, in voxels of its level from the brick's corner; z from the map's origin.
  struct Voxel {
    std::uint8_t x{}, y{};
    std::int16_t z{};
    auto operator<=>(const Voxel&) const = default;
  };
  struct Brick {
    double x{}, y{};       ///< Its corner, map frame, m.
    double low{}, high{};  ///< Heights of its lowest and its highest voxel, m.
    std::array<std::vector<Voxel>, kLevels> levels{};
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
};

}  // namespace adit::gui
