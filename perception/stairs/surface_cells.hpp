// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <bitset>
#include <cstdint>
#include <span>
#include <vector>

namespace adit::perception {

/// What lies in a column of the ground's plane and is no higher than a step: its mean stands for the surface
/// there, which averages the range noise.
struct SurfaceCell {
  Eigen::Vector3f mean{Eigen::Vector3f::Zero()};  ///< m
  std::uint32_t count{};
  int column{};
};

/// Surfaces around a place: columns of 10 cm, and in each the heights that are occupied without a gap. What
/// is higher than a step, as walls and people, is left out.
class SurfaceCells {
 public:
  static constexpr int kSide = 120;  ///< Columns along an edge.
  static constexpr float kEdge = 0.1f;
  static constexpr float kReach = kSide * kEdge / 2;  ///< In x and y, m.
  static constexpr float kHeight = 3.2f;              ///< Upwards and downwards, m.

  static constexpr int kMostInColumn = 40;  ///< Points of a column that are used: the last ones.

  /// @param points  In a level frame, m, the oldest first.
  /// @param centre  Of the columns, m; heights count from it.
  void build(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& centre);

  /// The points that are used.
  const std::vector<Eigen::Vector3f>& points() const { return points_; }
  const std::vector<SurfaceCell>& cells() const { return cells_; }
  /// The cells of a column, from below.
  std::span<const SurfaceCell> at(int x, int y) const {
    if (x < 0 || y < 0 || x >= kSide || y >= kSide) return {};
    const auto column = static_cast<std::size_t>(y * kSide + x);
    return std::span(cells_).subspan(first_[column], first_[column + 1] - first_[column]);
  }

 private:
  static constexpr float kBin = 0.05f;  ///< Of heights, m.
  static constexpr int kBins = 128;
  static constexpr int kGap = 6;      ///< Bins without a return that end a surface.
  static constexpr int kTallest = 8;  ///< Bins: a riser of 25 cm and its noise.

  std::vector<Eigen::Vector3f> points_{};
  struct Place {
    int column, bin;
  };
  std::vector<Place> places_{};  ///< Of the points.
  std::vector<std::uint16_t> counts_{};
  std::vector<std::bitset<kBins>> heights_{};
  std::vector<std::size_t> first_{};
  std::vector<SurfaceCell> cells_{};
  struct Run {
    int begin, end;
  };
  std::vector<Run> runs_{};
};

}  // namespace adit::perception
