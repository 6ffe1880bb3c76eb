// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "nav/terrain/cell_class.hpp"
#include "nav/terrain/ground_grid.hpp"

namespace adit::nav {

/// Parameters of Surface.
struct SurfaceParams {
  float slope{0.35f};         ///< Maximum slope, rise per run, (0, 1.5].
  float step{0.08f};          ///< Maximum step height, m, (0, 1].
  float blocking_step{1e3f};  ///< Higher steps are impassable, m, (0, inf).
  float easy{0.6f};           ///< Fraction of the platform's limits below which ground costs nothing, (0, 1).
  float hard{0.45f};          ///< Cost at the platform's limits, [0.1, 0.9].
  float rough{0.5f};          ///< Maximum deviation from a plane, as a fraction of the step, (0, 2].
};

/// Computes the cost of the ground. Slope and roughness come from the plane that fits the ground of 0.7 m
/// best, and the step height from what remains after subtracting the plane's slope (an edge of height H in
/// the middle tilts that plane by 1.5 H / 0.7 m). The cost grows with the fraction of the platform's limits.
class Surface {
 public:
  /// `side`: number of cells of the ground's window along each axis.
  Surface(const SurfaceParams& params, int side);

  /// Updates places(). `solid`: marks the cells of the ground's window with an obstacle, whose heights are
  /// not those of the ground.
  void work_out(const GroundGrid& ground, std::span<const std::uint8_t> solid);

  /// A place with a cost: every second cell of the ground, and each cell crossed by a step that is too high.
  struct Place {
    std::uint32_t index;  ///< In the ground's window.
    CellClass kind;       ///< `slope` or `step`.
    float cost;           ///< (0, 1]
  };
  std::span<const Place> places() const { return {places_.data(), places_.size()}; }

 private:
  static constexpr int kReach = 3;  ///< Cells to each side.
  /// Sums over the measured cells of a piece of a column; x is relative to its middle, m.
  struct Sums {
    std::vector<float> n, x, xx, z, xz, zz;
  };
  void add_rows(const GroundGrid& ground, int i);
  void judge(const GroundGrid& ground, int i, int j);
  struct Step {
    float height{};
    int above{-1};  ///< The neighbour on the upper side.
  };
  /// The step at a cell of ground with this gradient.
  Step step_at(const GroundGrid& ground, int middle, float gx, float gy) const;
  /// Adds all cells at and around one where a step is too high: its lower and its upper cells.
  void follow_step(const GroundGrid& ground, int i, int j, float gx, float gy);
  /// The cost of ground that needs this fraction of the platform's limits.
  float cost(float share) const;

  SurfaceParams params_;
  int side_;
  std::vector<float> weight_;           ///< Per cell of the window: 1 measured, 0 not.
  std::vector<std::uint8_t> followed_;  ///< Per cell: already in places_ as a step that is too high.
  Sums sums_{};
  std::vector<Place> places_{};
};

}  // namespace adit::nav
