// SPDX-License-Identifier: Apache-2.0
#include "bench/nav_real/true_map.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

namespace adit::bench {
namespace {

constexpr double kNearStart = 1.0;  // m: so far from its start a body may keep the smaller clearance

/// The headings lead from a cell's middle to another's.
constexpr std::array<std::array<int, 2>, TrueMap::kHeadings> kMoves{{{1, 0},
                                                                     {2, 1},
                                                                     {1, 1},
                                                                     {1, 2},
                                                                     {0, 1},
                                                                     {-1, 2},
                                                                     {-1, 1},
                                                                     {-2, 1},
                                                                     {-1, 0},
                                                                     {-2, -1},
                                                                     {-1, -1},
                                                                     {-1, -2},
                                                                     {0, -1},
                                                                     {1, -2},
                                                                     {1, -1},
                                                                     {2, -1}}};

}  // namespace

double TrueMap::heading(int k) {
  const auto& move = kMoves[static_cast<std::size_t>(k)];
  return std::atan2(move[1], move[0]);
}

TrueMap::TrueMap(const sim::World& world, const Platform& platform)
    : platform_(platform),
      standing_(world, platform.height, platform.step),
      origin_(world.grid().origin()),
      nx_(static_cast<int>(world.grid().nx() * world.grid().resolution() / kCell)),
      ny_(static_cast<int>(world.grid().ny() * world.grid().resolution() / kCell)) {
  start_.resize(static_cast<std::size_t>(nx_) * ny_);
  pass_.resize(start_.size());
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i) {
      start_[index(i, j)] = fitting(i, j, kStartClearance);
      pass_[index(i, j)] = start_[index(i, j)] == 0 ? std::uint16_t{0} : fitting(i, j, kPassClearance);
    }
}

bool TrueMap::fits(const Pose2& pose, double clearance) const {
  return !standing_.touches({pose, platform_.length + 2 * clearance, platform_.width + 2 * clearance});
}

std::uint16_t TrueMap::fitting(int i, int j, double clearance) const {
  const Eigen::Vector2d at = middle(i, j);
  if (standing_.blocked(at.x(), at.y())) return 0;
  std::uint16_t out = 0;
  for (int k = 0; k < kHeadings / 2; ++k)
    if (fits({at.x(), at.y(), heading(k)}, clearance))
      out |= static_cast<std::uint16_t>((1u << k) | (1u << (k + kHeadings / 2)));
  return out;
}

bool TrueMap::standable(int i, int j) const { return fitting(i, j, 0.0) != 0; }

std::vector<float> TrueMap::distances(const Pose2& from) const {
  struct Node {
    float metres;
    std::uint32_t state;
    bool operator<(const Node& other) const { return metres > other.metres; }
  };
  std::vector<float> best(start_.size() * kHeadings, kFar);
  std::vector<float> out(start_.size(), kFar);
  std::priority_queue<Node> open;
  const auto allowed = [&](int i, int j, int k) {
    if (!inside(i, j)) return false;
    const unsigned bit = 1u << k;
    return (pass_[index(i, j)] & bit) != 0 ||
           ((start_[index(i, j)] & bit) != 0 && (middle(i, j) - from.position()).norm() < kNearStart);
  };
  const auto reach = [&](int i, int j, int k, float metres) {
    k = (k + kHeadings) % kHeadings;
    if (!allowed(i, j, k)) return;
    const std::size_t state = index(i, j) * kHeadings + static_cast<std::size_t>(k);
    if (best[state] <= metres) return;
    best[state] = metres;
    float& cell = out[index(i, j)];
    cell = std::min(cell, metres);
    open.push({metres, static_cast<std::uint32_t>(state)});
  };
  // The start lies between cells and headings: what touches it within one cell and heading counts as it.
  const int i0 = column(from.x, 0), j0 = column(from.y, 1);
  for (int k = 0; k < kHeadings; ++k) {
    if (std::abs(wrap_angle(heading(k) - from.yaw)) > 2.0 * M_PI / kHeadings) continue;
    for (int j = j0 - 1; j <= j0 + 1; ++j)
      for (int i = i0 - 1; i <= i0 + 1; ++i) reach(i, j, k, 0.0f);
  }
  while (!open.empty()) {
    const Node node = open.top();
    open.pop();
    if (node.metres > best[node.state]) continue;
    const int k = static_cast<int>(node.state % kHeadings);
    const int cell = static_cast<int>(node.state / kHeadings), i = cell % nx_, j = cell / nx_;
    reach(i, j, k + 1, node.metres);
    reach(i, j, k - 1, node.metres);
    for (int m = 0; m < kHeadings; ++m) {
      if (!platform_.sideways() && m != k && m != (k + kHeadings / 2) % kHeadings) continue;
      const auto& move = kMoves[static_cast<std::size_t>(m)];
      reach(i + move[0], j + move[1], k,
            node.metres + static_cast<float>(kCell * std::hypot(move[0], move[1])));
    }
  }
  return out;
}

float TrueMap::distance_to(const std::vector<float>& distances, const Eigen::Vector2d& goal,
                           double tolerance) const {
  const int reach = static_cast<int>(tolerance / kCell) + 1;
  const int i0 = column(goal.x(), 0), j0 = column(goal.y(), 1);
  float best = kFar;
  for (int j = j0 - reach; j <= j0 + reach; ++j)
    for (int i = i0 - reach; i <= i0 + reach; ++i)
      if (inside(i, j) && (middle(i, j) - goal).norm() <= tolerance)
        best = std::min(best, distances[index(i, j)]);
  return best;
}

std::optional<Pose2> TrueMap::draw_pose(Random& random, double clearance) const {
  for (int attempt = 0; attempt < 200000; ++attempt) {
    const Pose2 pose{origin_.x() + random.uniform(0.0, nx_ * kCell),
                     origin_.y() + random.uniform(0.0, ny_ * kCell), random.uniform(-M_PI, M_PI)};
    if (fits(pose, clearance)) return pose;
  }
  return std::nullopt;
}

}  // namespace adit::bench
