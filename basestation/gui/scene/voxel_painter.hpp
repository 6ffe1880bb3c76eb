// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "basestation/gui/scene/depth_picture.hpp"
#include "basestation/gui/scene/height_colours.hpp"

namespace adit::gui {

/// How coarse the picture may be.
enum class Detail3 : std::uint8_t {
  fine,    ///< Voxels are merged where they are smaller than 1.5 pixels.
  moving,  ///< Smaller than 3 pixels: while the camera moves.
};

/// A picture of the map, painted by the processor: it needs no GPU, and is the same everywhere.
class VoxelPainter {
 public:
  static constexpr int kMaxSide = DepthPicture::kMaxSide;  ///< Of the picture, pixels.
  static constexpr double kGridPixels =
      180.0;  ///< Longest side of a square of the grid at the target, pixels.

  /// Paints the scene on the ground of the palette. Colours show heights, and the sides of voxels differ in
  /// brightness: floors, walls along x and walls along y. Below the map lies a grid.
  void paint(const VoxelScene& scene, const OrbitCamera& camera, const Slice& slice, const Palette& palette,
             Detail3 detail);
  int width() const { return picture_.width(); }
  int height() const { return picture_.height(); }
  /// Row by row from the top, 0xFFRRGGBB.
  const std::vector<std::uint32_t>& pixels() const { return picture_.pixels(); }
  /// Voxels that were drawn, of any level.
  std::size_t drawn() const { return drawn_; }
  /// Whether the map is at a pixel, not the grid or the ground.
  bool covers(int column, int row) const { return picture_.inverse_depth(column, row) > 0.0F; }
  /// The place of the map at a pixel of the last picture; nothing where there is none.
  std::optional<Point3> pick(double x, double y) const;
  const HeightColours& colours() const { return colours_; }

 private:
  static constexpr std::size_t kAxes = 3;

  void draw_bricks(const VoxelScene& scene, Detail3 detail);
  void draw_brick(const VoxelScene::Brick& brick, int level, double edge);
  void draw_grid(const VoxelScene& scene, const Palette& palette);

  OrbitCamera camera_{};
  Slice slice_{};
  DepthPicture picture_{};
  HeightColours colours_{{}, {}};
  /// By the axis of a side's normal, then from the lowest height to the highest.
  std::array<std::array<std::uint32_t, HeightColours::kColours>, kAxes> shades_{};
  std::array<PlaneDepth, kAxes> planes_{};  ///< Of planes across each axis, 1 m from the eye.
  std::size_t drawn_{};
};

/// Edge of a square of the grid below the map, m.
double grid_step(const OrbitCamera& camera);

}  // namespace adit::gui
