// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "perception/map/block.hpp"
#include "perception/map/block_hash.hpp"
#include "perception/map/submap_grid.hpp"

namespace adit::perception {

/// Indices of a voxel of an image: it covers [r i, r (i + 1)) along each axis of the map frame, r:
/// resolution, m.
struct VoxelIndex {
  std::int32_t x{}, y{}, z{};
  auto operator<=>(const VoxelIndex&) const = default;
};

/// A map in the map frame, merged from submaps of any number of robots.
///
/// Submaps are added from the oldest to the newest. Each gives every voxel at most one vote; a voxel
/// remembers the last three. The newest vote wins, unless the two before it both say occupied. A voxel of the
/// image takes the vote of the submap's voxel in which its centre lies, so a rotation makes no holes; an
/// occupied voxel in which no centre lies votes for the voxel that contains its own centre. The result
/// depends on the sequence of calls alone.
class VoxelImage {
 public:
  static constexpr std::size_t kMaxBlocks = std::size_t{1} << 18;  ///< 140 MB

  /// Edge of a voxel, m, [0.01, 10].
  explicit VoxelImage(double resolution = 0.2);

  /// Adds a submap in voxels of 0.2 m, or of `edge` m.
  void add(const Pose3& T_map_submap, std::span<const CoarseBlock> blocks, double edge = CoarseBlock::kVoxel);
  /// Adds a submap at its full resolution.
  void add(const Pose3& T_map_submap, const SubmapGrid& grid);
  /// Adds another image, which is in the same frame: prior knowledge, when it is added first.
  void add(const VoxelImage& image);
  /// One vote for a voxel. False when it is out of reach, or there are kMaxBlocks.
  bool set(const VoxelIndex& index, Voxel voxel);
  /// The same for all voxels of a block of 8 x 8 x 8 of the image's voxels.
  bool set_block(const BlockIndex& index, Voxel voxel);

  double resolution() const { return resolution_; }
  bool empty() const;
  std::size_t occupied_count() const { return count(Voxel::occupied); }
  std::size_t free_count() const { return count(Voxel::free); }

  /// `point`: map frame, m.
  Voxel at(const Eigen::Vector3d& point) const;
  Voxel at(const VoxelIndex& index) const;
  /// Centre of a voxel, map frame, m.
  Eigen::Vector3d centre(const VoxelIndex& index) const {
    return (Eigen::Vector3d(index.x, index.y, index.z).array() + 0.5) * resolution_;
  }
  /// Calls `visit` for each known voxel, in an order that depends on their indices alone.
  void for_each(const std::function<void(const VoxelIndex&, Voxel)>& visit) const;
  /// Occupied voxels by rising index.
  std::vector<VoxelIndex> occupied() const;

  /// Smallest and largest indices of known voxels.
  struct Bounds {
    VoxelIndex low{}, high{};
  };
  std::optional<Bounds> bounds() const;

  /// The image as blocks of 0.2 m, by rising index: what is sent of prior knowledge, with the identity as
  /// pose.
  std::vector<CoarseBlock> coarse_blocks() const;

  /// Memory, bytes.
  std::size_t bytes() const { return sizeof *this + hash_.bytes(); }

 private:
  /// The last three votes, two bits each, the newest lowest; kVoted is set while the current submap votes.
  using Votes = std::array<std::uint8_t, 512>;  ///< x + 8 y + 64 z
  static constexpr std::uint8_t kVoted = 0x80;

  template <class Block>
  void add_blocks(const Pose3& T_map_submap, std::span<const Block> blocks, double edge);
  /// Position of a block, which is made when there is none; kNone when that is one too many.
  std::uint32_t block_at(std::uint64_t key);
  void vote(const VoxelIndex& index, Voxel voxel);
  void end_votes();
  std::size_t count(Voxel kind) const;
  static Voxel decide(std::uint8_t votes);
  VoxelIndex index_of(const Eigen::Vector3d& point) const;
  static bool in_reach(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double resolution);

  double resolution_;
  std::uint64_t left_out_{0};  ///< Votes, because there are kMaxBlocks or the place is out of reach.
  BlockHash<Votes> hash_{};
  std::vector<std::uint32_t> voted_{};  ///< Blocks in which the current submap voted, with repetitions.
};

}  // namespace adit::perception
