// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "nav/correspondence.hpp"
#include "nav/course.hpp"
#include "nav/path_speed.hpp"
#include "nav/path_tree.hpp"
#include "nav/planner.hpp"
#include "nav/rotation.hpp"

namespace adit::nav {

struct LocalPlannerParams {
  PathTreeParams tree{};
  double roomy_margin{0.5};     ///< kept free beside the footprint where there is room, m, [0, 1]
  double side_margin{0.09};     ///< the same where there is less, m, [0, 1]
  double front_margin{0.20};    ///< kept free before and behind it, m, [0, 1]; never less than a turn needs
  double tight_margin{0.05};    ///< on the sides, where there is no more, m, [0.02, 0.5]
  double squeeze_margin{0.02};  ///< the same where nothing else is left, m, [0, 0.5]
  double short_scale{0.5};      ///< of the second, shorter and more curved library, [0.2, 1]
  double tight_speed{0.5};      ///< where only the tight margin is left, m/s, (0, 2]
  double squeeze_speed{0.25};   ///< and where less is, m/s, (0, 2]
  double tolerance{0.25};       ///< arrived within this distance of the goal, m, [0.02, 2]
  double goal_spread{95.0};     ///< paths may lead away from the goal's bearing by this, degrees, [10, 120]
  double direct_spread{35.0};   ///< before one farther off a tighter way is taken, degrees, [10, 120]
  double stick_spread{45.0};    ///< the same for a direction, degrees, [10, 120]
  double detour_spread{
      60.0};             ///< the same for paths that are free for a part of the way only, degrees, [10, 120]
  double patience{3.0};  ///< stands blocked this long before it backs away, s, [0, 60]
  double retreat{1.2};   ///< backs away this far to look for another way, m, [0.5, 3]
  int retreats{2};       ///< as often, until it came nearer to the goal again; then it stays blocked, [0, 10]
  double effort{20.0};  ///< drives this long without coming nearer to a goal, then it is blocked, s, [1, 600]
  double effort_near{4.0};   ///< the same within effort_range of it, and a whole turn more, s, [1, 600]
  double effort_range{1.0};  ///< m, [0, 10]
  double rest{30.0};         ///< and stays blocked this long before it tries again, s, [0, 3600]
  PathSpeedParams speed{};
};

/// What a local planner looks up: its libraries, longest and widest first, and the turning table of the
/// footprint. Immutable; robots of one platform can share it.
struct PlannerLibrary {
  /// One library: a scale and a margin.
  struct Option {
    PathTree tree;
    CorrespondenceGrid grid;
    CorrespondenceGrid back;  ///< of the body driving backwards; empty: the same
    double max_speed;         ///< m/s, with such margins
    int least_stage;          ///< a shorter way than this is left to the next library
    bool roomy{};             ///< and one over rough ground, or hardly towards the goal
  };
  std::vector<Option> options{};
  RotationTable rotation{};

  /// Builds it (about 60 ms, 8 MB).
  static std::shared_ptr<const PlannerLibrary> build(const Platform& platform,
                                                     const LocalPlannerParams& params = {});
};

/// The local planner: looks for the heading, group and path of the trajectory library along which the robot
/// can go on towards its target. After Falco (see PathTree and CorrespondenceGrid): 36 headings, a vote of
/// the free paths for their group, weighted by how well they lead to the target and how little the robot has
/// to turn. Different from it:
/// - headings are counted from the target's bearing, so that the straight way to it is one of them; towards a
///   goal the robot's own heading and the opposite one are two more, so that a robot that has no room to turn
///   can drive straight ahead or back;
/// - one pass over the obstacles yields the free length of all paths; Falco repeats it for each range;
/// - a path is swept by the footprint, and a heading counts only when the turn towards it on the spot is free
///   (or, failing that, when the robot can get into it backwards);
/// - a stick held straight ahead (or back) holds the course that the robot had: it goes round an obstacle and
///   on, and stops at a wall; turning with each detour it would follow the wall;
/// - on the way to a goal, a robot that stood blocked (or that the collision monitor holds) backs away a
/// little and tries again, a few times: in a
///   passage it cannot turn, and so cannot take the way beside the one that it tried;
/// - a robot that drives to and fro without coming nearer to its goal (it stands in something, or behind it)
///   gives up for a while and says so;
/// - ground that is passable at a cost makes the paths across it count for less, and slow;
/// - shorter paths and tighter margins are further libraries of the true footprint: scaling the obstacle
///   points, as Falco does, would scale the robot as well.
class LocalPlanner final : public Planner {
 public:
  static constexpr int kHeadings = 36;

  /// `library`: of this platform and these params; built here when null.
  explicit LocalPlanner(const Platform& platform, const LocalPlannerParams& params = {},
                        std::shared_ptr<const PlannerLibrary> library = nullptr);

  Plan plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
            double stamp_s) override;

  const LocalPlannerParams& params() const { return params_; }

 private:
  using Option = PlannerLibrary::Option;

  struct Goal {
    double distance;    ///< m, or infinite
    double bearing;     ///< in the body frame, rad
    double spread;      ///< degrees
    int headings;       ///< to each side of the bearing
    bool own_headings;  ///< Straight ahead and straight back are candidates, too; `bearing` is whole degrees.
    bool backwards;     ///< driving backwards is what was asked for
  };
  /// A heading's way of being taken.
  struct Approach {
    bool possible{false};
    bool reverse{false};
    int turn{0};
    float weight{0};
  };
  struct Choice {
    const Option* option{nullptr};
    int stage{};
    int heading{};  ///< index, 0 is along the bearing
    int node{};
    int group{};
    float ease{1};  ///< weight of its ground
  };
  struct Occupied {
    std::uint16_t ring, angle;  ///< angle from the goal's bearing, degrees
  };
  /// A set of polar cells: as bits while it is filled, then as a list by ring, nearest first.
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
  Goal retreat_goal(const Pose2& pose, double stamp_s);
  void consider_retreat(const Pose2& pose, double stamp_s, bool at_once);
  void watch_progress(const Target& target, double distance);
  bool given_up(bool drives, double stamp_s);
  void write_path(const Choice& choice, const Goal& goal, const Pose2& pose, Plan& plan) const;
  double speed_limit(const Target& target, const Choice& choice, const Pose2& pose, const Plan& plan,
                     std::span<const ObstaclePoint> obstacles) const;

  Platform platform_;
  LocalPlannerParams params_;
  std::shared_ptr<const PlannerLibrary> library_;
  Footprint body_;
  int rings_{0};  ///< of the largest grid
  int last_turn_{0};
  Course course_{};
  Eigen::Vector2d goal_{0, 0};  ///< that the following are about
  double nearest_{0};           ///< to it so far, m, in steps of half a metre
  double closest_{0};           ///< the same in finer steps
  double effort_{0};            ///< driven since it came closer, s
  double last_stamp_{0};        ///< of the plan before, s
  double rest_until_{0};        ///< given up until then, s
  double free_stamp_{0};        ///< when a way was last free or it began to be blocked, s; or infinite
  int retreats_left_{0};
  bool retreating_{false};
  double retreat_until_{0};           ///< s
  Eigen::Vector2d retreat_to_{0, 0};  ///< odometry frame

  // Of one cycle.
  Cells occupied_{};              ///< cannot be passed
  std::array<Cells, 2> rough_{};  ///< costs something; costs much
  TurnRoom room_{};
  std::array<int, kHeadings> offset_{};  ///< of each heading from the goal's bearing, degrees
  int heading_count_{0};
  std::array<Approach, kHeadings> approach_{};
  std::array<PathMask, kHeadings> blocked_{};
  std::array<std::array<PathMask, kHeadings>, 2> rough_paths_{};
  std::array<float, 361> agreement_{};  ///< of a bearing that is off by so many degrees, 0..1
};

}  // namespace adit::nav
