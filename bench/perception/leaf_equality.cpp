// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/leaf_equality.hpp"

namespace adit::bench {
namespace {

using perception::BlockIndex;
using perception::FineBlock;
using perception::Voxel;

/// Keys of OctoMap count from here, voxels.
constexpr int kHalfTree = 32768;

Voxel leaf(const octomap::OcTree& tree, int x, int y, int z) {
  const octomap::OcTreeNode* node = tree.search(
      octomap::OcTreeKey(static_cast<std::uint16_t>(x + kHalfTree), static_cast<std::uint16_t>(y + kHalfTree),
                         static_cast<std::uint16_t>(z + kHalfTree)));
  if (node == nullptr) return Voxel::unknown;
  return tree.isNodeOccupied(node) ? Voxel::occupied : Voxel::free;
}

void count_theirs(const perception::SubmapGrid& ours, const octomap::OcTree& theirs, LeafEquality& out) {
  for (auto it = theirs.begin_leafs(); it != theirs.end_leafs(); ++it) {
    const int edge = 1 << (theirs.getTreeDepth() - it.getDepth());
    const octomap::OcTreeKey key = it.getIndexKey();
    const Voxel kind = theirs.isNodeOccupied(*it) ? Voxel::occupied : Voxel::free;
    for (int i = 0; i < edge * edge * edge; ++i) {
      const int x = key[0] + i % edge, y = key[1] + i / edge % edge, z = key[2] + i / edge / edge;
      const Eigen::Vector3f centre =
          (Eigen::Vector3d(x, y, z).array() - kHalfTree + 0.5).matrix().cast<float>() *
          static_cast<float>(ours.resolution());
      const bool same = ours.at(centre) == kind;
      ++out.theirs;
      out.theirs_equal += same;
      out.theirs_occupied += kind == Voxel::occupied;
      out.theirs_occupied_equal += kind == Voxel::occupied && same;
    }
  }
}

}  // namespace

LeafEquality compare(const perception::SubmapGrid& ours, const octomap::OcTree& theirs) {
  LeafEquality out;
  count_theirs(ours, theirs, out);
  ours.for_each_block([&](const BlockIndex& index, std::uint32_t) {
    const FineBlock block = *ours.fine(index);
    for (int i = 0; i < 512; ++i) {
      const int x = i % 8, y = i / 8 % 8, z = i / 64;
      const Voxel kind = block.at(x, y, z);
      if (kind == Voxel::unknown) continue;
      ++out.ours;
      out.ours_equal += leaf(theirs, 8 * index.x + x, 8 * index.y + y, 8 * index.z + z) == kind;
    }
  });
  return out;
}

}  // namespace adit::bench
