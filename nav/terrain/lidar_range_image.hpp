// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "nav/geometry/ray.hpp"

namespace adit::nav {

/// Range image of one scan: the shortest range in each direction of the lidar; space before it is free.
/// Directions are binned by the diamond angle of their bearing and by the tangent of the elevation. A bin
/// stores its shortest range, so a ray that ended near wins over one that slipped past.
class LidarRangeImage {
 public:
  static constexpr int kColumns = 256;
  static constexpr int kRows = 100;

  void clear();

  /// Index of the bin of a direction in the lidar's frame; -1: outside of the image.
  static int bin_of(const Ray& ray) {
    const int row = row_of(ray.tangent);
    return row < 0 || row >= kRows ? -1 : row * kColumns + column_of(ray.bearing);
  }
  /// Adds a return; `bin`: its bin_of().
  void add(int bin, const Ray& ray) {
    if (ray.tangent < lowest_) lowest_ = ray.tangent;
    if (bin < 0) return;
    const float centimetres = ray.range * 100.0f;
    const auto value = centimetres < 65000.0f ? static_cast<std::uint16_t>(centimetres) : kFar;
    bins_[bin] = std::min(bins_[bin], value);  // A branch would be mispredicted often.
  }
  void add(const Ray& ray) { add(bin_of(ray), ray); }

  /// Whether a ray passed the line from `low` to `high` (lidar's frame, about upright) and went at least
  /// `beyond` metres farther.
  bool saw_through(const Eigen::Vector3f& low, const Eigen::Vector3f& high, float beyond) const;

  /// Tangent of the lowest ray of this scan: the lidar sees nothing below it.
  float lowest() const { return lowest_; }
  bool empty_at(int row, int column) const {
    return bins_[row * kColumns + (column & (kColumns - 1))] == kEmpty;
  }
  /// Tangent at the centre of a row.
  static float tangent_of(int row) { return (static_cast<float>(row) - 50.0f) * 0.02f; }
  /// Unit direction at the centre of a column.
  static Eigen::Vector2f direction_of(int column);
  static int column_of(const Eigen::Vector2f& direction) {
    return column_of(diamond_angle(direction.x(), direction.y()));
  }

 private:
  static constexpr std::uint16_t kEmpty = 0xffff;
  static constexpr std::uint16_t kFar = 0xfffe;

  static int row_of(float tangent) { return static_cast<int>(tangent * 50.0f + 50.5f); }  // 0.02 per row.
  static int column_of(float bearing) {
    return static_cast<int>(bearing * (kColumns / 4) + kColumns) & (kColumns - 1);
  }

  std::vector<std::uint16_t> bins_ = std::vector<std::uint16_t>(kColumns * kRows, kEmpty);
  float lowest_{};
};

}  // namespace adit::nav
