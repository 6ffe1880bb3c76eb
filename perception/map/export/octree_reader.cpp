// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>

#include "perception/map/export/octree_file.hpp"

namespace adit::perception {
namespace {

constexpr int kLevels = 16, kHalfEdge = 1 << (kLevels - 1);
/// Voxels of leaves that are larger than one voxel are counted, so that one leaf cannot stand for a mountain.
constexpr std::size_t kMaxVoxels = VoxelImage::kMaxBlocks * 512;

enum class Failure { none, cut_off, too_large };

/// Reads nodes depth first into an image.
class NodeReader {
 public:
  NodeReader(std::string_view data, double resolution) : data_(data), image_(resolution) {}

  Failure binary(int x, int y, int z, int size) {
    if (size < 2 || data_.size() - at_ < 2) return Failure::cut_off;
    const unsigned bits = byte(at_) | byte(at_ + 1) << 8;
    at_ += 2;
    const int half = size / 2;
    for (int child = 0; child < 8; ++child) {
      const unsigned kind = bits >> (2 * child) & 3;
      if (kind != 1 && kind != 2) continue;
      const Failure failure =
          leaf(x + (child & 1 ? half : 0), y + (child & 2 ? half : 0), z + (child & 4 ? half : 0), half,
               kind == 2 ? Voxel::occupied : Voxel::free);
      if (failure != Failure::none) return failure;
    }
    for (int child = 0; child < 8; ++child) {
      if ((bits >> (2 * child) & 3) != 3) continue;
      const Failure failure =
          binary(x + (child & 1 ? half : 0), y + (child & 2 ? half : 0), z + (child & 4 ? half : 0), half);
      if (failure != Failure::none) return failure;
    }
    return Failure::none;
  }

  Failure full(int x, int y, int z, int size) {
    if (data_.size() - at_ < 5) return Failure::cut_off;
    float value;
    std::memcpy(&value, data_.data() + at_, sizeof value);
    const unsigned children = byte(at_ + 4);
    at_ += 5;
    if (!std::isfinite(value)) return Failure::cut_off;
    if (children == 0) return leaf(x, y, z, size, value >= 0.0f ? Voxel::occupied : Voxel::free);
    if (size < 2) return Failure::cut_off;
    const int half = size / 2;
    for (int child = 0; child < 8; ++child) {
      if ((children >> child & 1) == 0) continue;
      const Failure failure =
          full(x + (child & 1 ? half : 0), y + (child & 2 ? half : 0), z + (child & 4 ? half : 0), half);
      if (failure != Failure::none) return failure;
    }
    return Failure::none;
  }

  bool at_end() const { return at_ == data_.size(); }
  VoxelImage& image() { return image_; }

 private:
  unsigned byte(std::size_t at) const { return static_cast<unsigned char>(data_[at]); }

  Failure leaf(int x, int y, int z, int size, Voxel voxel) {
    const std::size_t count =
        static_cast<std::size_t>(size) * static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
    if (count > kMaxVoxels - voxels_) return Failure::too_large;
    voxels_ += count;
    // Larger leaves are made of whole blocks.
    const bool blocks = size >= 8;
    const int n = blocks ? size / 8 : size;
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          if (!(blocks ? image_.set_block({x / 8 + i, y / 8 + j, z / 8 + k}, voxel)
                       : image_.set({x + i, y + j, z + k}, voxel)))
            return Failure::too_large;
    return Failure::none;
  }

  std::string_view data_;
  VoxelImage image_;
  std::size_t at_{0}, voxels_{0};
};

/// The header's lines up to `data`; moves `content` behind it. The edge of a voxel, m.
Result<double> read_tree_header(std::string_view& content) {
  double resolution = 0.0;
  while (true) {
    const std::size_t end = content.find('\n');
    if (end == std::string_view::npos)
      return {Reason::syntax, "the header has no line `data`: cut off or damaged"};
    std::string_view line = content.substr(0, end);
    content.remove_prefix(end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const std::size_t space = line.find(' ');
    const std::string_view key = line.substr(0, space);
    const std::string_view value =
        space == std::string_view::npos ? std::string_view{} : line.substr(space + 1);
    if (key == "data") break;
    if (key == "id" && value != "OcTree")
      return {Reason::not_supported,
              "a tree of type " + std::string(value.substr(0, 40)) + ", expected OcTree"};
    if (key != "res") continue;
    const auto [rest, failure] = std::from_chars(value.data(), value.data() + value.size(), resolution);
    if (failure != std::errc{} || rest != value.data() + value.size()) resolution = 0.0;
  }
  if (!std::isfinite(resolution) || resolution < 0.01 || resolution > 10.0)
    return {Reason::syntax, "the header: expected `res` between 0.01 and 10 m"};
  return resolution;
}

}  // namespace

Result<VoxelImage> read_octree(std::string_view content) {
  constexpr std::string_view binary = "# Octomap OcTree binary file", full = "# Octomap OcTree file";
  const bool is_binary = content.substr(0, binary.size()) == binary;
  if (!is_binary && content.substr(0, full.size()) != full)
    return {Reason::syntax, "not a file of OctoMap (.bt or .ot)"};
  const Result<double> resolution = read_tree_header(content);
  if (!resolution) return resolution.error();
  if (content.empty()) return {Reason::map_empty, "the map in the file is empty"};
  NodeReader reader(content, *resolution);
  const Failure failure = is_binary ? reader.binary(-kHalfEdge, -kHalfEdge, -kHalfEdge, 2 * kHalfEdge)
                                    : reader.full(-kHalfEdge, -kHalfEdge, -kHalfEdge, 2 * kHalfEdge);
  if (failure == Failure::too_large) return {Reason::not_supported, "the map in the file is too large"};
  if (failure != Failure::none || !reader.at_end()) return {Reason::syntax, "the tree is cut off or damaged"};
  if (reader.image().empty()) return {Reason::map_empty, "the map in the file is empty"};
  return std::move(reader.image());
}

}  // namespace adit::perception
