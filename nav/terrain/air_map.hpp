// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "core/geometry/scan_points.hpp"
#include "nav/geometry/footprint.hpp"

namespace adit::nav {

/// Obstacle map of a flying robot: 5 cm cells with returns at the height of its body. Returns below and
/// above, the ground included, do not count. The size is fixed, and nothing is allocated after construction.
class AirMap {
 public:
  static constexpr std::size_t kMax = 8192;  ///< Maximum number of cells().

  explicit AirMap(const Platform& platform);

  /// Takes one scan: points in base_link, m; pose of the body in the odometry frame; time, s.
  void add_scan(const ScanPoints& scan, const Pose3& body, double stamp_s);
  /// Centres of the occupied cells, odometry frame, m.
  std::span<const Eigen::Vector2f> cells() const { return cells_; }
  void clear();

 private:
  static constexpr int kSide = 256;  ///< Cells; the grid rolls with the robot.
  static constexpr float kCell = 0.05f;
  struct Cell {
    std::int32_t i{}, j{};
    float z{};  ///< Odometry frame, m.
    double seen{};
    std::uint8_t scans{};  ///< Number of scans with a return here, at most kSure; 0: free.
  };
  static constexpr std::uint8_t kSure = 2;  ///< A single return may be noise.

  Cell& cell(std::int32_t i, std::int32_t j) { return grid_[(j & (kSide - 1)) * kSide + (i & (kSide - 1))]; }

  Platform platform_;
  Footprint body_;
  std::vector<Cell> grid_;
  std::vector<Eigen::Vector2f> cells_{};
};

}  // namespace adit::nav
