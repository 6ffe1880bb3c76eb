// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace adit::sim {

/// Rays under way side by side, each array with one element a ray, in a grid that is mirrored so that all of
/// them head towards +x and +y.
struct VoxelLanes {
  static constexpr int kMax = 16;  ///< Rays at most.
  static constexpr int kWide = 4;  ///< Rays of a group; the last group's other rays hold copies of any ray.
  static constexpr double kFar = 1e30;  ///< For an axis that a ray does not move along.
  int count{0};

  /// The grid. Strides: three bytes a cell, width and depth of its open rectangle and the layers that it
  /// reaches. One more byte behind them must be readable.
  const std::uint8_t* strides{};
  static constexpr int kBytes = 3;
  const double* levels{};     ///< Heights of the layers' borders, m.
  double layers_per_metre{};  ///< 0: layers of different thickness.
  int nx{}, ny{}, layers{};
  double z{};          ///< Height of the start, m.
  double max_range{};  ///< m

  double gx{}, gy{};           ///< Start of all rays, in columns.
  int i{}, j{}, k{};           ///< Its cell.
  double resolution{};         ///< Edge of a column, m.
  double columns_per_metre{};  ///< Its inverse.

  /// Directions: along x and y without their sign, along z with it.
  alignas(32) double dx[kMax], dy[kMax], dz[kMax];
  alignas(32) double t[kMax];  ///< The distance of the end, m.
};

/// How a ray of VoxelLanes ended.
enum class LaneEnd : std::uint8_t {
  met,      ///< It met a solid cell, or floor or ceiling, at `t`.
  far,      ///< It met nothing within the range.
  outside,  ///< It left the grid through a side at `t`.
};

/// Whether this processor has the instructions that cast_lanes() needs (AVX2).
bool has_voxel_lanes();
/// Follows up to four rays at once in each of four groups, with the same operations in the same order as
/// VoxelGrid::cast(), so that ranges are equal bit by bit. The ends are those of the first `count` rays.
void cast_lanes(VoxelLanes& lanes, LaneEnd* ends);

}  // namespace adit::sim
