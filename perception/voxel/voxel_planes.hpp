// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "perception/voxel/flat_hash.hpp"

namespace adit::perception {

/// The surface on which the points of one voxel lie: a plane, or an upright line such as a pole or the edge
/// of a door.
struct PlanePatch {
  Eigen::Vector3d centre;  ///< Mean of the points, m.
  Eigen::Vector3f normal;  ///< Unit vector across it; its sign has no meaning.
  Eigen::Vector3f
      along;             ///< Unit vector: in a plane that of its smaller extent; the other one across a line.
  float variance{};      ///< Of the points in the direction `normal`, m2.
  float extent_along{};  ///< Of the points in the direction `along`, m2.
  float count{};         ///< Points.
  bool line{};
};

/// A map of planes in voxels of several sizes, for registering clouds (after VoxelMap, Yuan et al. 2022).
///
/// Each voxel has the running moments of its first points, and a plane as soon as they lie on one. A lookup
/// takes the coarsest voxel whose points lie on a plane: on a wall that is the largest one, which averages
/// most noise; beside edges a smaller one. Points beyond 80 edges of a size enter only larger voxels, as
/// there is less than one ring of a lidar in a small one there. Voxels that were not touched while the body
/// travelled `keep_distance` are erased, a few slots at a time; at the bound, a new voxel takes the place of
/// one that is farther or older.
class VoxelPlanes {
 public:
  static constexpr int kMaxLevels = 5;
  /// Sizes of the voxels, and what counts as a plane or a line.
  struct Params {
    float finest{0.25f};         ///< Edge of the smallest voxels, m; each further level doubles it.
    int levels{3};               ///< Sizes of voxels, [1, kMaxLevels].
    float noise{0.02f};          ///< Standard deviation of a range, m.
    double keep_distance{60.0};  ///< m
    /// Clouds that an upright line must be seen in: from one place, a wall at grazing incidence looks like
    /// lines, too.
    std::uint8_t line_clouds{3};
    float wide{0.10f};               ///< Smaller extent of a plane, standard deviation per edge of the voxel.
    std::size_t max_voxels{60'000};  ///< Of each size.
  };
  explicit VoxelPlanes(const Params& params) : params_(params) {}
  /// The planes of clouds that are complete (frame of the map, m). All points count, and a larger
  /// voxel is the sum of the smaller ones in it, so that this takes a fraction of the time of insert().
  static VoxelPlanes of(std::span<const Eigen::Vector3f> points, const Params& params);

  /// Adds points (frame of the map, m).
  ///
  /// @param lidar      From where they were measured, m.
  /// @param travelled  Distance that the body moved so far, m.
  /// @return Points that found no room in the voxels of at least one size, as all of them are full of nearer
  ///     and newer ones.
  std::size_t insert(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& lidar, double travelled);
  /// The plane at a place, or just beside the largest voxel there; nothing: no points lie on one.
  std::optional<PlanePatch> find(const Eigen::Vector3d& place) const {
    return find(place, params_.levels - 1);
  }
  /// The same among voxels of the sizes 0 (the smallest) to `top`.
  std::optional<PlanePatch> find(const Eigen::Vector3d& place, int top) const;
  int levels() const { return params_.levels; }
  /// Erases what was not touched lately; a bounded part of the table in each call.
  void forget(double travelled);
  void clear();

  std::size_t size() const;  ///< Voxels of all levels.
  std::size_t bytes() const;

 private:
  struct Cell {
    Eigen::Vector3f mean{0, 0, 0};  ///< Relative to the voxel's corner, m.
    std::array<float, 6> m2{};      ///< Sums of products of deviations: xx, xy, xz, yy, yz, zz.
    Eigen::Vector3f normal{0, 0, 0}, along{0, 0, 0};
    float variance{}, extent_along{};
    float touched{};  ///< Travelled distance when a point was added, m.
    std::uint32_t count{};
    std::uint16_t fitted{};  ///< Points when the plane was fitted.
    std::uint16_t cloud{};   ///< Number of the cloud of its newest point, modulo 65536.
    std::uint8_t clouds{};   ///< From how many clouds the points are, at most 255.
    bool plane{}, line{};
  };
  /// The voxel of a new point at `range` (m); null: there is no room for it.
  Cell* make(int level, std::uint64_t key, const Eigen::Vector3d& lidar, float range, float travelled);
  float edge(int level) const { return params_.finest * static_cast<float>(1 << level); }
  void fit(Cell& cell, float voxel_edge) const;
  /// Adds a point relative to the voxel's corner.
  static void add(Cell& cell, const Eigen::Vector3f& point);
  /// Adds the points of a smaller voxel, whose corner lies `shift` from this one's.
  static void join(Cell& cell, const Cell& part, const Eigen::Vector3f& shift);
  std::optional<PlanePatch> find_in(const Eigen::Vector3d& place, int top) const;

  Params params_;
  std::uint16_t cloud_{};  ///< Number of the cloud that was inserted last.
  std::array<FlatHash<Cell>, kMaxLevels> levels_{};
  std::array<std::size_t, kMaxLevels> sweep_{}, hand_{};
};

}  // namespace adit::perception
