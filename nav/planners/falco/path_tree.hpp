// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"

namespace adit::nav {

/// Parameters of the trajectory library.
struct PathTreeParams {
  double segment{1.0};  ///< Length of each of the three generations, m, [0.2, 3].
  /// Maximum curvature of each generation, rad/m, [0, 4]. The seven children of a node are spread evenly over
  /// [-c, c]. Later generations bend less, because the fan is already wide enough far ahead.
  std::array<double, 3> curvature{0.95, 0.80, 0.65};
  double blend{0.25};    ///< Length over which one curvature changes into the next, m, (0, segment].
  double spacing{0.05};  ///< Distance between the poses of a path, m, [0.01, 0.2].
};

/// Trajectory library: a tree of three generations with seven children each, which makes 343 paths in seven
/// groups. A path starts at the origin along +x. After J. Zhang et al., "Falco: Fast likelihood-based
/// collision avoidance with extension to human-guided navigation", J. Field Robotics 2020. Falco's generator
/// fits splines through bearings; this one integrates a piecewise linear curvature, so the demand of a path
/// on the robot (turn rate / speed) is bounded by construction.
///
/// A path is checked in seven *stages*: four quarters of its first segment, two halves of its second, and its
/// third. Each (stage, node) has one bit, so a mask of 512 bits holds the path parts that an obstacle blocks,
/// and the free length of every path follows from the union of masks.
class PathTree {
 public:
  static constexpr int kFan = 7;
  static constexpr int kGroups = kFan;
  static constexpr int kPaths = kFan * kFan * kFan;
  static constexpr int kStages = 7;
  /// Number of distinct nodes in each stage, and the first bit of each stage.
  static constexpr std::array<int, kStages> kNodes{7, 7, 7, 7, 49, 49, 343};
  static constexpr std::array<int, kStages + 1> kFirstBit{0, 7, 14, 21, 28, 77, 126, 469};

  explicit PathTree(const PathTreeParams& params = {});

  /// Length from the start of a path to the end of a stage, m.
  double stage_end(int stage) const { return stage_end_[stage]; }
  double length() const { return stage_end_[kStages - 1]; }
  /// The first stage that reaches `distance` (m), or the last one.
  int stage_for(double distance) const;

  /// All poses of a path, `params.spacing` apart, in the frame of its start.
  std::span<const Pose2> path(int path) const { return {&poses_[path * per_path_], per_path_}; }
  /// Index of the last pose within a stage.
  std::size_t last_pose(int stage) const { return last_pose_[stage]; }
  /// Bearing from the start of a path to the end of `node` in `stage`, degrees.
  float end_bearing(int stage, int node) const { return bearing_[kFirstBit[stage] + node]; }
  /// A path through `node` of `stage`.
  static int path_through(int stage, int node) { return node * (kPaths / kNodes[stage]); }
  const PathTreeParams& params() const { return params_; }

 private:
  PathTreeParams params_;
  std::size_t per_path_{};
  std::array<double, kStages> stage_end_{};
  std::array<std::size_t, kStages> last_pose_{};
  std::vector<Pose2> poses_{};
  std::vector<float> bearing_{};
};

}  // namespace adit::nav
