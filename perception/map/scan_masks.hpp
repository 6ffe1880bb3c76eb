// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "perception/map/block.hpp"

namespace adit::perception {

/// A block of 8 x 8 x 8 voxels as one scan shows it. Layer z has the bit x + 8 y.
struct ScanBlock {
  BlockIndex index{};
  std::array<std::uint64_t, 8> free{};  ///< A ray passed; the voxels in `hit` count as hit.
  std::array<std::uint64_t, 8> hit{};   ///< A ray ended.
};

/// The rays of one scan as bit masks per block: what is free and what is hit, each voxel once. Memory is
/// reused from scan to scan.
class ScanMasks {
 public:
  /// The rays of one scan.
  struct Rays {
    Eigen::Vector3f origin{Eigen::Vector3f::Zero()};  ///< m
    std::span<const Eigen::Vector3f> points{};        ///< In the origin's frame, m.
    std::span<const std::uint8_t> moving{};           ///< Empty, or 1 for points that free and never occupy.
    float max_range{};                                ///< Rays of farther points free that far, m.
  };
  /// Whether a voxel (indices over all blocks) is occupied in the map before this scan.
  using OccupiedBefore = std::function<bool(int x, int y, int z)>;

  /// Ranges beyond are cut off, voxels: the blocks in reach are an array.
  static constexpr float kMaxRange = 640.0f;
  /// Near the sensor, where thousands of rays share their voxels, a ray ends after so many in a row that
  /// others have freed. Near: at most so many voxels are left to go. Farther away, rays that share voxels
  /// part again: with 40, 0.3 % of the free voxels of a building are lost, with 60, 0.8 % (bench_map_insert).
  static constexpr int kSharedVoxels = 2;
  static constexpr int kNearSteps = 24;

  /// Walks the rays from their ends to the origin. Voxels have an edge of `resolution` m. Points that are not
  /// finite, or beyond BlockIndex::kLimit, are left out.
  void trace(const Rays& rays, double resolution, const OccupiedBefore& occupied_before);

  std::span<const ScanBlock> blocks() const { return {blocks_.data(), used_}; }

 private:
  struct End {
    Eigen::Vector3f at;  ///< Voxels, from the corner of the table.
    bool hit;
  };
  bool collect(const Rays& rays, double resolution);
  void walk(const End& end, bool grazing);
  bool is_grazing(const End& end, const OccupiedBefore& occupied_before) const;
  ScanBlock& block(std::size_t cell);
  std::size_t cell_of(const Eigen::Vector3i& voxel) const {
    return static_cast<std::size_t>((voxel.x() >> 3) +
                                    size_.x() * ((voxel.y() >> 3) + size_.y() * (voxel.z() >> 3)));
  }

  std::vector<End> ends_{};
  std::vector<std::uint32_t> table_{};  ///< 0, or 1 + position in blocks_.
  std::vector<std::size_t> touched_{};  ///< Cells of the table that are not 0.
  std::vector<ScanBlock> blocks_{};
  std::size_t used_{0};
  Eigen::Vector3i base_{Eigen::Vector3i::Zero()};    ///< Block at the table's corner.
  Eigen::Vector3i size_{Eigen::Vector3i::Zero()};    ///< Of the table, blocks.
  Eigen::Vector3f origin_{Eigen::Vector3f::Zero()};  ///< Voxels, from the table's corner.
};

}  // namespace adit::perception
