// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "perception/map/block.hpp"
#include "perception/types/submap_key.hpp"

namespace adit::perception {

/// Sums by which two sides find out where their copies of one robot's map differ, without sending it. Blocks
/// are sorted by the column of 6.4 x 6.4 m in their submap, and columns into kParts - 1 parts; the last sum
/// is that of the submaps' poses. Sums do not depend on the order of additions, nor on revisions of blocks,
/// as a block that two sides received in different pieces has different revisions.
struct MapDigest {
  static constexpr std::size_t kParts = 33;
  static constexpr std::size_t kPoses = kParts - 1;

  std::array<std::uint32_t, kParts> sums{};

  /// The part of a block, [0, kPoses).
  static std::size_t part_of(const BlockIndex& index);
  static std::uint32_t hash(const SubmapKey& key, const CoarseBlock& block);
  static std::uint32_t hash(const SubmapKey& key, std::uint32_t pose_revision);

  void add(const SubmapKey& key, const CoarseBlock& block) { sums[part_of(block.index)] += hash(key, block); }
  void remove(const SubmapKey& key, const CoarseBlock& block) {
    sums[part_of(block.index)] -= hash(key, block);
  }
  void add(const SubmapKey& key, std::uint32_t pose_revision) { sums[kPoses] += hash(key, pose_revision); }
  void remove(const SubmapKey& key, std::uint32_t pose_revision) { sums[kPoses] -= hash(key, pose_revision); }
  bool operator==(const MapDigest&) const = default;
};

}  // namespace adit::perception
