// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "nav/planners/hybrid_astar/cost_to_go.hpp"
#include "nav/planners/hybrid_astar/distance_field.hpp"
#include "nav/planners/hybrid_astar/motion_primitives.hpp"

namespace adit::nav {

/// Start and target of a search; frame of the fields, m.
struct HybridAStarTask {
  int level{-1};     ///< Index of the present curvature; -1: the robot is so slow that it can start with any.
  int direction{0};  ///< Present driving direction, 1 or -1; 0: stationary.
  Eigen::Vector2d target{0, 0};
  bool goal{true};      ///< The target is a place to reach; else a direction.
  bool tight{false};    ///< Uses only the tight margin.
  bool turns{false};    ///< May turn on the spot; with the tight margin it always may, if the robot can.
  int only{0};          ///< Permitted driving direction, 1 or -1; 0: both.
  double heading{0};    ///< Reference heading of the path (not of the body), rad.
  double spread{M_PI};  ///< Maximum deviation from it, rad.
  std::optional<Pose2> passage{};  ///< The path must end behind a gap with this middle, straight through it.
  double room{0};                  ///< Width of that gap, m; 0: just wide enough for the body.
};

/// A path: its start, kPoses poses of each motion, and the part through a gap at the same spacing.
struct HybridAStarPath {
  static constexpr std::size_t kMax = 256;
  /// A pose of the path.
  struct Spot {
    Pose2 pose{};
    float cost{};  ///< From the start, m.
    /// Direction in which it is reached, 0: by a turn on the spot; for the first one: in which it is left.
    std::int8_t direction{};
  };
  std::array<Spot, kMax> spots{};
  std::size_t count{0};
  int direction_changes{0};
  bool tight{false};     ///< Keeps only the tight margin.
  bool through{false};   ///< Leads through a gap, see HybridAStarTask::passage.
  bool complete{false};  ///< Ends at the goal, or at the reach of the search.
  double left{0};        ///< Cost to go from its end to the target, m.

  /// Whether it is driven in one direction only.
  bool straight_on() const { return count < 2 || direction_changes == 0; }
  double cost() const { return count == 0 ? 0.0 : static_cast<double>(spots[count - 1].cost); }
};

/// Hybrid A* (D. Dolgov et al., "Path planning for autonomous vehicles in unknown semi-structured
/// environments", IJRR 2010) over the motions of a MotionPrimitives in the few metres around the robot, with
/// a CostToGo as heuristic. States are distinguished by position, heading and direction. The body is checked
/// as a row of discs along its axis; with the tight margin, as its outline against the obstacles' points. For
/// a gap, each expanded state tries a smooth curve onto the gap's axis (the analytic expansion of the same
/// authors, with quintic polynomials), because no sequence of motions meets such a narrow place. The size is
/// fixed, and nothing is allocated after construction.
class HybridAStarSearch {
 public:
  static constexpr double kMargin = 0.06;  ///< Clearance around the body, m.
  /// Clearance when nothing else is free, from point to outline, m.
  static constexpr double kTightMargin = 0.02;

  explicit HybridAStarSearch(const Platform& platform);

  /// Finds the path of least cost; false when none leads nearer to the target.
  bool find(const DistanceField& field, const CostToGo& cost_to_go, const HybridAStarTask& task,
            HybridAStarPath& path);
  /// Whether the body is free at `pose` with its margin, or the tight one, reduced by `less`, m.
  bool free(const DistanceField& field, const Pose2& pose, bool tight, float less) const;
  const MotionPrimitives& motions() const { return primitives_; }

 private:
  struct Node {
    Pose2 pose{};
    float cost{}, cost_to_go{}, length{};
    std::int32_t parent{-1};
    /// `direction` is 0 after a turn on the spot; `from`: curvature index at the start of its motion, or the
    /// side of the turn.
    std::int8_t level{}, direction{}, from{};
  };
  struct Open {
    float rank;
    std::int32_t node;
    bool operator<(const Open& other) const {
      return rank != other.rank ? rank > other.rank : node > other.node;
    }
  };
  static constexpr int kCells = 76, kHeadings = 48;
  static constexpr float kCell = 0.125f;
  static constexpr std::size_t kMaxNodes = 40000;
  static constexpr std::size_t kMaxDiscs = 12;

  /// Cost per metre at a pose; negative: impassable.
  float price(const DistanceField& field, const Pose2& pose, bool leaving) const;
  bool outline_free(const DistanceField& field, const Pose2& pose, float allowed) const;
  /// Appends the path from a node through the task's gap.
  bool expand_analytically(const DistanceField& field, const HybridAStarTask& task, std::int32_t index,
                           HybridAStarPath& path) const;
  bool connect_to_axis(const DistanceField& field, const HybridAStarTask& task, std::int32_t index,
                       double straight_from, HybridAStarPath& path) const;
  std::int32_t state(const Pose2& pose, int direction) const;
  void expand(const DistanceField& field, const CostToGo& cost_to_go, const HybridAStarTask& task,
              std::int32_t index);
  void turn_on_spot(const DistanceField& field, std::int32_t index);
  void add(Node next);
  bool ends(const CostToGo& cost_to_go, const HybridAStarTask& task, const Node& node) const;
  void write(std::int32_t index, HybridAStarPath& path) const;

  MotionPrimitives primitives_;
  double base_;                           ///< Distance of base_link ahead of the poses' origin, m.
  double width_;                          ///< Of the body, m.
  std::array<float, kMaxDiscs> discs_{};  ///< Centres along the body's axis, from the poses' origin, m.
  std::array<float, kMaxDiscs> least_{};  ///< Clearance of each disc at the start of the search, m.
  std::size_t disc_count_{};
  float wide_{};       ///< Radius of the discs with the margin, m.
  Footprint outline_;  ///< With the tight margin.
  double front_;       ///< From the poses' origin to the foremost point of the body, m.
  bool turns_;         ///< The robot can turn on the spot.
  bool tight_{false};  ///< The current search uses the tight margin.
  float depth_{0};     ///< Depth of the deepest point in the outline at the start, m.
  std::vector<Node> nodes_{};
  std::vector<Open> open_{};
  std::vector<std::uint32_t> closed_;
  std::uint32_t round_{0};
};

}  // namespace adit::nav
