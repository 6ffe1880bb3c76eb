// SPDX-License-Identifier: Apache-2.0
#include "bench/nav_real/doors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace adit::bench {
namespace {

constexpr double kWidest = 1.5;      // m: what is wider is no door
constexpr double kNarrowest = 0.4;   // m: what is narrower is none for anybody
constexpr double kDeeper = 0.25;     // m: so much farther from everything are the places on both sides
constexpr double kApart = 1.0;       // m: saddles nearer to each other are one door
constexpr double kThrough = 0.5;     // m: led straight on both sides
constexpr double kMostBeside = 0.6;  // m

/// Regions around the places that lie farthest from everything, grown downwards.
class Regions {
 public:
  int create(double peak) {
    parent_.push_back(static_cast<int>(parent_.size()));
    peak_.push_back(peak);
    return parent_.back();
  }
  int root(int n) {
    while (parent_[static_cast<std::size_t>(n)] != n) n = parent_[static_cast<std::size_t>(n)];
    return n;
  }
  double peak(int root) const { return peak_[static_cast<std::size_t>(root)]; }
  void join(int into, int from) { parent_[static_cast<std::size_t>(from)] = into; }

 private:
  std::vector<int> parent_{};
  std::vector<double> peak_{};
};

}  // namespace

std::vector<Door> find_doors(const TrueMap& map) {
  const int nx = map.nx(), ny = map.ny();
  std::vector<float> room(static_cast<std::size_t>(nx) * ny);
  std::vector<int> order;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Eigen::Vector2d p = map.middle(i, j);
      const int n = j * nx + i;
      room[static_cast<std::size_t>(n)] = static_cast<float>(map.standing().distance(p.x(), p.y()));
      if (2.0 * room[static_cast<std::size_t>(n)] >= kNarrowest) order.push_back(n);
    }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return room[static_cast<std::size_t>(a)] > room[static_cast<std::size_t>(b)];
  });
  const auto for_beside = [&](int n, const auto& use) {
    const int i = n % nx, j = n / nx;
    for (int b = std::max(0, j - 1); b <= std::min(ny - 1, j + 1); ++b)
      for (int a = std::max(0, i - 1); a <= std::min(nx - 1, i + 1); ++a) use(b * nx + a);
  };
  std::vector<int> label(room.size(), -1);
  Regions regions;
  std::vector<Door> doors;
  for (const int n : order) {
    const double here = room[static_cast<std::size_t>(n)];
    // The cell belongs to the region of its neighbour with the most room.
    int mine = -1;
    float most = 0.0f;
    for_beside(n, [&](int beside) {
      const std::size_t b = static_cast<std::size_t>(beside);
      if (label[b] < 0 || room[b] <= most) return;
      most = room[b];
      mine = regions.root(label[b]);
    });
    for_beside(n, [&](int beside) {
      if (label[static_cast<std::size_t>(beside)] < 0) return;
      const int other = regions.root(label[static_cast<std::size_t>(beside)]);
      if (other == mine) return;
      const bool mine_is_lower = regions.peak(other) > regions.peak(mine);
      const int high = mine_is_lower ? other : mine, low = mine_is_lower ? mine : other;
      if (2.0 * here > kWidest || regions.peak(low) - here < kDeeper) {
        regions.join(high, low);
        mine = high;
        return;
      }
      const Eigen::Vector2d at = map.middle(n % nx, n / nx);
      if (std::none_of(doors.begin(), doors.end(),
                       [&](const Door& door) { return (door.at - at).norm() < kApart; }))
        doors.push_back({at, 2.0 * here});
    });
    label[static_cast<std::size_t>(n)] = mine < 0 ? regions.create(here) : mine;
  }
  std::sort(doors.begin(), doors.end(), [](const Door& a, const Door& b) {
    return a.at.x() != b.at.x() ? a.at.x() < b.at.x() : a.at.y() < b.at.y();
  });
  return doors;
}

Passage fit_passage(const TrueMap& map, const Door& door) {
  const Platform& body = map.platform();
  const auto fits = [&](const Pose2& pose, double beside) {
    return !map.standing().touches({pose, body.length + 2.0 * kThrough, body.width + 2.0 * beside});
  };
  Passage best{{}, -1.0};
  for (int k = 0; k < 60; ++k) {
    const double yaw = k * M_PI / 60.0;
    for (int m = -20; m <= 20; ++m) {
      const Pose2 pose = Pose2{door.at.x(), door.at.y(), yaw} * Pose2{0.0, 0.02 * m, 0.0};
      double low = best.beside, high = kMostBeside;
      if (!fits(pose, std::max(low, -0.5 * body.width + 0.01) + 0.005)) continue;
      while (high - low > 0.005) {
        const double mid = 0.5 * (low + high);
        (fits(pose, mid) ? low : high) = mid;
      }
      best = {pose, low};
    }
  }
  return best;
}

}  // namespace adit::bench
