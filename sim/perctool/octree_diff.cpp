// SPDX-License-Identifier: Apache-2.0
#include "sim/perctool/octree_diff.hpp"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <vector>

namespace adit::sim::perctool {
namespace {

constexpr int kOrigin = 1 << 15;  // cells: key of cell 0

/// A leaf as an interval of Morton codes: a cube that an octree can have covers all codes from its corner's
/// on.
struct Interval {
  std::uint64_t begin{}, end{};
  bool occupied{};
};

std::uint64_t spread(int key) {
  std::uint64_t v = static_cast<std::uint64_t>(static_cast<std::uint32_t>(key)) & 0xffff;
  v = (v | v << 16) & 0x0000ff0000ffULL;
  v = (v | v << 8) & 0x00f00f00f00fULL;
  v = (v | v << 4) & 0x0c30c30c30c3ULL;
  return (v | v << 2) & 0x249249249249ULL;
}

std::vector<Interval> intervals(const OctomapFile& map) {
  std::vector<Interval> out;
  out.reserve(map.leaves.size());
  for (const OctreeLeaf& leaf : map.leaves) {
    const std::uint64_t begin =
        spread(leaf.x + kOrigin) | spread(leaf.y + kOrigin) << 1 | spread(leaf.z + kOrigin) << 2;
    const auto edge = static_cast<std::uint64_t>(leaf.size);
    out.push_back({begin, begin + edge * edge * edge, leaf.occupied});
  }
  std::sort(out.begin(), out.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  return out;
}

Result<OctomapFile> read_ot(const std::filesystem::path& file) {
  const Error broken{Reason::syntax, file.string() + ": liboctomap cannot read it as an OcTree"};
  if (!std::ifstream(file)) return {Reason::cannot_read, file.string() + ": cannot be read"};
  // The library throws on what it cannot allocate.
  try {
    const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(file.string()));
    const auto* tree = dynamic_cast<const octomap::OcTree*>(read.get());
    if (!tree) return broken;
    OctomapFile out{tree->getResolution(), {}};
    for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
      const octomap::OcTreeKey key = leaf.getIndexKey();
      const int size = 1 << (tree->getTreeDepth() - leaf.getDepth());
      out.leaves.push_back(
          {key[0] - kOrigin, key[1] - kOrigin, key[2] - kOrigin, size, tree->isNodeOccupied(*leaf)});
    }
    return out;
  } catch (const std::exception&) {
    return broken;
  }
}

}  // namespace

Result<OctomapFile> read_map(const std::filesystem::path& file) {
  if (file.extension() == ".bt") return read_octomap_file(file);
  if (file.extension() == ".ot") return read_ot(file);
  return {Reason::not_supported, file.string() + ": expected a .bt or .ot file"};
}

Result<OctreeDiff> compare(const OctomapFile& a, const OctomapFile& b) {
  if (!(std::abs(a.resolution - b.resolution) < 1e-9))
    return {Reason::bad_argument, "the maps have different resolutions"};
  const std::vector<Interval> as = intervals(a), bs = intervals(b);
  OctreeDiff out;
  std::uint64_t at = 0;
  std::size_t i = 0, j = 0;
  while (i < as.size() || j < bs.size()) {
    constexpr std::uint64_t none = ~std::uint64_t{0};
    const std::uint64_t begin_a = i < as.size() ? std::max(at, as[i].begin) : none;
    const std::uint64_t begin_b = j < bs.size() ? std::max(at, bs[j].begin) : none;
    const std::uint64_t begin = std::min(begin_a, begin_b);
    const bool in_a = begin_a == begin, in_b = begin_b == begin;
    std::uint64_t end = std::max(begin_a, begin_b);  // Where the other one begins.
    if (in_a) end = in_b ? std::min(as[i].end, bs[j].end) : std::min(end, as[i].end);
    if (!in_a) end = std::min(end, bs[j].end);
    const std::uint64_t cells = end - begin;
    if (in_a && in_b)
      (as[i].occupied == bs[j].occupied ? out.equal : out.different) += cells;
    else
      (in_a ? out.missing : out.more) += cells;
    at = end;
    if (i < as.size() && as[i].end <= at) ++i;
    if (j < bs.size() && bs[j].end <= at) ++j;
  }
  return out;
}

}  // namespace adit::sim::perctool
