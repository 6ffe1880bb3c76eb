// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/geometry/round_down.hpp"

namespace adit::nav {

/// Address of a voxel: its edges lie at these multiples of kCoverageVoxel.
struct CoverageVoxel {
  int x{}, y{}, z{};
  bool operator==(const CoverageVoxel&) const = default;
};

/// What a robot's lidars have seen of the space around it: voxels of 0.5 m that a ray passed or ended in,
/// within a range. Frame: that of the poses, z up, m. Has no clock. Bounded: `kMaxTiles`.
class CoverageMap {
 public:
  static constexpr double kVoxel = 0.5;   ///< Edge of a voxel, m.
  static constexpr int kSide = 4;         ///< Columns along the side of a tile.
  static constexpr int kSlices = 16;      ///< Voxels above one another in a tile.
  static constexpr double kRange = 12.0;  ///< What lies farther from the sensor does not count as seen, m.
  /// Most tiles of 2 x 2 x 8 m (208 bytes each); a ray that would need more of them ends.
  static constexpr std::size_t kMaxTiles = 65'536;

  /// A column of a tile; bit k: its k-th voxel from below.
  struct Column {
    std::uint16_t free{0};   ///< A ray passed.
    std::uint16_t hit{0};    ///< A ray ended here, and what it met did not leave.
    std::uint16_t tried{0};  ///< The robot looked from a place that should show it, and saw nothing.
    /// Scans in a row, up to 7, of which rays passed a voxel that was hit and none ended in it: one bit of
    /// the number each.
    std::array<std::uint16_t, 3> passed{};
    std::uint16_t seen() const { return free | hit; }
  };
  /// A square of columns over one band of heights.
  struct Tile {
    int tx{}, ty{}, band{};
    std::array<Column, kSide * kSide> columns{};
  };

  /// Takes a scan. What was hit stays hit until 7 scans in a row show something behind it and nothing in it:
  /// people, robots and doors leave. `points`: base_link, m, not finite where nothing was hit; `sensor`: the
  /// lidar in base_link, m; `body`: base_link in the map's frame.
  void add_scan(std::span<const Eigen::Vector3f> points, const Eigen::Vector3d& sensor, const Pose3& body);
  /// Notes that a voxel cannot be seen from where it should be visible.
  void set_tried(const CoverageVoxel& voxel);

  const std::vector<Tile>& tiles() const { return tiles_; }
  /// The column of a voxel; an empty one where nothing is known.
  Column column(int x, int y, int band) const;
  bool seen(const CoverageVoxel& v) const { return bit(column(v.x, v.y, band_of(v.z)).seen(), v.z); }
  bool hit(const CoverageVoxel& v) const { return bit(column(v.x, v.y, band_of(v.z)).hit, v.z); }
  /// Whether the straight line between two places passes no voxel that was hit, but for those it begins and
  /// ends in.
  bool visible(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
  /// Volume of what was seen, m3.
  double seen_volume() const;
  std::size_t memory() const;
  void clear();

  static CoverageVoxel voxel_at(const Eigen::Vector3d& place) {
    return {round_down(place.x() / kVoxel), round_down(place.y() / kVoxel), round_down(place.z() / kVoxel)};
  }
  static Eigen::Vector3d centre(const CoverageVoxel& v) {
    return kVoxel * Eigen::Vector3d(v.x + 0.5, v.y + 0.5, v.z + 0.5);
  }
  static int band_of(int z) { return z >> 4; }
  static bool bit(std::uint16_t mask, int z) { return (mask >> (z & 15)) & 1u; }

 private:
  /// The voxels around the sensor that a ray of the current scan has noted: one bit each.
  class Window {
   public:
    /// Begins a scan of a sensor in this voxel.
    void begin(const CoverageVoxel& sensor) {
      corner_ = {sensor.x - kEdge / 2, sensor.y - kEdge / 2, sensor.z - kEdge / 2};
      clear();
    }
    void clear() { noted_.assign(2 * kEdge * kEdge, 0); }
    /// The bits of a voxel's column, for rays that end in it or pass; null outside of the window.
    std::uint64_t* find(const CoverageVoxel& v, bool hits) {
      const auto x = static_cast<std::uint32_t>(v.x - corner_.x),
                 y = static_cast<std::uint32_t>(v.y - corner_.y),
                 z = static_cast<std::uint32_t>(v.z - corner_.z);
      if (x >= kEdge || y >= kEdge || z >= kEdge) return nullptr;
      return &noted_[2 * (y * kEdge + x) + hits];
    }
    std::uint64_t bit(const CoverageVoxel& v) const { return std::uint64_t{1} << (v.z - corner_.z); }
    /// Calls `visit(x, y, z, passed, hits)` for each column that a ray passed: bit k is the voxel at z + k.
    template <class Visit>
    void visit_passed(Visit&& visit) const {
      for (int i = 0; i < kEdge * kEdge; ++i)
        if (noted_[2 * i] != 0)
          visit(corner_.x + i % kEdge, corner_.y + i / kEdge, corner_.z, noted_[2 * i], noted_[2 * i + 1]);
    }

   private:
    static constexpr int kEdge = 64;  ///< Voxels.
    CoverageVoxel corner_{};
    std::vector<std::uint64_t> noted_{};
  };

  static std::uint64_t key(int tx, int ty, int band);
  int find(int tx, int ty, int band) const;
  Column* column_to_write(const CoverageVoxel& v);
  void add_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  /// Forgets the hits of what left, after the rays of a scan.
  void forget_what_left();
  /// Counts a scan for the voxels of a column that it passed, and against those that it hit.
  void count(int x, int y, int band, std::uint16_t passed, std::uint16_t hits);

  std::vector<Tile> tiles_{};
  std::unordered_map<std::uint64_t, int> index_{};  ///< Looked up only.
  int last_{-1};                                    ///< Tile that was written last.
  Window window_{};
};

}  // namespace adit::nav
