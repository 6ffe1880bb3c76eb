// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "sim/world/world.hpp"

namespace adit::sim {

/// Cubic cells over a world, with edges at multiples of their size: the unit in which exploration is counted.
class ExplorationCells {
 public:
  static constexpr double kSize = 0.5;  ///< m

  explicit ExplorationCells(const World& world) {
    const VoxelGrid& grid = world.grid();
    const Eigen::Vector3d low(grid.origin().x(), grid.origin().y(), grid.levels().front());
    const Eigen::Vector3d high(grid.origin().x() + grid.nx() * grid.resolution(),
                               grid.origin().y() + grid.ny() * grid.resolution(), grid.levels().back());
    for (int a = 0; a < 3; ++a) {
      first_[a] = static_cast<int>(std::floor(low[a] / kSize + kRounding));
      count_[a] = static_cast<int>(std::ceil(high[a] / kSize - kRounding)) - first_[a];
    }
  }

  std::size_t size() const { return static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]; }

  /// The centre of a cell, world frame, m.
  Eigen::Vector3d centre(std::size_t cell) const {
    const auto i = static_cast<int>(cell % count_[0]);
    const auto j = static_cast<int>(cell / count_[0] % count_[1]);
    const auto k = static_cast<int>(cell / count_[0] / count_[1]);
    return kSize * Eigen::Vector3d(first_[0] + i + 0.5, first_[1] + j + 0.5, first_[2] + k + 0.5);
  }

  /// Calls `use` for each of the up to 26 cells around one.
  template <class Use>
  void for_each_around(std::size_t cell, const Use& use) const {
    const auto i = static_cast<int>(cell % count_[0]);
    const auto j = static_cast<int>(cell / count_[0] % count_[1]);
    const auto k = static_cast<int>(cell / count_[0] / count_[1]);
    for (int c = std::max(0, k - 1); c <= std::min(count_[2] - 1, k + 1); ++c)
      for (int b = std::max(0, j - 1); b <= std::min(count_[1] - 1, j + 1); ++b)
        for (int a = std::max(0, i - 1); a <= std::min(count_[0] - 1, i + 1); ++a) {
          const std::size_t other = (static_cast<std::size_t>(c) * count_[1] + b) * count_[0] + a;
          if (other != cell) use(other);
        }
  }

  /// Calls `use` for each cell on the straight way of that length from `from` along the unit vector
  /// `direction`. Voxel traversal after Amanatides and Woo (1987).
  template <class Use>
  void for_each_on(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double length,
                   const Use& use) const {
    std::array<int, 3> at{}, step{};
    std::array<double, 3> next{}, apart{};
    for (int a = 0; a < 3; ++a) {
      constexpr double kNever = std::numeric_limits<double>::infinity();
      const int cell = static_cast<int>(std::floor(from[a] / kSize));
      at[a] = cell - first_[a];
      step[a] = direction[a] > 0 ? 1 : -1;
      apart[a] = direction[a] == 0 ? kNever : kSize / std::fabs(direction[a]);
      next[a] = direction[a] == 0 ? kNever : ((cell + (direction[a] > 0)) * kSize - from[a]) / direction[a];
    }
    while (true) {
      if (inside(at)) use((static_cast<std::size_t>(at[2]) * count_[1] + at[1]) * count_[0] + at[0]);
      const auto a = static_cast<std::size_t>(std::min_element(next.begin(), next.end()) - next.begin());
      if (next[a] > length) return;
      at[a] += step[a];
      next[a] += apart[a];
    }
  }

 private:
  static constexpr double kRounding = 1e-6;
  bool inside(const std::array<int, 3>& at) const {
    return at[0] >= 0 && at[1] >= 0 && at[2] >= 0 && at[0] < count_[0] && at[1] < count_[1] &&
           at[2] < count_[2];
  }
  std::array<int, 3> first_{}, count_{};
};

}  // namespace adit::sim
