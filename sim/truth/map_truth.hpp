// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <unordered_set>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "core/time/time.hpp"
#include "sim/world/lidar.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {

/// A map as somebody has it: cubes that are known to be occupied or free, by their centres in the map frame,
/// which is the world's, m.
struct MapVoxels {
  double edge{0.2};  ///< Of every cube, m, (0, 2].
  std::vector<Eigen::Vector3f> occupied{}, free{};
};

/// How right a map is.
struct MapJudgement {
  double share{};           ///< Share of the seen surface that the map holds, [0, 1].
  double wrong_occupied{};  ///< Share of the occupied voxels that are far from any surface, [0, 1].
  double wrong_free{};      ///< Share of the free voxels that are solid, [0, 1].
  double area{};            ///< Seen surface, m2, in patches of 0.1 m.
  /// The larger one of the two.
  double wrong() const { return wrong_occupied > wrong_free ? wrong_occupied : wrong_free; }
};

/// Limits of the judgement, m.
struct MapLimits {
  double held{0.15};  ///< A point of the surface is in the map if an occupied voxel's box is this near.
  double far{0.2};    ///< An occupied voxel is wrong if no surface is this near to its box.
};

/// Judges a map by the world and by points of its surface that were truly seen. A free voxel is wrong if its
/// centre is solid.
MapJudgement judge_map(const MapVoxels& map, std::span<const Eigen::Vector3f> surface, const World& world,
                       const MapLimits& limits = {});

/// The surface of a world that the lidars of robots truly saw, whatever the robots believe: where their rays
/// end within 20 m, one point for each cube of 0.1 m. Bodies of other robots and people hide nothing.
class SeenSurface {
 public:
  static constexpr double kRange = 20.0;  ///< m
  static constexpr double kPatch = 0.1;   ///< m

  SeenSurface(std::shared_ptr<const World> world, std::span<const Platform> robots);

  /// The robot's lidar makes a turn where its base_link is (world frame).
  void look(std::size_t robot, const Pose3& base);
  /// In the order in which they were seen, world frame, m.
  const std::vector<Eigen::Vector3f>& points() const { return points_; }
  const World& world() const { return *world_; }

 private:
  std::shared_ptr<const World> world_;
  std::vector<Platform> robots_;
  std::vector<LidarPattern> lidars_{};
  std::unordered_set<std::uint64_t> known_{};  ///< Keys of the patches; never iterated over.
  std::vector<Eigen::Vector3f> points_{};
};

/// Looks from where robots are as time goes on; what stands still looks once.
class SeenSurfaceRecord {
 public:
  static constexpr Duration kPeriod{200ms};  ///< Between the looks.

  explicit SeenSurfaceRecord(SeenSurface surface) : surface_(std::move(surface)) {}
  void look(std::size_t robot, const Pose3& base);
  const SeenSurface& surface() const { return surface_; }

 private:
  SeenSurface surface_;
  std::map<std::size_t, Pose3> looked_{};  ///< By robot: from where it looked last.
};

}  // namespace adit::sim
