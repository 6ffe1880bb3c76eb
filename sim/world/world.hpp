// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/result/result.hpp"
#include "sim/world/voxel_grid.hpp"

namespace adit::sim {

/// What robots drive in and lidars see: never changes after it was made, so any thread may read it.
/// World frame: metres, z up.
class World {
 public:
  World(std::string name, VoxelGrid grid) : name_(std::move(name)), grid_(std::move(grid)) {}

  const std::string& name() const { return name_; }
  const VoxelGrid& grid() const { return grid_; }

  /// Height of the lowest floor at (x, y) with `headroom` metres of open space above it, m.
  /// Reason::out_of_range when there is none.
  Result<double> ground_height(double x, double y, double headroom) const;
  /// The same by column; NaN when there is none.
  double column_floor(int i, int j, double headroom) const;

 private:
  std::string name_;
  VoxelGrid grid_;
};

/// x0, x1, y0, y1, z0, z1 of a solid box, m.
using Box = std::array<double, 6>;

/// A world of boxes that stand in an endless room between `floor` and `ceiling` (m). Boxes are rounded to
/// columns of 0.05 m in x and y (at least one), and exact in z. Reason::bad_argument for a box or room
/// turned inside out, values that are not finite, or more than the grid takes.
Result<World> make_box_world(std::span<const Box> boxes, double floor, double ceiling);

/// An OctoMap binary file (.bt). Unknown cells are solid, except those with known free space within 0.5 m
/// on opposite horizontal sides; a missing floor is filled from its neighbours. Beside the map all is
/// solid. Errors name the file: Reason::cannot_read, syntax, not_supported.
Result<World> load_octomap(const std::filesystem::path& file);

/// A map_server floor plan: YAML (image, resolution, origin, negate, occupied_thresh, free_thresh) with its
/// PGM image (P2 or P5). Walls and unknown cells reach from the floor at 0 to `ceiling` m; beside the plan
/// all is solid. A rotated origin is not supported. Errors name the file: Reason::cannot_read, syntax,
/// missing_key, wrong_type, out_of_range, not_supported.
Result<World> load_floor_plan(const std::filesystem::path& file, double ceiling = 3.0);

/// The first of `folders` that has a file called `name` (an absolute name is taken as it is).
/// Reason::cannot_read, with what to do, when none has.
Result<std::filesystem::path> find_map(const std::string& name,
                                       std::span<const std::filesystem::path> folders);

}  // namespace adit::sim
