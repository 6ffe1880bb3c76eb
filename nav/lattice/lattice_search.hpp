// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "nav/lattice/clear_field.hpp"
#include "nav/lattice/motion_set.hpp"
#include "nav/lattice/way_field.hpp"

namespace adit::nav {

struct LatticeSearchParams {
  MotionSetParams motions{};
  double margin{0.06};        ///< kept free around the body, m, [0.02, 0.5]
  double tight_margin{0.02};  ///< the same where nothing else is left, from point to outline, m, [0.005, 0.5]
  double comfort{0.25};       ///< beyond the margin; nearer to obstacles a way costs more, m, [0, 2]
  double crowded{2.0};        ///< by so much more at the margin, [0, 20]
  double rough{5.0};          ///< by so much more on ground of cost 1, [0, 100]
  double reach{3.5};          ///< the path to a far target ends so far from its start, m, [1, 4]
  double goal_radius{0.15};   ///< a path to a goal ends so near to it, m, [0.05, 1]
  double reverse_cost{1.6};   ///< of a metre backwards, in metres ahead, [1, 10]
  double change_cost{0.8};    ///< of changing between ahead and backwards, m, [0, 10]
  double steer_cost{0.04};    ///< of changing the curvature by a level, m, [0, 1]
  double least_gain{0.3};     ///< a path that comes to no target must bring it nearer by this, m, [0, 2]
  int expansions{3000};       ///< at most, [100, 20000]
};

/// What a search starts from and where it shall lead; the frame of the fields, m.
struct LatticeTask {
  int level{-1};     ///< of the present curvature; -1: so slow that any comes at once
  int direction{0};  ///< in which it drives, 1 or -1; 0: stands, either is as good
  Eigen::Vector2d target{0, 0};
  bool goal{true};              ///< the target is a place to come to, not only a direction
  bool tight{false};            ///< only the tight margin is kept
  int only{0};                  ///< may drive in this direction only, 1 or -1; 0: both
  double heading{0};            ///< rad, of the way (not of the body) ...
  double spread{M_PI};          ///< ... which paths may leave by so much
  std::optional<Pose2> gate{};  ///< the path shall end behind a gap with this middle, straight through it
  double room{0};               ///< width of that gap, m; 0: no more than the body needs
};

/// A path over motions: its start, kPoses poses of each motion, and what leads through a gap, as far apart.
struct LatticePath {
  static constexpr std::size_t kMost = 256;
  struct Spot {
    Pose2 pose{};
    float cost{};             ///< from the start, m
    std::int8_t direction{};  ///< in which it is driven to; the first one: in which it is left
  };
  std::array<Spot, kMost> spots{};
  std::size_t count{0};
  int direction_changes{0};
  bool tight{false};     ///< keeps only the tight margin
  bool through{false};   ///< leads through a gap, as LatticeTask::gate asks
  bool complete{false};  ///< ends at the goal, or at the reach of the search
  double left{0};        ///< way from its end to the target, m

  /// It is driven in one direction only.
  bool straight_on() const { return count < 2 || direction_changes == 0; }
  double cost() const { return count == 0 ? 0.0 : static_cast<double>(spots[count - 1].cost); }
};

/// Hybrid A* (D. Dolgov et al., "Path planning for autonomous vehicles in unknown semi-structured
/// environments", IJRR 2010) over a MotionSet in the few metres around the robot, led by a WayField. States
/// are told apart by place, heading and direction. The body is a row of discs along its axis; with the tight
/// margin, its outline among the obstacles' points. To a gap it looks for a smooth curve onto the gap's axis
/// from each state it comes to (the analytic expansion of the same authors; quintic polynomials), since none
/// of its motions would ever meet so narrow a place. Fixed size; nothing is allocated after construction.
class LatticeSearch {
 public:
  explicit LatticeSearch(const Platform& platform, const LatticeSearchParams& params = {});

  /// The cheapest path that it finds; false when none leads nearer to the target.
  bool find(const ClearField& clear, const WayField& way, const LatticeTask& task, LatticePath& path);
  /// Whether the body stands free there, with all but `less` of its margin, or of the tight one, m.
  bool free(const ClearField& clear, const Pose2& pose, bool tight, float less) const;
  const MotionSet& motions() const { return motions_; }
  const LatticeSearchParams& params() const { return params_; }

 private:
  struct Node {
    Pose2 pose{};
    float cost{}, way{}, length{};
    std::int32_t parent{-1};
    std::int8_t level{}, direction{}, from{};  ///< from: the level in which its motion began
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
  static constexpr std::size_t kMostNodes = 40000;
  static constexpr std::size_t kMostDiscs = 12;

  /// What driving there costs per metre; negative: it cannot be driven.
  float price(const ClearField& clear, const Pose2& pose, bool leaving) const;
  bool outline_free(const ClearField& clear, const Pose2& pose, float allowed) const;
  /// Appends the way from a node through the task's gate.
  bool shoot(const ClearField& clear, const LatticeTask& task, std::int32_t index, LatticePath& path) const;
  bool shoot_onto(const ClearField& clear, const LatticeTask& task, std::int32_t index, double straight_from,
                  LatticePath& path) const;
  std::int32_t state(const Pose2& pose, int direction) const;
  void expand(const ClearField& clear, const WayField& way, const LatticeTask& task, std::int32_t index);
  bool ends(const WayField& way, const LatticeTask& task, const Node& node) const;
  void write(std::int32_t index, LatticePath& path) const;

  LatticeSearchParams params_;
  MotionSet motions_;
  double base_;                            ///< base_link ahead of the poses' origin, m
  double width_;                           ///< of the body, m
  std::array<float, kMostDiscs> discs_{};  ///< middles along the body's axis, from the poses' origin, m
  std::array<float, kMostDiscs> least_{};  ///< clearance of each where the search began, m
  std::size_t disc_count_{};
  float wide_{};       ///< radius of the discs with the margin, m
  Footprint outline_;  ///< with the tight margin
  double front_;       ///< from the poses' origin to the foremost point of the body, m
  bool tight_{false};  ///< the search under way keeps no more
  float depth_{0};     ///< of the deepest point in the outline where it began, m
  std::vector<Node> nodes_{};
  std::vector<Open> open_{};
  std::vector<std::uint32_t> closed_;
  std::uint32_t round_{0};
};

}  // namespace adit::nav
