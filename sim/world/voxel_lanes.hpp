// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace adit::sim {

/// Rays under way side by side, each array with one element a ray, in a grid that is mirrored so that all of
/// them head towards +x and +y.
struct VoxelLanes {
  static constexpr int kMax = 16;  ///< Rays at most.
  static constexpr int kWide = 4;  ///< Rays of a group; the last group's other rays hold copies of any ray.
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

  alignas(32) double gx[kMax], gy[kMax];            ///< Start, in columns.
  alignas(32) double sx[kMax], sy[kMax];            ///< Columns per metre, >= 0.
  alignas(32) double ax[kMax], ay[kMax], az[kMax];  ///< Metres per column, metres per metre of height.
  alignas(32) double t[kMax];                       ///< Distance so far, then that of the end, m.
  alignas(16) std::int32_t i[kMax], j[kMax], k[kMax];
  alignas(16) std::int32_t up[kMax];  ///< 1 upwards, 0 downwards.
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
