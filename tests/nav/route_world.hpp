// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <random>
#include <vector>

#include "nav/routing/route_planner.hpp"
#include "tests/nav/box_world.hpp"

namespace adit::nav::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The middle of a cell of 0.1 m, m.
inline Eigen::Vector3d middle(int x, int y, double z = 0) { return {(x + 0.5) * 0.1, (y + 0.5) * 0.1, z}; }

/// A flat world of 0.1 m cells, `#` walls, for planners with a given map.
struct GridWorld {
  int width, depth;
  std::vector<bool> wall{};

  GridWorld(int w, int d) : width(w), depth(d), wall(static_cast<std::size_t>(w * d), false) {}
  bool at(int x, int y) const {
    return x < 0 || y < 0 || x >= width || y >= depth || wall[static_cast<std::size_t>(y * width + x)];
  }
  void fill(int x0, int x1, int y0, int y1, bool solid = true) {
    for (int y = std::max(0, y0); y < std::min(depth, y1); ++y)
      for (int x = std::max(0, x0); x < std::min(width, x1); ++x)
        wall[static_cast<std::size_t>(y * width + x)] = solid;
  }
  void border() {
    fill(0, width, 0, 1);
    fill(0, width, depth - 1, depth);
    fill(0, 1, 0, depth);
    fill(width - 1, width, 0, depth);
  }
  void tell(RoutePlanner& planner, double z = 0) const {
    for (int y = 0; y < depth; ++y)
      for (int x = 0; x < width; ++x) {
        const Eigen::Vector3d place{(x + 0.5) * 0.1, (y + 0.5) * 0.1, z};
        if (at(x, y))
          planner.set_obstacle(place, 2.0);
        else
          planner.set_ground(place);
      }
    planner.finish();
  }

  /// Boxes of 0.5 to 2.5 m at random.
  static GridWorld random(int w, int d, int boxes, std::uint32_t seed) {
    GridWorld world(w, d);
    std::mt19937 draw(seed);
    const auto upto = [&](int n) { return static_cast<int>(draw() % static_cast<std::uint32_t>(n)); };
    for (int i = 0; i < boxes; ++i) {
      const int x = upto(w), y = upto(d);
      world.fill(x, x + 5 + upto(20), y, y + 5 + upto(20));
    }
    world.border();
    return world;
  }

  /// Whether the middle of a cell is at least so far from the middles of all walls, m.
  std::vector<bool> passable(double clearance) const {
    std::vector<bool> free(wall.size(), true);
    const int reach = static_cast<int>(clearance / 0.1) + 1;
    for (int y = 0; y < depth; ++y)
      for (int x = 0; x < width; ++x)
        if (at(x, y))
          for (int v = std::max(0, y - reach); v <= std::min(depth - 1, y + reach); ++v)
            for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u)
              if (std::hypot(u - x, v - y) * 0.1 < clearance - 1e-9)
                free[static_cast<std::size_t>(v * width + u)] = false;
    return free;
  }

  /// Brute force: the length of the shortest way over passable cells (16 directions), m; infinite: none.
  double shortest(const std::vector<bool>& free, int x0, int y0, int x1, int y1) const {
    std::vector<double> best(free.size(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto index = [this](int x, int y) { return y * width + x; };
    if (!free[static_cast<std::size_t>(index(x0, y0))]) return std::numeric_limits<double>::infinity();
    best[static_cast<std::size_t>(index(x0, y0))] = 0;
    open.push({0, index(x0, y0)});
    constexpr int kWays[16][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1},   {-1, 1},  {-1, -1}, {1, -1},
                                  {2, 1}, {1, 2}, {-1, 2}, {-2, 1}, {-2, -1}, {-1, -2}, {1, -2},  {2, -1}};
    while (!open.empty()) {
      const auto [d, at_index] = open.top();
      open.pop();
      if (d > best[static_cast<std::size_t>(at_index)]) continue;
      if (at_index == index(x1, y1)) return d;
      const int x = at_index % width, y = at_index / width;
      for (const auto& way : kWays) {
        const int u = x + way[0], v = y + way[1];
        if (u < 0 || v < 0 || u >= width || v >= depth || !free[static_cast<std::size_t>(index(u, v))])
          continue;
        const double next = d + 0.1 * std::hypot(way[0], way[1]);
        if (next >= best[static_cast<std::size_t>(index(u, v))]) continue;
        best[static_cast<std::size_t>(index(u, v))] = next;
        open.push({next, index(u, v)});
      }
    }
    return std::numeric_limits<double>::infinity();
  }
};

/// The smallest distance from a route's lines to the middle of a wall, m.
inline double route_clearance(const GridWorld& world, const Route& route) {
  double least = 10;
  for (std::size_t i = 0; i + 1 < route.points.size(); ++i) {
    const Eigen::Vector3d way = route.points[i + 1] - route.points[i];
    const int steps = std::max(1, static_cast<int>(way.norm() / 0.05));
    for (int k = 0; k <= steps; ++k) {
      const Eigen::Vector3d p = route.points[i] + way * k / steps;
      const int cx = static_cast<int>(std::floor(p.x() / 0.1)),
                cy = static_cast<int>(std::floor(p.y() / 0.1));
      for (int y = cy - 5; y <= cy + 5; ++y)
        for (int x = cx - 5; x <= cx + 5; ++x)
          if (world.at(x, y))
            least = std::min(least, std::hypot((x + 0.5) * 0.1 - p.x(), (y + 0.5) * 0.1 - p.y()));
    }
  }
  return least;
}

/// A city: n x n blocks of `block` metres with corridors of `corridor` between and around them, walled in.
inline BoxWorld city(int n, double block, double corridor) {
  BoxWorld world;
  const double pitch = block + corridor, side = n * pitch + corridor;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      world.boxes.push_back({corridor + i * pitch, corridor + i * pitch + block, corridor + j * pitch,
                             corridor + j * pitch + block});
  world.boxes.push_back({-0.2, 0, -0.2, side + 0.2});
  world.boxes.push_back({side, side + 0.2, -0.2, side + 0.2});
  world.boxes.push_back({0, side, -0.2, 0});
  world.boxes.push_back({0, side, side, side + 0.2});
  return world;
}

}  // namespace adit::nav::test
