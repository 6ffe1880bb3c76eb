// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <ostream>
#include <string>

#include "perception/map/export/octree_file.hpp"

namespace adit::perception {
namespace {

constexpr int kTreeDepth = 16, kHalfKeys = 1 << (kTreeDepth - 1);
constexpr float kFreeLogOdds = -2.0f, kOccupiedLogOdds = 3.5f;  ///< OctoMap's bounds.
enum ChildKind : unsigned { no_child = 0, free_child = 1, occupied_child = 2, inner_child = 3 };

std::uint64_t spread_bits(std::uint64_t v) {
  std::uint64_t out = 0;
  for (int bit = 0; bit < kTreeDepth; ++bit) out |= (v >> bit & 1) << (3 * bit);
  return out;
}

/// An octree over sorted Morton codes: a node is a range of them, and no node is stored.
class TreeWriter {
 public:
  static Result<TreeWriter> create(const VoxelImage& image) {
    TreeWriter out;
    std::vector<std::pair<std::uint64_t, bool>> leaves;
    bool within = true;
    image.for_each([&](const VoxelIndex& v, Voxel voxel) {
      const auto key = [&](int i) {
        within = within && i >= -kHalfKeys && i < kHalfKeys;
        return spread_bits(static_cast<std::uint64_t>(i + kHalfKeys) & 0xffff);
      };
      leaves.push_back({key(v.x) | key(v.y) << 1 | key(v.z) << 2, voxel == Voxel::occupied});
    });
    if (leaves.empty()) return {Reason::map_empty, "there is no map yet"};
    if (!within)
      return {Reason::out_of_range, "the map reaches farther than OctoMap's files: save it coarser"};
    std::sort(leaves.begin(), leaves.end());
    out.occupied_before_.push_back(0);
    for (const auto& [code, occupied] : leaves) {
      out.codes_.push_back(code);
      out.occupied_before_.push_back(out.occupied_before_.back() + (occupied ? 1 : 0));
    }
    return out;
  }

  void binary() { binary_node(0, codes_.size(), kTreeDepth); }
  void full() { full_node(0, codes_.size(), kTreeDepth); }
  const std::string& data() const { return data_; }
  std::size_t nodes() const { return nodes_; }

 private:
  /// First code at or after `begin` that belongs to a later child than `child`.
  std::size_t end_of_child(std::size_t begin, std::size_t end, int level, unsigned child) const {
    const int shift = 3 * (level - 1);
    return static_cast<std::size_t>(
        std::partition_point(codes_.begin() + static_cast<std::ptrdiff_t>(begin),
                             codes_.begin() + static_cast<std::ptrdiff_t>(end),
                             [&](std::uint64_t code) { return (code >> shift & 7) <= child; }) -
        codes_.begin());
  }
  ChildKind kind(std::size_t begin, std::size_t end, int level) const {
    if (begin == end) return no_child;
    const std::size_t occupied = occupied_before_[end] - occupied_before_[begin];
    const bool full = end - begin == std::size_t{1} << 3 * level;
    if (full && occupied == 0) return free_child;
    return full && occupied == end - begin ? occupied_child : inner_child;
  }

  void binary_node(std::size_t begin, std::size_t end, int level) {
    ++nodes_;
    std::array<std::size_t, 9> at{begin};
    unsigned bits = 0;
    for (unsigned child = 0; child < 8; ++child) {
      at[child + 1] = end_of_child(at[child], end, level, child);
      const ChildKind k = kind(at[child], at[child + 1], level - 1);
      bits |= k << (2 * child);
      if (k == free_child || k == occupied_child) ++nodes_;
    }
    data_.push_back(static_cast<char>(bits & 0xff));
    data_.push_back(static_cast<char>(bits >> 8));
    for (unsigned child = 0; child < 8; ++child)
      if ((bits >> (2 * child) & 3) == inner_child) binary_node(at[child], at[child + 1], level - 1);
  }

  void full_node(std::size_t begin, std::size_t end, int level) {
    ++nodes_;
    // An inner node has the largest value of its children.
    const float value = occupied_before_[end] > occupied_before_[begin] ? kOccupiedLogOdds : kFreeLogOdds;
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    data_.append(bytes, sizeof value);
    const std::size_t children_at = data_.size();
    data_.push_back(0);
    if (kind(begin, end, level) != inner_child) return;
    unsigned children = 0;
    for (unsigned child = 0; child < 8; ++child) {
      const std::size_t next = end_of_child(begin, end, level, child);
      if (next != begin) {
        children |= 1u << child;
        full_node(begin, next, level - 1);
      }
      begin = next;
    }
    data_[children_at] = static_cast<char>(children);
  }

  std::vector<std::uint64_t> codes_{};
  std::vector<std::size_t> occupied_before_{};
  std::string data_{};
  std::size_t nodes_{0};
};

Result<void> write_tree(const char* what, const VoxelImage& image, const TreeWriter& tree, std::ostream& to) {
  to << what
     << "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid OcTree\nsize "
     << tree.nodes() << "\nres " << image.resolution() << "\ndata\n";
  to.write(tree.data().data(), static_cast<std::streamsize>(tree.data().size()));
  if (!to) return {Reason::cannot_write, "the map cannot be written"};
  return {};
}

}  // namespace

Result<void> write_bt(const VoxelImage& image, std::ostream& to) {
  auto tree = TreeWriter::create(image);
  if (!tree) return tree.error();
  tree->binary();
  return write_tree("# Octomap OcTree binary file", image, *tree, to);
}

Result<void> write_ot(const VoxelImage& image, std::ostream& to) {
  auto tree = TreeWriter::create(image);
  if (!tree) return tree.error();
  tree->full();
  return write_tree("# Octomap OcTree file", image, *tree, to);
}

}  // namespace adit::perception
