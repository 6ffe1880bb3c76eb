// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace adit::sim {

/// Solid or open cells: square columns of equal size, cut into layers of any thickness. An OctoMap has
/// layers as thick as its cells; a floor plan needs a single one.
///
/// For each of the four ways a ray can head, every open cell keeps a large open rectangle of its layer that
/// begins there and lies that way, and how many layers above and below leave that rectangle open, too: a ray
/// crosses open space in a few strides.
class VoxelGrid {
 public:
  /// Nothing is hit within the range asked for.
  static constexpr double kNoHit = std::numeric_limits<double>::infinity();
  /// More cells than this are refused by the loaders.
  static constexpr std::int64_t kMaxCells = 32'000'000;

  VoxelGrid() = default;
  /// All cells solid. `origin`: corner of the grid with the smallest x and y, m; `resolution`: edge of a
  /// column, m, > 0; `levels`: heights of the layers' borders, m, ascending, layers + 1 of them.
  /// `open_sides`: whether what lies beside the grid is open (else solid); below and above is solid.
  VoxelGrid(const Eigen::Vector2d& origin, double resolution, int nx, int ny, std::vector<double> levels,
            bool open_sides);

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  int layers() const { return static_cast<int>(levels_.size()) - 1; }
  double resolution() const { return resolution_; }
  const Eigen::Vector2d& origin() const { return origin_; }
  const std::vector<double>& levels() const { return levels_; }
  bool open_sides() const { return open_sides_; }

  bool inside(int i, int j) const { return i >= 0 && i < nx_ && j >= 0 && j < ny_; }
  bool solid(int i, int j, int k) const { return strides_[kTowardsBoth][index(i, j, k)].width == 0; }
  /// To be followed by build() after the last change.
  void set(int i, int j, int k, bool solid) { strides_[kTowardsBoth][index(i, j, k)].width = solid ? 0 : 1; }
  /// Computes the strides.
  void build();

  /// Column that holds x or y (m); may lie outside the grid.
  int column_x(double x) const { return static_cast<int>(std::floor((x - origin_.x()) / resolution_)); }
  int column_y(double y) const { return static_cast<int>(std::floor((y - origin_.y()) / resolution_)); }
  Eigen::Vector2d centre(int i, int j) const {
    return origin_ + resolution_ * Eigen::Vector2d(i + 0.5, j + 0.5);
  }

  /// Where rays start; located once for all rays of a scan.
  struct Start {
    Eigen::Vector3d position;  ///< m
    double gx, gy;             ///< Position in columns.
    int i, j, k;               ///< Its cell; k = -1: below or above the grid.
  };
  Start locate(const Eigen::Vector3d& position) const;

  /// Distance along `direction` (unit vector) to the first solid cell, m, 0 when the start is solid; no_hit
  /// beyond `max_range`. Voxel traversal after Amanatides and Woo (1987), with strides over empty squares.
  double cast(const Start& start, const Eigen::Vector3d& direction, double max_range) const;
  /// The same for many rays from one start, into `ranges` (as many as directions). Several at once where the
  /// processor can, with equal results.
  void cast(const Start& start, std::span<const Eigen::Vector3d> directions, double max_range,
            std::span<double> ranges) const;
  /// The same, one after the other.
  void cast_each(const Start& start, std::span<const Eigen::Vector3d> directions, double max_range,
                 std::span<double> ranges) const;

 private:
  struct Ray;
  /// The open box that begins at a cell.
  struct Stride {
    std::uint8_t width;   ///< Of its rectangle along x, cells; 0: the cell is solid.
    std::uint8_t depth;   ///< Along y, cells.
    std::uint8_t layers;  ///< Layers below (low half of the byte) and above (high half) that it reaches.
  };
  static constexpr int kTowardsBoth = 3;
  /// Chooses the rectangle of an open cell, at most `widest` and `deepest`, which are its open cells in a
  /// line. One of the cells beside it, grown by this cell's row or column, is near the largest.
  static void choose_rectangle(Stride& stride, int widest, int deepest, const Stride& right,
                               const Stride& left, const Stride& both);
  /// Puts a ray on its way, or gives its range at once (false).
  bool prepare(const Start& from, const Eigen::Vector3d& direction, double max_range, Ray& ray,
               double& range) const;
  /// Casts up to VoxelLanes::kMax rays at once; false: they do not all head the same way.
  bool cast_together(const Start& from, std::span<const Eigen::Vector3d> directions, double max_range,
                     std::span<double> ranges) const;
  /// The cells of a column lie side by side: the rays of a lidar's column cross the same ones.
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(j) * nx_ + i) * layers() + k;
  }
  /// Moves a start that lies beside the grid to the point where the ray enters; false when it never does.
  bool enter(Start& start, const Eigen::Vector3d& direction, double& t) const;
  /// Floor or ceiling of an open world, beside the grid.
  double cast_beside(const Start& start, const Eigen::Vector3d& direction, double max_range) const;

  Eigen::Vector2d origin_{Eigen::Vector2d::Zero()};
  double resolution_{1.0};
  double per_metre_{1.0};
  int nx_{0};
  int ny_{0};
  bool open_sides_{false};
  std::vector<double> levels_{0.0, 1.0};
  /// Bit 0 of the index: towards +x, bit 1: towards +y; the other ways are stored mirrored, so that every ray
  /// heads towards + in its own.
  std::array<std::vector<Stride>, 4> strides_{};
};

}  // namespace adit::sim
