// SPDX-License-Identifier: Apache-2.0
#include "sim/world/octomap_file.hpp"

#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "sim/world/read_file.hpp"

namespace adit::sim {
namespace {

constexpr int kDepthLevels = 16;
constexpr int kHalfTree = 1 << (kDepthLevels - 1);
constexpr std::size_t kMaxLeaves = 50'000'000;

/// Two bits for each of a node's eight children, the first child in the lowest bits.
enum Child : unsigned { unknown_child = 0, free_leaf = 1, occupied_leaf = 2, inner = 3 };

class Reader {
 public:
  Reader(std::string_view data, std::vector<OctreeLeaf>& leaves) : data_(data), leaves_(leaves) {}

  /// One inner node and all below it, depth first; false when the data ends early or lies too deep.
  bool node(int x, int y, int z, int size) {
    if (size < 2 || at_ + 2 > data_.size()) return false;
    const unsigned bits = static_cast<unsigned char>(data_[at_]) |
                          static_cast<unsigned>(static_cast<unsigned char>(data_[at_ + 1])) << 8;
    at_ += 2;
    const int half = size / 2;
    for (const bool leaves : {true, false}) {
      for (int child = 0; child < 8; ++child) {
        const unsigned kind = bits >> (2 * child) & 3u;
        if (kind == unknown_child || (kind != inner) != leaves) continue;
        const int cx = x + (child & 1 ? half : 0), cy = y + (child & 2 ? half : 0),
                  cz = z + (child & 4 ? half : 0);
        if (kind == inner) {
          if (!node(cx, cy, cz, half)) return false;
          continue;
        }
        if (leaves_.size() >= kMaxLeaves) return false;
        leaves_.push_back({cx, cy, cz, half, kind == occupied_leaf});
      }
    }
    return true;
  }

 private:
  std::string_view data_;
  std::size_t at_{0};
  std::vector<OctreeLeaf>& leaves_;
};

/// The header's lines up to `data`; moves `content` to the first byte after it.
Result<double> read_header(const std::string& name, std::string_view& content) {
  constexpr std::string_view magic = "# Octomap OcTree binary file";
  if (content.substr(0, magic.size()) != magic)
    return {Reason::syntax,
            name + ": not an OctoMap binary file (.bt); convert an .ot file with octomap's tools"};
  double resolution = 0.0;
  while (true) {
    const std::size_t end = content.find('\n');
    if (end == std::string_view::npos)
      return {Reason::syntax, name + ": the header has no line `data`: the file is cut off or damaged"};
    std::istringstream line{std::string(content.substr(0, end))};
    content.remove_prefix(end + 1);
    std::string key, value;
    line >> key >> value;
    if (key == "data") break;
    if (key == "id" && value != "OcTree")
      return {Reason::not_supported, name + ": holds a tree of type " + value + ", expected OcTree"};
    if (key != "res") continue;
    const auto [rest, failure] = std::from_chars(value.data(), value.data() + value.size(), resolution);
    if (failure != std::errc{} || rest != value.data() + value.size()) resolution = 0.0;
  }
  if (!std::isfinite(resolution) || resolution < 0.001 || resolution > 10.0)
    return {Reason::syntax, name + ": header: expected `res` between 0.001 and 10 m"};
  return resolution;
}

}  // namespace

Result<OctomapFile> read_octomap_file(const std::filesystem::path& file) {
  const Result<std::string> content = read_file(file);
  if (!content) return content.error();
  std::string_view rest = *content;
  const Result<double> resolution = read_header(file.string(), rest);
  if (!resolution) return resolution.error();
  OctomapFile map{*resolution, {}};
  if (!Reader(rest, map.leaves).node(-kHalfTree, -kHalfTree, -kHalfTree, 2 * kHalfTree))
    return {Reason::syntax,
            file.string() + ": the tree is cut off or damaged; run ./run setup to fetch it anew"};
  if (map.leaves.empty()) return {Reason::syntax, file.string() + ": the map is empty"};
  return map;
}

}  // namespace adit::sim
