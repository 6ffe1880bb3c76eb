// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "core/time/time.hpp"
#include "perception/map/block.hpp"

namespace adit::bench {

/// Compares what the station shows of each robot's map with what the robot has. A cell is a cube of 0.4 m in
/// the lattice of a robot's odometry frame; it is known once any of its voxels of 0.2 m is. Cells count that
/// the robot knows at present: one that held a single wrong return may be unknown again.
class Watch {
 public:
  explicit Watch(std::size_t robots) : robots_(robots) {}

  void robot_has(std::size_t robot, const perception::CoarseBlock& block, Time now);
  /// A state of some cells left the robot for the first time.
  void was_sent(std::size_t robot, const perception::BlockIndex& at, std::uint64_t known, Time now);
  void station_shows(std::size_t robot, const perception::CoarseBlock& block, Time now);

  /// Blocks that the station shows otherwise than the robots.
  std::size_t different() const { return static_cast<std::size_t>(different_); }
  std::size_t seen() const { return static_cast<std::size_t>(seen_); }
  std::size_t known() const { return static_cast<std::size_t>(known_); }
  double share() const { return seen_ == 0 ? 1.0 : static_cast<double>(known_) / static_cast<double>(seen_); }
  /// Ages at which cells came to be known at the station, rising; those that never did have kNever.
  std::vector<Duration> ages() const;
  /// The same until they were sent first.
  std::vector<Duration> waits() const;
  static constexpr Duration kNever = Duration::max();

 private:
  struct Block {
    std::uint64_t known{}, occupied{};              ///< At the robot.
    std::uint64_t shown_known{}, shown_occupied{};  ///< At the station.
    std::array<std::optional<Time>, 8> first{}, sent{}, arrived{};
    bool differs() const { return known != shown_known || occupied != shown_occupied; }
  };
  std::vector<Duration> delays(std::array<std::optional<Time>, 8> Block::*until) const;

  /// Adds what a block counts for, or takes it away.
  void count(const Block& block, int sign);

  std::vector<std::map<perception::BlockIndex, Block>> robots_;
  std::ptrdiff_t different_{}, seen_{}, known_{};
};

/// The value below which a share of a sorted list lies, s; below 0: never.
double quantile(const std::vector<Duration>& sorted, double share);

}  // namespace adit::bench
