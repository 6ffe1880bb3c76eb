// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/falco/falco_planner.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace adit::nav {
namespace {

constexpr double kRoomyMargin = 0.5;  ///< Clearance beside the footprint where there is plenty of room, m.
constexpr double kSideMargin = 0.09;  ///< Clearance beside it where there is less room, m.
// Clearance ahead and behind, m; at least what a turn on the spot needs.
constexpr double kFrontMargin = 0.20;
constexpr double kTightMargin = 0.05;    ///< Clearance beside it in tight space, m.
constexpr double kSqueezeMargin = 0.02;  ///< Clearance beside it when nothing else is free, m.
constexpr double kShortScale = 0.5;      ///< Scale of the second, shorter and more curved library.
constexpr double kTightSpeed = 0.5;      ///< Speed with only the tight margin, m/s.
constexpr double kSqueezeSpeed = 0.25;   ///< Speed with only the squeeze margin, m/s.
constexpr double kGoalTolerance = 0.25;  ///< Default goal tolerance, m.
constexpr double kGoalSpread = 95.0;     ///< Maximum angle between a heading and the goal's bearing, degrees.
// Beyond this angle a library with tighter margins is preferred, degrees.
constexpr double kDirectSpread = 35.0;
constexpr double kStickSpread = 45.0;   ///< Maximum angle to a direction target, degrees.
constexpr double kDetourSpread = 60.0;  ///< Maximum angle for paths that are only partly free, degrees.
constexpr double kDegree = M_PI / 180.0;
constexpr int kAngles = CorrespondenceGrid::kAngles;
constexpr int kHeadingStep = 10;  ///< Degrees.
/// Smaller heading errors need no turn on the spot: the controller corrects them, degrees.
constexpr double kNoTurn = 12.0;
constexpr double kEitherSide = 140.0;  ///< Beyond this angle the side of a turn stays once chosen, degrees.
constexpr double kTurnSlack = 0.06;    ///< Clearance ahead beyond what a turn on the spot needs, m.
constexpr double kTurnMargin = 0.04;   ///< Clearance around the footprint during a turn on the spot, m.
constexpr float kSmooth = 0.1f;        ///< Ground up to this cost counts as smooth.
constexpr float kVeryRough = 0.5f;     ///< Ground above this cost is avoided where there is an alternative.
constexpr std::array<float, 2> kEase{0.4f, 0.05f};  ///< Weight of a path across rough and very rough ground.
constexpr double kSlowest = 0.25;                   ///< Fraction of the speed on ground of weight zero.
constexpr float kSecondChoice = 0.3f;  ///< Weight of the driving direction opposite to the target's.

/// Converts an angle in radians to degrees in [0, 360), rounded down.
int to_degrees(float radians) {
  int d = static_cast<int>(std::floor(radians * static_cast<float>(1.0 / kDegree)));
  d %= kAngles;
  return d < 0 ? d + kAngles : d;
}

/// Rounds an angle to a multiple of a degree, rad.
double round_to_degree(double radians) { return std::round(radians / kDegree) * kDegree; }

/// Falco's weight of a heading: it falls steeply with the turn that the heading needs.
float heading_weight(double degrees) {
  const double w = std::max(1.0, 10.0 - std::fabs(degrees) / kHeadingStep);
  return static_cast<float>(w * w * w * w);
}

}  // namespace

std::shared_ptr<const PlannerLibrary> PlannerLibrary::build(const Platform& platform) {
  const Footprint body(platform);
  const double turn_needs = body.radius() - body.front() + kTurnSlack;
  PathTreeParams large;
  if (platform.path_segment > 0) large.segment = platform.path_segment;
  if (platform.path_curvature > 0)
    for (double& c : large.curvature) c *= platform.path_curvature / PathTreeParams{}.curvature.front();
  PathTreeParams small = large;
  small.segment *= kShortScale;
  small.blend *= kShortScale;
  small.spacing *= kShortScale;
  for (double& c : small.curvature) c /= kShortScale;

  const PathTree long_tree(large), short_tree(small);
  auto library = std::make_shared<PlannerLibrary>();
  const auto add = [&](const PathTree& tree, double front, double side, double speed, int least_stage) {
    // The front's margin covers obstacles ahead; the rear only swings past obstacles beside it.
    const Footprint grown = body.grown(front, std::min(front, side), side);
    library->options.push_back(
        {tree, CorrespondenceGrid(tree, grown),
         body.symmetric() ? CorrespondenceGrid() : CorrespondenceGrid(tree, grown.turned()),
         std::min(speed, platform.max_speed), least_stage});
  };
  // Libraries with wide margins come first, because they are the fastest. The long library with tight margins
  // comes before the short ones, so that the robot sees a narrow passage from afar and lines up in time.
  const double wide = std::max(kFrontMargin, turn_needs);
  add(long_tree, wide, kRoomyMargin, platform.max_speed, 6);
  library->options.back().roomy = true;
  add(long_tree, wide, kSideMargin, platform.max_speed, 5);
  add(long_tree, turn_needs, kTightMargin, kTightSpeed, 5);
  add(short_tree, wide, kSideMargin, platform.max_speed, 1);
  add(short_tree, turn_needs, kTightMargin, kTightSpeed, 1);
  add(short_tree, turn_needs, kSqueezeMargin, kSqueezeSpeed, 1);
  library->rotation = RotationTable(body.grown(kTurnMargin, kTurnMargin));
  return library;
}

std::shared_ptr<const PlannerLibrary> PlannerLibrary::shared(const Platform& p) {
  // All of a platform that PlannerLibrary::build looks at.
  std::vector<double> key{p.length, p.width, p.max_speed, p.path_curvature, p.path_segment};
  for (const Eigen::Vector2d& corner : p.footprint) key.insert(key.end(), {corner.x(), corner.y()});
  static std::mutex mutex;
  static std::map<std::vector<double>, std::shared_ptr<const PlannerLibrary>> libraries;
  const std::lock_guard lock(mutex);
  auto& library = libraries[key];
  if (!library) library = build(p);
  return library;
}

void FalcoPlanner::Cells::size(int rings) {
  bits.resize((static_cast<std::size_t>(rings) * kAngles + 63) / 64);
  list.reserve(static_cast<std::size_t>(rings) * kAngles);
}

void FalcoPlanner::Cells::clear() {
  std::fill(bits.begin(), bits.end(), 0);
  list.clear();
}

void FalcoPlanner::Cells::add(int ring, int angle) {
  const auto bit = static_cast<std::size_t>(ring * kAngles + angle);
  bits[bit >> 6] |= std::uint64_t{1} << (bit & 63);
}

void FalcoPlanner::Cells::to_list() {
  for (std::size_t word = 0; word < bits.size(); ++word)
    for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
      const auto cell = word * 64 + static_cast<std::size_t>(__builtin_ctzll(left));
      list.push_back(
          {static_cast<std::uint16_t>(cell / kAngles), static_cast<std::uint16_t>(cell % kAngles)});
    }
}

FalcoPlanner::FalcoPlanner(const Platform& platform, std::shared_ptr<const PlannerLibrary> library)
    : platform_(platform),
      library_(library ? std::move(library) : PlannerLibrary::build(platform)),
      body_(platform) {
  for (const Option& o : library_->options) rings_ = std::max(rings_, o.grid.rings());
  occupied_.size(rings_);
  for (Cells& cells : rough_) cells.size(rings_);
}

Plan FalcoPlanner::plan(const Target& target, const Pose2& pose, std::span<const ObstaclePoint> obstacles,
                        double stamp_s) {
  Plan plan;
  plan.stamp_s = stamp_s;
  const Goal goal = goal_of(target, pose);
  project(goal, obstacles, plan);

  const bool nowhere =
      target.kind == Target::Kind::none || (target.kind == Target::Kind::direction && target.speed <= 0.0);
  if (nowhere) return plan;
  if (goal.distance <= (target.tolerance > 0.0 ? target.tolerance : kGoalTolerance)) {
    plan.arrived = true;
    return plan;
  }
  list_headings(goal);
  judge_headings(goal);
  Choice choice;
  if (!choose(goal, choice)) {
    plan.blocked = true;
    last_turn_ = 0;
    return plan;
  }
  write_path(choice, goal, pose, plan);
  plan.max_speed = speed_limit(target, choice, pose, plan, obstacles);
  last_turn_ = plan.turn;
  return plan;
}

FalcoPlanner::Goal FalcoPlanner::goal_of(const Target& target, const Pose2& pose) {
  const bool place = target.kind == Target::Kind::goal;
  Goal goal{.spread = place ? kGoalSpread : kStickSpread, .own_headings = place};
  goal.headings = static_cast<int>(goal.spread / kHeadingStep);
  if (place) {
    const Eigen::Vector2d to = pose.inverse() * target.goal;
    goal.distance = to.norm();
    goal.bearing = goal.distance > 1e-6 ? round_to_degree(std::atan2(to.y(), to.x())) : 0.0;
  }
  if (target.kind == Target::Kind::direction) {
    goal.bearing = heading_hold_.bearing(target, pose);
    goal.backwards = heading_hold_.held() && std::cos(target.direction) < 0;
  } else {
    heading_hold_.forget();
  }
  return goal;
}

void FalcoPlanner::project(const Goal& goal, std::span<const ObstaclePoint> obstacles, Plan& plan) {
  const auto bearing = static_cast<float>(goal.bearing);
  const RotationTable& rotation = library_->rotation;
  float clearance = 2.0f;
  room_ = {};
  occupied_.clear();
  for (Cells& cells : rough_) cells.clear();

  for (const ObstaclePoint& p : obstacles) {
    if (p.cost < kSmooth) continue;
    const float range = std::sqrt(p.x * p.x + p.y * p.y);
    const int ring = CorrespondenceGrid::ring_of(range);
    if (ring >= rings_ && ring >= rotation.rings()) continue;
    const float angle = std::atan2(p.y, p.x);
    const bool solid = p.cost >= 1.0f;
    if (solid) {
      if (ring < rotation.rings()) rotation.limit(ring, to_degrees(angle), room_);
      clearance = std::min(clearance, std::max(0.0f, -body_.depth(p.x, p.y)));
    }
    if (ring >= rings_) continue;
    Cells& cells = solid ? occupied_ : rough_[p.cost < kVeryRough ? 0 : 1];
    cells.add(ring, to_degrees(angle - bearing));
  }
  plan.clearance = clearance;
  occupied_.to_list();
  for (Cells& cells : rough_) cells.to_list();
}

void FalcoPlanner::list_headings(const Goal& goal) {
  heading_count_ = 0;
  for (int k = -goal.headings; k <= goal.headings; ++k) offset_[heading_count_++] = k * kHeadingStep;
  if (!goal.own_headings) return;
  const auto bearing = static_cast<int>(std::lround(goal.bearing / kDegree));
  for (const int own : {-bearing, bearing > 0 ? 180 - bearing : -180 - bearing})
    if (std::abs(own) > goal.headings * kHeadingStep || own % kHeadingStep != 0)
      offset_[heading_count_++] = own;
}

void FalcoPlanner::judge_headings(const Goal& goal) {
  // Side to which a turn by `degrees` is free: 1, -1, 0 when none is needed, 2 when there is no room.
  const auto side = [this](double degrees) {
    const double by = std::fabs(degrees);
    if (by <= kNoTurn) return 0;
    const int shorter = degrees > 0 ? 1 : -1;
    const auto room = [this](int s) { return s > 0 ? room_.left : room_.right; };
    const bool can = room(shorter) >= by, can_long = room(-shorter) >= 360 - by;
    if (can_long && last_turn_ == -shorter && by > kEitherSide) return -shorter;
    if (can) return shorter;
    return can_long ? -shorter : 2;
  };
  for (int h = 0; h < heading_count_; ++h) {
    Approach& way = approach_[h];
    const double ahead = wrap_angle(goal.bearing + offset_[h] * kDegree) / kDegree;
    const double behind = wrap_angle((ahead - 180.0) * kDegree) / kDegree;
    const int forward = side(ahead), reverse = side(behind);
    way = {};
    const bool backwards = reverse != 2 && (goal.backwards || forward == 2);
    if (!backwards && forward == 2) continue;
    way.possible = true;
    way.reverse = backwards;
    way.turn = backwards ? reverse : forward;
    way.weight = heading_weight(backwards ? behind : ahead);
    if (backwards != goal.backwards) way.weight *= kSecondChoice;
  }
}

void FalcoPlanner::block_paths(const Option& option) {
  cover(option, occupied_, true, blocked_);
  for (std::size_t i = 0; i < rough_.size(); ++i) cover(option, rough_[i], false, rough_paths_[i]);
}

void FalcoPlanner::cover(const Option& option, const Cells& cells, bool drop_dead,
                         std::array<PathMask, kHeadings>& masks) {
  // Heading by heading, so that its mask stays in registers.
  for (int h = 0; h < heading_count_; ++h) {
    masks[h] = {};
    if (!approach_[h].possible || (!drop_dead && blocked_[h].dead())) continue;
    PathMask mask{};
    const CorrespondenceGrid& grid =
        approach_[h].reverse && option.back.rings() > 0 ? option.back : option.grid;
    const int rings = std::min(option.grid.rings(), grid.rings());
    int ring = -1;
    for (const Occupied& cell : cells.list) {
      if (cell.ring >= rings) break;
      // Nearest rings first: a heading that is blocked at its start is done early.
      if (drop_dead && cell.ring != ring && mask.dead()) break;
      ring = cell.ring;
      int angle = cell.angle - offset_[h];
      if (angle < 0) angle += kAngles;
      if (angle >= kAngles) angle -= kAngles;
      if ((angle < kAngles / 2 ? angle : kAngles - 1 - angle) > grid.half_angle(ring)) continue;
      mask |= grid.at(ring, angle);
    }
    masks[h] = mask;
  }
}

float FalcoPlanner::ease(int heading, int stage, int node) const {
  constexpr auto& kBit = PathTree::kFirstBit;
  for (std::size_t i = rough_.size(); i-- > 0;) {
    if (rough_[i].list.empty()) continue;
    const PathMask& mask = rough_paths_[i][heading];
    for (int s = 0; s <= stage; ++s)
      if (mask.test(kBit[s] + node * PathTree::kNodes[s] / PathTree::kNodes[stage])) return kEase[i];
  }
  return 1.0f;
}

bool FalcoPlanner::vote(const Option& option, int stage, double spread, Choice& best) {
  for (int d = 0; d <= 360; ++d) {
    const int off = d > 180 ? 360 - d : d;
    agreement_[d] = off >= spread ? 0.0f : static_cast<float>(1.0 - std::sqrt(std::sqrt(off / spread)));
  }
  constexpr auto& kBit = PathTree::kFirstBit;
  float best_score = 0.0f;
  for (int h = 0; h < heading_count_; ++h) {
    const Approach& way = approach_[h];
    const PathMask& mask = blocked_[h];
    if (!way.possible || mask.dead()) continue;
    std::uint64_t groups = 0;
    for (int s = 0; s <= std::min(stage, 3); ++s) groups |= mask.words[0] >> kBit[s];
    const auto turned = static_cast<float>(offset_[h]);
    const int per_group = PathTree::kNodes[stage] / PathTree::kGroups;
    for (int g = 0; g < PathTree::kGroups; ++g) {
      if ((groups >> g) & 1u) continue;
      float sum = 0.0f, top = 0.0f;
      int top_node = -1;
      for (int n = g * per_group; n < (g + 1) * per_group; ++n) {
        if (stage >= 4) {
          const int middle = stage == 6 ? n / PathTree::kFan : n;
          if (mask.test(kBit[4] + middle) || (stage >= 5 && mask.test(kBit[5] + middle))) continue;
          if (stage == 6 && mask.test(kBit[6] + n)) continue;
        }
        const float score =
            ease(h, stage, n) *
            agreement_[static_cast<int>(std::fabs(turned + option.tree.end_bearing(stage, n)) + 0.5f)];
        sum += score;
        if (score > top) {
          top = score;
          top_node = n;
        }
      }
      sum *= way.weight;
      if (sum > best_score) {
        best_score = sum;
        best = {&option, stage, h, top_node, ease(h, stage, top_node)};
      }
    }
  }
  return best_score > 0.0f;
}

// Chooses the first library with a path over good ground about towards the target; if there is none, the
// first library with any path.
bool FalcoPlanner::choose(const Goal& goal, Choice& best) {
  const double direct = std::min(goal.spread, kDirectSpread);
  const double detour = std::min(goal.spread, kDetourSpread);
  Choice other;
  bool any = false;
  for (const Option& option : library_->options) {
    block_paths(option);
    const int need = option.tree.stage_for(goal.distance);
    if (vote(option, need, direct, best) && best.ease >= 1.0f) return true;
    if (any || option.roomy) continue;
    any = vote(option, need, goal.spread, other);
    for (int stage = need - 1; !any && stage >= option.least_stage; --stage)
      any = vote(option, stage, detour, other);
  }
  best = other;
  return any;
}

void FalcoPlanner::write_path(const Choice& choice, const Goal& goal, const Pose2& pose, Plan& plan) const {
  const PathTree& tree = choice.option->tree;
  const Approach& way = approach_[choice.heading];
  const double turned = wrap_angle(goal.bearing + offset_[choice.heading] * kDegree);
  plan.reverse = way.reverse;
  plan.turn = way.turn;

  const Pose2 start = pose * Pose2{0, 0, turned};
  const auto path = tree.path(PathTree::path_through(choice.stage, choice.node));
  const std::size_t last = std::min(tree.last_pose(choice.stage), Plan::kMaxPath - 1);
  for (std::size_t i = 0; i <= last; ++i) {
    if (i > 0 && std::hypot(path[i].x, path[i].y) > goal.distance + tree.params().spacing / 2) break;
    Pose2 p = start * path[i];
    if (way.reverse) p.yaw = wrap_angle(p.yaw + M_PI);
    plan.poses[plan.pose_count++] = p;
  }
  plan.length = static_cast<double>(plan.pose_count - 1) * tree.params().spacing;
  plan.ends_at_goal = goal.distance <= plan.length + tree.params().spacing;
}

double FalcoPlanner::speed_limit(const Target& target, const Choice& choice, const Pose2& pose,
                                 const Plan& plan, std::span<const ObstaclePoint> obstacles) const {
  double limit = path_speed(plan, pose, body_, platform_, obstacles);
  limit = std::min(limit, choice.option->max_speed);
  limit = std::min(limit, platform_.max_speed * (kSlowest + (1 - kSlowest) * choice.ease));
  return target.speed > 0.0 ? std::min(limit, target.speed) : limit;
}

}  // namespace adit::nav
