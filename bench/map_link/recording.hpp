// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>

#include "bench/map_link/ground.hpp"
#include "robot_agent/perception/map_part.hpp"

namespace adit::bench {

/// One change of a robot's map.
struct MapUpdate {
  Duration at{};  ///< Since the mission's begin.
  agent::MapStep step{};
};

/// What a robot's map did during a mission, to be sent by any rule.
struct MapRecording {
  std::string robot{};
  Pose3 T_map_odom{};  ///< Constant: the odometry has no drift.
  Duration length{};
  std::vector<MapUpdate> updates{};
};

/// The block of the odometry frame's lattice at a submap's origin: block i of the submap is block i + offset.
perception::BlockIndex lattice_offset(const Pose3& T_odom_submap);

/// A robot with a lidar of 16 x 900 beams at 1 m/s that goes where it was least, with the agent's own choice
/// of scans and submaps. `number` from 0: robots of one mission begin apart from each other.
MapRecording record(const Ground& ground, std::uint64_t seed, int number, Duration length);
/// Several robots in one world, recorded at once.
std::vector<MapRecording> record_team(const Ground& ground, std::uint64_t seed, int robots, Duration length);

/// A map merged from the submaps of one robot, in the lattice of its odometry frame.
class LatticeMap {
 public:
  /// Sets a block of a submap and returns what the merge shows there now.
  perception::CoarseBlock set(std::uint32_t submap, const perception::CoarseBlock& block,
                              const perception::BlockIndex& offset);
  const std::map<perception::BlockIndex, perception::CoarseBlock>& shown() const { return shown_; }

 private:
  std::map<perception::BlockIndex, std::map<std::uint32_t, perception::CoarseBlock>> votes_{};
  std::map<perception::BlockIndex, perception::CoarseBlock> shown_{};
};

/// What of a block of 4 x 4 x 4 voxels is known, as eight cells of 0.4 m: bit x + 2 y + 4 z.
std::uint8_t known_cells(std::uint64_t known);
/// Area of the ground under what is known, m2.
double ground_area(const std::map<perception::BlockIndex, perception::CoarseBlock>& blocks);

}  // namespace adit::bench
