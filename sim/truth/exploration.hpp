// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "sim/truth/cells.hpp"
#include "sim/world/lidar.hpp"

namespace adit::sim {

/// A robot that explores.
struct ExplorationRobot {
  Platform platform{};
  Pose2 start{};  ///< World frame.
};

/// A rectangle of the floor plan, world frame, m.
struct ExplorationArea {
  double x0{}, y0{}, x1{}, y1{};
};

/// Connected cells that can be seen, and were not.
struct UnseenPatch {
  std::size_t cells{};
  Eigen::AlignedBox3d box{};  ///< World frame, m.
  int places{};               ///< The most places from which one of its cells can be seen.
};

/// How much of a world the lidars of robots truly saw, whatever the robots believe: the share of the cells of
/// 0.5 m that they saw of those that can be seen at all.
///
/// A cell is seen once a ray of a lidar passed through it, or ended in it, within 12 m. It can be seen when
/// that is so from a place, on a grid of 0.8 m, where a robot can stand and to which it can drive from its
/// start, and when its centre is not beyond all that is seen. Bodies of
/// other robots and people hide nothing. The same yardstick as that of docs/references.md, TARE. Robots that
/// fly are taken to stay over ground on which their body could stand.
class ExplorationTruth {
 public:
  static constexpr double kRange = 12.0;  ///< Farther away a lidar sees too sparsely to count, m.
  static constexpr std::size_t kMostRobots = 64;

  /// Reason::bad_argument for no robot, for more than kMostRobots, and for a world in which they see nothing.
  static Result<ExplorationTruth> create(std::shared_ptr<const World> world,
                                         std::span<const ExplorationRobot> robots);

  /// The robot's lidar makes a turn where its base_link is (world frame).
  void look(std::size_t robot, const Pose3& base);

  /// Cells that can be seen at all.
  std::size_t possible() const { return possible_count_; }
  /// Of those, how many the robots have seen.
  std::size_t seen() const { return seen_count_; }
  /// Share seen so far, [0, 1].
  double share() const { return static_cast<double>(seen_count_) / static_cast<double>(possible_count_); }
  /// The share of the cells whose centre is in `area`, seen by any of `robots` (empty: by any at all), [0,
  /// 1]; 1 when none can be seen there.
  double share(const std::optional<ExplorationArea>& area, std::span<const std::size_t> robots) const;
  /// What the robots did not see, the largest patch first.
  std::vector<UnseenPatch> unseen() const;
  /// Share of the seen cells that more than one robot saw, [0, 1].
  double overlap() const;
  /// Volume that the robots have seen, m3.
  double volume() const;

 private:
  ExplorationTruth(std::shared_ptr<const World> world, std::span<const ExplorationRobot> robots);
  void find_possible();
  /// What a lidar at `sensor` (world frame) sees: `mark` takes each cell, `end` where each ray ends.
  template <class Mark, class End>
  void turn(const LidarPattern& lidar, const Pose3& sensor, const Mark& mark, const End& end) const;

  std::shared_ptr<const World> world_;
  std::vector<ExplorationRobot> robots_;
  std::vector<LidarPattern> lidars_{};
  ExplorationCells cells_;
  std::vector<std::uint16_t> possible_;  ///< By cell: from how many places it can be seen.
  std::vector<std::uint64_t> seen_{};    ///< By cell, bit n: robot n saw it.
  std::size_t possible_count_{}, seen_count_{};
};

}  // namespace adit::sim
