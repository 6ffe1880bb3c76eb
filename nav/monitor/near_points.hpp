// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/config/traversability.hpp"
#include "core/geometry/pose.hpp"
#include "core/geometry/scan_points.hpp"
#include "nav/geometry/footprint.hpp"
#include "nav/tracking/upright_range_image.hpp"

namespace adit::nav {

/// Obstacles near the robot by its newest scan alone, without a map or a ground model. A return is an
/// obstacle when it is higher than the ground can be at its distance, much higher than the return directly
/// below it, or at a place where an obstacle was seen before. Places that the newest scan cannot show, below
/// its lowest ray or nearer than its minimum range, come from earlier scans. All sizes but that of a scan are
/// fixed, and nothing is allocated after the first scan of its lidar's size.
///
/// Heights are in gravity-aligned axes, so a body that tilts over a stone sees the same obstacles as a level
/// one. The ground may be parallel to the body (on a ramp) or level (the body alone tilts): a return is an
/// obstacle only if it is too high above the higher of both planes, and is examined from the lower one on.
class NearPoints {
 public:
  static constexpr std::size_t kMax = 4096;        ///< Maximum number of places; the nearest remain.
  static constexpr double kMaxUncertainty = 0.05;  ///< Upper limit of Place::uncertainty, m.
  /// Position of an obstacle, odometry frame, m: the mean of the returns in one 5 cm cell.
  struct Place {
    float x{}, y{};
    float z{};            ///< Of the highest return, m.
    float uncertainty{};  ///< Three standard deviations of the mean, m: the obstacle may be this much nearer.
    double seen{};
  };

  /// `reach`: radius around base_link, m, (0, 4].
  NearPoints(const Platform& platform, double reach);

  /// Takes a scan; pose of the body in the odometry frame; time, s; and the range image of the scan.
  void take(const ScanPoints& scan, const Pose3& body, double stamp_s, const UprightRangeImage& seen);
  /// Forgets all places.
  void clear() { places_.clear(); }
  std::span<const Place> places() const { return {places_.data(), places_.size()}; }

 private:
  static constexpr int kSide = 160;  ///< Cells of 5 cm.
  static constexpr int kCoarse = 80;
  static constexpr float kCell = 0.05f;
  /// Sums of x and y, and the highest z, in level axes at base_link, m.
  struct Cell {
    float x, y, z;
    std::uint16_t count;
  };
  /// A return above the step.
  struct Raised {
    Eigen::Vector3f at;  ///< In level axes at base_link, m.
    float x, y;          ///< base_link, m.
    float below;         ///< Height of the lower one of the two planes of the ground, m.
  };
  /// Elevation range of the rays of the newest scan's first lidar, rise per metre.
  struct Fan {
    Eigen::Vector3d lidar{0, 0, 0};  ///< base_link, m.
    float lowest{1e9f}, highest{-1e9f};
  };

  /// Index of the cell of (x, y) in a square of `side` cells of `size` metres around base_link.
  static std::size_t index(float x, float y, float size, int side) {
    const int i = static_cast<int>(x / size + static_cast<float>(side) / 2);
    const int j = static_cast<int>(y / size + static_cast<float>(side) / 2);
    return static_cast<std::size_t>(j * side + i);
  }
  static std::size_t coarse(float x, float y) { return index(x, y, 2 * kCell, kCoarse); }
  static std::size_t fine(float x, float y) { return index(x, y, kCell, kSide); }
  /// Calls `visit(cell)` for a cell and those around it.
  template <class Visit>
  void visit_around(std::uint32_t index, Visit&& visit) const {
    for (const int row : {-kSide, 0, kSide})
      for (int k = -1; k <= 1; ++k)
        if (const auto at = std::int64_t{index} + row + k; at >= 0 && at < std::ssize(cells_))
          visit(cells_[at]);
  }
  /// Tilt of the body. Level axes are those of base_link turned upright, with its yaw.
  struct Tilt {
    Eigen::Matrix3f R_level_base{Eigen::Matrix3f::Identity()};
    Eigen::Vector2f rise{0, 0};  ///< Of the plane under the body, per metre along the level x and y.
    float slope{};               ///< Maximum rise of the ground per metre outside of the footprint.
  };
  Tilt tilt_of(const Pose3& body) const;
  Fan fan_of(const ScanPoints& scan) const;
  void sort_in(const ScanPoints& scan, const Tilt& tilt);
  /// Whether the ground was seen one step before `p`: flat, at most `highest`, and at most `rise` lower.
  bool tread_leads_to(const Eigen::Vector3f& p, float range, float highest, float rise) const;
  bool seen_again(const Eigen::Vector2f& local) const;
  void remember(const Pose3& body, const Tilt& tilt, const Fan& fan, double stamp_s,
                const UprightRangeImage& seen);
  bool hidden(const Eigen::Vector3d& local, const Fan& fan) const;
  bool seen_past(const Eigen::Vector3d& local, const Pose3& body, const Fan& fan,
                 const UprightRangeImage& seen) const;

  Platform platform_;
  Traversability limits_;
  Footprint body_;
  float reach_;
  std::vector<float> lowest_;   ///< Lowest return in each 10 cm cell, m.
  std::vector<float> upper_;    ///< Highest return in each 10 cm cell that the robot cannot pass under, m.
  std::vector<float> highest_;  ///< Highest return in each 5 cm cell that is too high to step on, m.
  std::vector<Cell> cells_;
  std::vector<Raised> raised_{};  ///< Those of the newest scan are the first ones.
  std::vector<std::uint32_t> used_{};
  std::vector<Place> places_{}, remembered_{};
};

}  // namespace adit::nav
