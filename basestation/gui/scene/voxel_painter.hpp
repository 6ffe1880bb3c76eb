// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "basestation/gui/scene/colours.hpp"
#include "basestation/gui/scene/voxel_scene.hpp"

namespace adit::gui {

/// The part of the map that is shown, by height, m. What is above it would hide a floor: ceilings.
struct Slice {
  double low{-1e9}, high{1e9};
  bool operator==(const Slice&) const = default;
};

/// How coarse the picture may be.
enum class Detail3 : std::uint8_t {
  fine,    ///< Voxels are merged where they are smaller than 1.5 pixels.
  moving,  ///< Smaller than 3 pixels: while the camera moves.
};

/// A picture of the map, painted by the processor: it needs no GPU, and is the same everywhere.
class VoxelPainter {
 public:
  static constexpr int kMaxSide = 8192;  ///< Of the picture, pixels.

  /// Paints the scene on the ground of the palette. Voxels are brighter the higher they are in the slice, and
  /// darker beside nearer ones ("eye-dome lighting", Boucheny 2009), so that edges and depth can be seen.
  void paint(const VoxelScene& scene, const OrbitCamera& camera, const Slice& slice, const Palette& palette,
             Detail3 detail);
  int width() const { return width_; }
  int height() const { return height_; }
  /// Row by row from the top, 0xFFRRGGBB.
  const std::vector<std::uint32_t>& pixels() const { return pixels_; }
  /// Voxels that were drawn, of any level.
  std::size_t drawn() const { return drawn_; }
  /// The place of the map at a pixel of the last picture; nothing where there is none.
  std::optional<Point3> pick(double x, double y) const;

 private:
  void draw_brick(const VoxelScene::Brick& brick, int level, double edge);
  void light(Rgb ground);

  OrbitCamera camera_{};
  Slice slice_{};
  int width_{}, height_{};
  double lowest_{}, per_metre_{};  ///< Of the table of colours.
  std::vector<std::uint32_t> colours_{}, pixels_{};
  std::vector<float> depth_{};  ///< In m; kFar where nothing is.
  std::size_t drawn_{};
};

}  // namespace adit::gui
