// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "nav/planners/falco/correspondence.hpp"
#include "nav/planners/falco/path_tree.hpp"
#include "nav/planners/falco/rotation.hpp"
#include "nav/planners/heading_hold.hpp"
#include "nav/planners/path_speed.hpp"
#include "nav/planners/planner.hpp"

namespace adit::nav {

/// Lookup tables of the local planner: its trajectory libraries, longest and widest first, and the rotation
/// table of the footprint. Immutable; robots of one platform can share it.
struct PlannerLibrary {
  /// A trajectory library with one scale and one set of margins.
  struct Option {
    PathTree tree;
    CorrespondenceGrid grid;
    CorrespondenceGrid back;  ///< For driving backwards; empty: equal to `grid`.
    double max_speed;         ///< Speed limit with these margins, m/s.
    int least_stage;          ///< Paths that are free for fewer stages are left to the next library.
    /// Wide margins: rough ground and headings far off the target are left to the next library.
    bool roomy{};
  };
  std::vector<Option> options{};
  RotationTable rotation{};

  /// Builds the tables (about 60 ms, 8 MB).
  static std::shared_ptr<const PlannerLibrary> build(const Platform& platform);
  /// The same, once per process for all platforms that need the same tables. For processes that start many
  /// agents; callable from any thread.
  static std::shared_ptr<const PlannerLibrary> shared(const Platform& platform);
};

/// The local planner `trajectories`: selects the heading, group and path of the trajectory library that lead
/// best towards the target. After Falco (see PathTree and CorrespondenceGrid): for 36 headings, the free
/// paths vote for their group, weighted by how well they lead to the target and how little the robot has to
/// turn. Differences from Falco:
/// - Headings are counted from the target's bearing, so the straight line to the target is one of them.
///   Towards a goal, the robot's own heading and the opposite one are two more, so a robot without room to
///   turn can drive straight ahead or back.
/// - One pass over the obstacles yields the free length of all paths; Falco repeats it for each range.
/// - The footprint is swept along each path, and a heading counts only when the turn on the spot towards it
///   is free or, failing that, when the robot can reach it by driving backwards.
/// - A stick held straight ahead or back holds the robot's heading (see HeadingHold), so the robot passes an
///   obstacle and stops at a wall instead of following it.
/// - Passable ground with a cost lowers the weight and the speed of paths across it.
/// - Shorter paths and tighter margins are further libraries of the true footprint. Falco scales the obstacle
///   points, which would scale the robot as well.
class FalcoPlanner final : public Planner {
 public:
  static constexpr int kHeadings = 36;

  /// `library`: of this platform; built here when null.
  explicit FalcoPlanner(const Platform& platform, std::shared_ptr<const PlannerLibrary> library = nullptr);

  Plan plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
            double stamp_s) override;

 private:
  using Option = PlannerLibrary::Option;

  /// The target as seen from the robot.
  struct Goal {
    double distance{std::numeric_limits<double>::infinity()};  ///< Infinite for a direction, m.
    double bearing{};                                          ///< Body frame, rad.
    double spread{};                                           ///< Degrees.
    int headings{};                                            ///< To each side of the bearing.
    /// Straight ahead and straight back are candidates too; `bearing` is a whole number of degrees.
    bool own_headings{};
    bool backwards{};  ///< The target asks for driving backwards.
  };
  /// How the robot would take a heading.
  struct Approach {
    bool possible{false};
    bool reverse{false};
    int turn{0};
    float weight{0};
  };
  /// A group of a trajectory library at one heading.
  struct Choice {
    const Option* option{nullptr};
    int stage{};
    int heading{};  ///< Index; 0 is the bearing of the goal.
    int node{};
    float ease{1};  ///< Weight of the ground.
  };
  /// An occupied polar cell.
  struct Occupied {
    std::uint16_t ring, angle;  ///< `angle`: from the goal's bearing, degrees.
  };
  /// A set of polar cells: bits while it is filled, then a list by ring, nearest first.
  struct Cells {
    std::vector<std::uint64_t> bits{};
    std::vector<Occupied> list{};
    void size(int rings);
    void clear();
    void add(int ring, int angle);
    void to_list();
  };

  Goal goal_of(const Target& target, const Pose2& pose);
  void project(const Goal& goal, std::span<const ObstaclePoint> obstacles, Plan& plan);
  void list_headings(const Goal& goal);
  void judge_headings(const Goal& goal);
  void block_paths(const Option& option);
  void cover(const Option& option, const Cells& cells, bool drop_dead,
             std::array<PathMask, kHeadings>& masks);
  float ease(int heading, int stage, int node) const;
  bool vote(const Option& option, int stage, double spread, Choice& best);
  bool choose(const Goal& goal, Choice& best);
  void write_path(const Choice& choice, const Goal& goal, const Pose2& pose, Plan& plan) const;
  double speed_limit(const Target& target, const Choice& choice, const Pose2& pose, const Plan& plan,
                     std::span<const ObstaclePoint> obstacles) const;

  Platform platform_;
  std::shared_ptr<const PlannerLibrary> library_;
  Footprint body_;
  int rings_{0};  ///< Of the largest grid.
  int last_turn_{0};
  HeadingHold heading_hold_{};

  // Data of one cycle.
  Cells occupied_{};              ///< Impassable cells.
  std::array<Cells, 2> rough_{};  ///< Cells with some cost; cells with a high cost.
  TurnRoom room_{};
  std::array<int, kHeadings> offset_{};  ///< Angle of each heading from the goal's bearing, degrees.
  int heading_count_{0};
  std::array<Approach, kHeadings> approach_{};
  std::array<PathMask, kHeadings> blocked_{};
  std::array<std::array<PathMask, kHeadings>, 2> rough_paths_{};
  std::array<float, 361> agreement_{};  ///< Weight of a bearing by its error in degrees, [0, 1].
};

}  // namespace adit::nav
