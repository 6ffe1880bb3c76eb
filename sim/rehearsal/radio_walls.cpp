// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/radio_walls.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world/solid_path.hpp"

namespace adit::sim {
namespace {

std::array<int, 3> cell_of(const wire::Position& p) {
  const auto number = [](double metres) {
    return static_cast<int>(std::floor(std::clamp(metres, -1e6, 1e6) / RadioWalls::kCell));
  };
  return {number(p.x), number(p.y), number(p.z)};
}

}  // namespace

double RadioWalls::operator()(const wire::Position& a, const wire::Position& b) {
  const auto cell_a = cell_of(a), cell_b = cell_of(b);
  const bool turned = cell_b < cell_a;  // one answer for both ways
  const auto& first = turned ? cell_b : cell_a;
  const auto& second = turned ? cell_a : cell_b;
  const std::array<int, 6> key{first[0], first[1], first[2], second[0], second[1], second[2]};
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  if (known_.size() >= kMaxPairs) known_.clear();
  const Eigen::Vector3d from(a.x, a.y, a.z + kAntenna), to(b.x, b.y, b.z + kAntenna);
  const double solid = solid_between(world_.grid(), from, to, kMaxAttenuation / per_metre_);
  return known_[key] = std::min(kMaxAttenuation, per_metre_ * solid);
}

}  // namespace adit::sim
