// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "nav/terrain/ground_grid.hpp"
#include "nav/terrain/terrain_cell.hpp"

namespace adit::nav {

struct SurfaceParams {
  float slope{0.35f};         ///< steepest ground, rise per run, (0, 1.5]
  float step{0.08f};          ///< highest step, m, (0, 1]
  float blocking_step{1e3f};  ///< a higher one cannot be passed, m, (0, inf)
  float easy{0.6f};           ///< share of what the platform can up to which ground costs nothing, (0, 1)
  float hard{0.45f};          ///< cost of the most that it can, [0.1, 0.9]
  float rough{0.5f};  ///< of the step: deviation from a plane that is as much as the platform can, (0, 2]
};

/// What the ground costs: slope and roughness from the plane that fits the ground of 0.7 m best, and the
/// height of the step that is left when the plane's slope is taken away (an edge of height H in the middle
/// tilts that plane by 1.5 H / 0.7 m). Cost by the share of what the platform can.
class Surface {
 public:
  /// `side`: cells of the ground's window along each axis.
  Surface(const SurfaceParams& params, int side);

  /// `solid`: cells of the ground's window that hold an obstacle, and so tell nothing of the ground.
  void work_out(const GroundGrid& ground, std::span<const std::uint8_t> solid);

  /// A place that costs something: every second cell of the ground, and each that a step crosses which is too
  /// high.
  struct Place {
    std::uint32_t index;  ///< in the ground's window
    Layer layer;
    float cost;  ///< (0, 1]
  };
  std::span<const Place> places() const { return {places_.data(), places_.size()}; }

 private:
  static constexpr int kReach = 3;  ///< cells to each side
  /// Sums over the measured cells of a piece of a column; x counts from its middle, m.
  struct Sums {
    std::vector<float> n, x, xx, z, xz, zz;
  };
  void add_rows(const GroundGrid& ground, int i);
  void judge(const GroundGrid& ground, int i, int j);
  struct Step {
    float height{};
    int above{-1};  ///< the cell beside, on its upper side
  };
  /// The step at a cell of ground that else rises by that gradient.
  Step step_at(const GroundGrid& ground, int middle, float gx, float gy) const;
  /// Every cell at and around one where a step is too high: where it ends, and where it begins, counts.
  void follow_step(const GroundGrid& ground, int i, int j, float gx, float gy);
  /// Of ground that asks for this share of what the platform can.
  float cost(float share) const;

  SurfaceParams params_;
  int side_;
  std::vector<float> weight_;           ///< of each cell of the window: 1 measured, 0 not
  std::vector<std::uint8_t> followed_;  ///< the same: it is among the places, as a step that is too high
  Sums sums_{};
  std::vector<Place> places_{};
};

}  // namespace adit::nav
