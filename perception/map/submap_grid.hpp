// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "perception/map/block.hpp"
#include "perception/map/block_hash.hpp"

namespace adit::perception {

/// A block at the full resolution, 8 x 8 x 8 voxels: layer z has the bit x + 8 y. `occupied` is a subset of
/// `known`.
struct FineBlock {
  static constexpr int kEdge = 8;
  BlockIndex index{};
  std::array<std::uint64_t, 8> known{};
  std::array<std::uint64_t, 8> occupied{};

  Voxel at(int x, int y, int z) const {
    const std::uint64_t bit = std::uint64_t{1} << (x + 8 * y);
    return (known[z] & bit) == 0 ? Voxel::unknown : (occupied[z] & bit) != 0 ? Voxel::occupied : Voxel::free;
  }
};

/// An occupancy grid in the frame of one submap, filled from lidar scans.
///
/// Blocks of 8 x 8 x 8 voxels in a flat hash; a voxel has OctoMap's log-odds in one byte (log_odds.hpp). A
/// block that was seen free throughout until all its voxels reached the lower bound has no voxels of its own.
/// Each insertion collects the scan's masks per block and applies them once. The number of blocks is bounded:
/// beyond it, places that are new are left out and counted. The result depends on the sequence of calls
/// alone.
///
/// A. Hornung et al., OctoMap (2013): the model; H. Oleynikova et al., Voxblox (2017): rays that end where
/// others went.
class SubmapGrid {
 public:
  static constexpr std::size_t kMaxBlocks = std::size_t{1} << 17;  ///< 70 MB when none is uniform.

  /// `resolution`: edge of a voxel, m, [0.01, 1]. BlockIndex and CoarseBlock count in blocks of 8 voxels and
  /// voxels of twice the edge: 0.8 m and 0.2 m by default.
  explicit SubmapGrid(double resolution = 0.1);
  SubmapGrid(SubmapGrid&&) noexcept = default;
  SubmapGrid& operator=(SubmapGrid&&) noexcept = default;

  /// Inserts one scan. `origin`: sensor, and `points`: returns, submap frame, m. Voxels with a point are hit,
  /// those between the sensor and a point are missed, once a scan. Points farther than `max_range`, m, free
  /// up to there. Points that are not finite are left out.
  void insert(const Eigen::Vector3f& origin, std::span<const Eigen::Vector3f> points, float max_range) {
    insert(origin, points, max_range, {});
  }
  /// The same; points with a nonzero `moving` free the way to them and are not inserted themselves.
  void insert(const Eigen::Vector3f& origin, std::span<const Eigen::Vector3f> points, float max_range,
              std::span<const std::uint8_t> moving);

  Voxel at(const Eigen::Vector3f& point) const;
  double resolution() const { return resolution_; }

  /// Rises by one with each insertion that changed a voxel.
  std::uint32_t revision() const { return revision_; }
  /// Calls `visit` for each block by rising index, with the revision at which its coarse masks changed last.
  void for_each_block(const std::function<void(const BlockIndex&, std::uint32_t revision)>& visit) const;
  /// The block at half the resolution: a voxel is occupied when one of its eight parts is, free when none is
  /// and at least one is free. Nothing without that block.
  std::optional<CoarseBlock> coarse(const BlockIndex& index) const;
  std::optional<FineBlock> fine(const BlockIndex& index) const;
  /// Blocks whose coarse masks changed after that revision, by rising index. One pass over all blocks, 16
  /// bytes each.
  std::vector<BlockIndex> changed_since(std::uint32_t revision) const;

  std::size_t blocks() const { return hash_.size(); }
  /// Memory, bytes.
  std::size_t bytes() const;

 private:
  struct Block {
    std::uint32_t voxels{kUnknownBlock};  ///< Position in the pool, or what all voxels are.
    std::uint32_t revision{0};            ///< Of the last change of the masks.
    std::uint64_t known{}, occupied{};    ///< As CoarseBlock.
  };
  static constexpr std::uint32_t kUnknownBlock = 0xffffffffu, kFreeBlock = 0xfffffffeu;
  using Voxels = std::array<std::uint8_t, 512>;  ///< x + 8 y + 64 z

  /// Blocks of 512 bytes that never move.
  class Pool {
   public:
    std::uint32_t take(std::uint8_t value);
    void give_back(std::uint32_t position) { unused_.push_back(position); }
    Voxels& operator[](std::uint32_t position) { return (*chunks_[position / kChunk])[position % kChunk]; }
    const Voxels& operator[](std::uint32_t position) const {
      return (*chunks_[position / kChunk])[position % kChunk];
    }
    std::size_t bytes() const;

   private:
    static constexpr std::uint32_t kChunk = 32;
    using Chunk = std::array<Voxels, kChunk>;
    std::vector<std::unique_ptr<Chunk>> chunks_{};
    std::vector<std::uint32_t> unused_{};
    std::uint32_t made_{0};
  };

  /// The byte of a voxel, indices over all blocks.
  std::uint8_t value(int x, int y, int z) const;

  double resolution_;
  std::uint32_t revision_{0};
  BlockHash<Block> hash_{};
  Pool pool_{};
};

}  // namespace adit::perception
