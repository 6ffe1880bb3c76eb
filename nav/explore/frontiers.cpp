// SPDX-License-Identifier: Apache-2.0
#include "nav/explore/frontiers.hpp"

#include <algorithm>
#include <array>
#include <unordered_set>
#include <utility>

namespace adit::nav {
namespace {

constexpr std::array<std::pair<int, int>, 4> kBeside{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
constexpr int kDeep = 3;  // Depth of the unseen space that counts behind a frontier, voxels.

/// Part of a column: its free voxels that have an unseen one beside them.
struct Edge {
  int x, y, band;
  std::uint16_t free;                   ///< The free voxels.
  std::array<std::uint16_t, 4> unseen;  ///< By side.
};

struct ColumnKey {
  int x, y, band;
  bool operator==(const ColumnKey&) const = default;
};
struct Hash {
  std::size_t operator()(const ColumnKey& k) const {
    return (static_cast<std::size_t>(static_cast<std::uint32_t>(k.x)) * 73'856'093u) ^
           (static_cast<std::size_t>(static_cast<std::uint32_t>(k.y)) * 19'349'663u) ^
           static_cast<std::size_t>(k.band);
  }
  std::size_t operator()(const CoverageVoxel& v) const { return (*this)(ColumnKey{v.x, v.y, v.z}); }
};

std::vector<Edge> find_edges(const CoverageMap& map) {
  std::vector<Edge> edges;
  for (const CoverageMap::Tile& tile : map.tiles())
    for (int c = 0; c < CoverageMap::kSide * CoverageMap::kSide; ++c) {
      const CoverageMap::Column& column = tile.columns[c];
      const auto open = static_cast<std::uint16_t>(column.free & ~column.hit);
      if (open == 0) continue;
      Edge edge{tile.tx * CoverageMap::kSide + c % CoverageMap::kSide,
                tile.ty * CoverageMap::kSide + c / CoverageMap::kSide,
                tile.band,
                0,
                {}};
      for (std::size_t side = 0; side < kBeside.size(); ++side) {
        const auto [dx, dy] = kBeside[side];
        const CoverageMap::Column beside = map.column(edge.x + dx, edge.y + dy, edge.band);
        edge.unseen[side] = static_cast<std::uint16_t>(open & ~(beside.seen() | beside.tried));
        edge.free = static_cast<std::uint16_t>(edge.free | edge.unseen[side]);
      }
      if (edge.free != 0) edges.push_back(edge);
    }
  return edges;
}

/// The unseen voxels behind a frontier, at most kDeep deep.
double gain_behind(const CoverageMap& map, const std::vector<CoverageVoxel>& unseen) {
  std::unordered_set<CoverageVoxel, Hash> known(unseen.begin(), unseen.end());
  std::vector<CoverageVoxel> layer = unseen, next;
  for (int depth = 1; depth < kDeep; ++depth) {
    next.clear();
    for (const CoverageVoxel& v : layer)
      for (const auto& [dx, dy] : kBeside) {
        const CoverageVoxel beyond{v.x + dx, v.y + dy, v.z};
        if (!map.seen(beyond) && known.insert(beyond).second) next.push_back(beyond);
      }
    std::swap(layer, next);
  }
  return static_cast<double>(known.size()) * CoverageMap::kVoxel * CoverageMap::kVoxel * CoverageMap::kVoxel;
}

Frontier make_frontier(const std::vector<Edge>& edges, const std::vector<std::size_t>& group, int& voxels) {
  Frontier frontier;
  Eigen::Vector3d sum(0, 0, 0);
  std::unordered_set<CoverageVoxel, Hash> listed;
  voxels = 0;
  for (const std::size_t i : group) {
    const Edge& edge = edges[i];
    for (int k = 0; k < CoverageMap::kSlices; ++k) {
      if (!((edge.free >> k) & 1u)) continue;
      const int z = edge.band * CoverageMap::kSlices + k;
      sum += CoverageMap::centre({edge.x, edge.y, z});
      ++voxels;
      for (std::size_t side = 0; side < kBeside.size(); ++side) {
        const CoverageVoxel v{edge.x + kBeside[side].first, edge.y + kBeside[side].second, z};
        if (((edge.unseen[side] >> k) & 1u) && listed.insert(v).second) frontier.unseen.push_back(v);
      }
    }
  }
  const Eigen::Vector3d middle = sum / std::max(1, voxels);
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : group)
    for (int k = 0; k < CoverageMap::kSlices; ++k) {
      if (!((edges[i].free >> k) & 1u)) continue;
      const Eigen::Vector3d at =
          CoverageMap::centre({edges[i].x, edges[i].y, edges[i].band * CoverageMap::kSlices + k});
      if (const double d = (at - middle).squaredNorm(); d < least) {
        least = d;
        frontier.centre = at;
      }
    }
  return frontier;
}

}  // namespace

Frontiers find_frontiers(const CoverageMap& map, double least_gain) {
  constexpr int kLeastVoxels = 3;  // A frontier of fewer free voxels is left out: holes between beams.
  constexpr int kAcross = 6;       // A group spreads over so many columns at most.
  const std::vector<Edge> edges = find_edges(map);
  std::unordered_map<ColumnKey, std::size_t, Hash> at;  // Looked up only.
  for (std::size_t i = 0; i < edges.size(); ++i)
    at.emplace(ColumnKey{edges[i].x, edges[i].y, edges[i].band}, i);
  std::vector<bool> grouped(edges.size(), false);
  Frontiers found;
  for (std::size_t first = 0; first < edges.size(); ++first) {
    if (grouped[first]) continue;
    std::vector<std::size_t> group{first};
    grouped[first] = true;
    int x0 = edges[first].x, x1 = x0, y0 = edges[first].y, y1 = y0;
    for (std::size_t n = 0; n < group.size(); ++n) {
      const Edge& edge = edges[group[n]];
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const auto beside = at.find({edge.x + dx, edge.y + dy, edge.band});
          if (beside == at.end() || grouped[beside->second]) continue;
          const Edge& other = edges[beside->second];
          if (std::max(x1, other.x) - std::min(x0, other.x) >= kAcross ||
              std::max(y1, other.y) - std::min(y0, other.y) >= kAcross)
            continue;
          x0 = std::min(x0, other.x);
          x1 = std::max(x1, other.x);
          y0 = std::min(y0, other.y);
          y1 = std::max(y1, other.y);
          grouped[beside->second] = true;
          group.push_back(beside->second);
        }
    }
    int voxels = 0;
    Frontier frontier = make_frontier(edges, group, voxels);
    frontier.gain = gain_behind(map, frontier.unseen);
    if (voxels < kLeastVoxels || frontier.gain < least_gain)
      found.dropped += frontier.gain;
    else
      found.list.push_back(std::move(frontier));
  }
  return found;
}

}  // namespace adit::nav
