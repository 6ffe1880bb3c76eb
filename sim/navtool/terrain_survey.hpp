// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "nav/local_map/local_map_builder.hpp"

namespace adit::sim {

/// Cells by class.
using TerrainCounts = std::array<std::size_t, nav::kCellClasses>;

/// The last class of each cell that came within range of a robot on its way. Classes are those of the robot's
/// local map, which a survey computes farther away than a robot does.
class TerrainSurvey {
 public:
  static constexpr double kCell = 0.1;                 ///< As nav::GroundGrid's, m.
  static constexpr double kMaxRange = 20.0;            ///< Of a terrain map, m.
  static constexpr std::size_t kMaxCells = 8'000'000;  ///< Further cells are left out.

  /// `range`: of the survey around the body, m, (0, 100]; the terrain map's own range is at most kMaxRange.
  TerrainSurvey(const Platform& platform, double range);

  /// See nav::TerrainMap::add_scan.
  void add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s);

  TerrainCounts counts() const;
  /// The unknown cells of counts() over which no scan had a return within range: walls and cars hide them.
  std::size_t hidden() const;
  /// Share of the unknown cells among those over which at least one scan had a return within range.
  double unknown_share() const;
  /// The same of all scans, each with the terrain map's window as it then was: a cell counts once a scan.
  const TerrainCounts& scan_counts() const { return scan_counts_; }
  /// Share of the cells with a drop among those known to be ground, step, slope or drop; 0 when there are
  /// none.
  static double drop_share(const TerrainCounts& counts);
  /// Calls `use(middle, class)` for each cell, in no order.
  template <class Use>
  void for_each(const Use& use) const {
    for (const auto& [key, cell] : cells_)
      use(Eigen::Vector2d((static_cast<double>(key.first) + 0.5) * kCell,
                          (static_cast<double>(key.second) + 0.5) * kCell),
          cell.kind);
  }

 private:
  using Key = std::pair<std::int32_t, std::int32_t>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      const auto word = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.first)) << 32) |
                        static_cast<std::uint32_t>(key.second);
      return static_cast<std::size_t>(word * 0x9e3779b97f4a7c15ULL >> 16);
    }
  };
  struct Cell {
    nav::CellClass kind{};
    bool covered{false};  ///< A scan had a return over it.
  };
  nav::TerrainMap map_;
  nav::LocalMapBuilder builder_{};
  double range_;
  TerrainCounts scan_counts_{};
  std::vector<nav::CellClass> window_{};  ///< Of the terrain map's window.
  std::unordered_map<Key, Cell, Hash> cells_{};
};

}  // namespace adit::sim
