// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "nav/footprint.hpp"

namespace adit::nav {

struct AirMapParams {
  double margin{0.12};        ///< above and below the body that is kept free, too, m, [0, 1]
  double reach{5.0};          ///< what is farther from the robot does not matter, m, [1, 6]
  double own{0.03};           ///< returns so close around the footprint are the body itself, m, [0, 0.5]
  double memory{0.7};         ///< what the lidar should see again is kept so long, s, [0.1, 10]
  double hidden_memory{8.0};  ///< what it cannot, above or below its rays or too near, s, [0.1, 60]
  double shortest{0.4};       ///< nearer to the lidar nothing may be seen, m, [0, 1]
};

/// The obstacles of what flies: whatever was seen at the height of its body, as cells of 5 cm; what is below
/// and above, ground as well, does not count. Fixed size; nothing is allocated after construction.
class AirMap {
 public:
  static constexpr std::size_t kMost = 8192;  ///< cells that cells() gives

  explicit AirMap(const Platform& platform, const AirMapParams& params = {});

  /// One scan: points in base_link, m; the body in the odometry frame then; the time, s.
  void add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s);
  /// Middles of the cells that are not free, odometry frame, m.
  std::span<const Eigen::Vector2f> cells() const { return cells_; }
  void clear();

 private:
  static constexpr int kSide = 256;  ///< cells; the grid rolls with the robot
  static constexpr float kCell = 0.05f;
  struct Cell {
    std::int32_t i{}, j{};
    float z{};  ///< odometry frame, m
    double seen{};
    std::uint8_t scans{};  ///< that showed it, at most kSure; 0: free
  };
  static constexpr std::uint8_t kSure = 2;  ///< one return alone may be noise

  Cell& cell(std::int32_t i, std::int32_t j) {
    return grid_[static_cast<std::size_t>((j & (kSide - 1)) * kSide + (i & (kSide - 1)))];
  }

  Platform platform_;
  AirMapParams params_;
  Footprint body_;
  std::vector<Cell> grid_;
  std::vector<Eigen::Vector2f> cells_{};
};

}  // namespace adit::nav
