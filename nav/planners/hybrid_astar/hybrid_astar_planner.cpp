// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/hybrid_astar/hybrid_astar_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nav/passages/widest_strip.hpp"

namespace adit::nav {
namespace {

constexpr double kArrivalTolerance = 0.25;  ///< Default goal tolerance, m.
constexpr double kBetter = 0.6;             ///< Required gain of a new path whose direction changes, m.
constexpr double kOffPath = 0.25;           ///< Maximum distance of the robot from its path, m.
constexpr double kOffHeading = 0.4;         ///< Maximum heading error on the path, rad.
constexpr double kStickCone = 50.0;         ///< Maximum angle between a path and a direction target, degrees.
constexpr double kReverseSpeed = 1.0;       ///< Speed limit backwards, m/s.
constexpr double kTightPlaceSpeed = 0.3;    ///< Speed limit with only the tight margin, m/s.
constexpr double kRoughSlows = 0.75;        ///< Fraction of the speed lost on ground of cost 1.
constexpr double kMoving = 0.08;            ///< A slower robot is stationary, m/s.
/// A part ends this far before its last pose if the robot is almost stationary, m.
constexpr double kTurned = 0.13;
constexpr double kOver = 0.04;          ///< A part ends this far before its last pose, m.
constexpr double kSteersAtOnce = 0.35;  ///< Speed limit while the steering may still be changing, m/s.
constexpr double kSlow = 0.25;          ///< A slower robot is almost stationary, m/s.
constexpr double kFaces = 0.15;         ///< A turn on the spot ends at this heading error, rad.
constexpr double kAhead = 4.2;          ///< Distance of the target that replaces a direction, m.
constexpr float kHysteresis = 0.02f;    ///< Part of the margin that the current path may lose, m.
constexpr float kTightLoss = 0.015f;    ///< Part of the tight margin that it may lose, m.
/// The robot slows down this far before a tight place, in addition to the braking distance, m.
constexpr double kTightAhead = 1.0;
/// An opening that is wider than body and margins by more need not be crossed straight, m.
constexpr double kGap = 0.24;
constexpr double kEasy = 0.12;   ///< An opening that is wider by more than this has other solutions too, m.
constexpr double kLineUp = 1.7;  ///< A path reaches the axis of a gap about this far before it, m.
/// Maximum error at the middle of a gap, position and heading together, m.
constexpr double kMisses = 0.015;
/// From the body's front to a gap's middle: when nearer, it is too late for a correction, m.
constexpr double kMends = 0.2;
constexpr double kBehindPassage = 0.4;  ///< The gap ends this far behind its middle, m.

}  // namespace

HybridAStarPlanner::HybridAStarPlanner(const Platform& platform)
    : platform_(platform), body_(platform), rear_(platform.rear_axle()), search_(platform) {}

Plan HybridAStarPlanner::plan(const Target& target, const Pose2& pose,
                              std::span<const ObstaclePoint> obstacles, double stamp_s) {
  Plan plan;
  plan.stamp_s = stamp_s;
  const Pose2 rear = pose * Pose2{-rear_, 0, 0};
  watch_motion(rear, stamp_s);
  plan.clearance = take_obstacles(obstacles);
  const bool nowhere =
      target.kind == Target::Kind::none || (target.kind == Target::Kind::direction && target.speed <= 0.0);
  const double distance = (target.goal - pose.position()).norm();
  const bool goal = target.kind == Target::Kind::goal;
  plan.arrived = goal && distance <= (target.tolerance > 0.0 ? target.tolerance : kArrivalTolerance);
  if (nowhere || plan.arrived) {
    current_.count = 0;
    heading_hold_.forget();
    return plan;
  }

  HybridAStarTask task = task_of(target, pose, rear);
  if (goal) see_passage(target, pose, obstacles, task);
  const bool keeps = follows_on(rear) && current_target_.kind == target.kind &&
                     (!goal || (current_target_.goal - target.goal).norm() < 1.0) && passable(rear);
  // A path through a gap stays unless a nearer view shows that it misses the middle.
  const bool to_passage = keeps && current_.through && task.passage;
  const bool goes_through = to_passage && !misses(*task.passage, rear);
  if (to_passage && !changes_ahead()) task.only = 1;
  const bool finds = !goes_through && (to_passage ? find_through(task) : find(task));
  const bool takes = finds && (!keeps || is_better(rear, to_passage));
  if (takes) {
    adopt(rear);
    current_target_ = target;
  }
  if (!takes && !keeps) {
    current_.count = 0;
    plan.blocked = true;
    return plan;
  }
  write(target, pose, obstacles, plan);
  return plan;
}

void HybridAStarPlanner::watch_motion(const Pose2& rear, double stamp_s) {
  if (before_ && stamp_s > before_s_) {
    const Pose2 moved = before_->inverse() * rear;
    const double way = std::copysign(std::hypot(moved.x, moved.y), moved.x);
    speed_ = way / (stamp_s - before_s_);
    if (std::fabs(way) > 0.02) curvature_ = moved.yaw / way;
  }
  before_ = rear;
  before_s_ = stamp_s;
}

float HybridAStarPlanner::take_obstacles(std::span<const ObstaclePoint> obstacles) {
  float clearance = 2.0f;
  for (const ObstaclePoint& o : obstacles)
    if (o.cost >= 1.0f) clearance = std::min(clearance, std::max(0.0f, -body_.depth(o.x, o.y)));
  distance_field_.fill(obstacles, static_cast<float>(rear_));
  return clearance;
}

HybridAStarTask HybridAStarPlanner::task_of(const Target& target, const Pose2& pose, const Pose2& rear) {
  HybridAStarTask task{};
  if (std::fabs(speed_) > kSteersAtOnce) task.level = search_.motions().level(curvature_);
  if (std::fabs(speed_) > kMoving) task.direction = speed_ > 0 ? 1 : -1;
  if (target.kind == Target::Kind::goal) {
    task.target = rear.inverse() * target.goal;
    task.turns = target.passage.has_value();
    heading_hold_.forget();
    return task;
  }
  const double bearing = heading_hold_.bearing(target, pose);
  task.goal = false;
  task.target = Eigen::Vector2d(rear_ + kAhead * std::cos(bearing), kAhead * std::sin(bearing));
  // Forwards or backwards by the stick; for a stick held straight back the path has the opposite heading.
  task.only = std::fabs(wrap_angle(target.direction)) <= M_PI / 2 ? 1 : -1;
  task.heading = bearing;
  const double now = std::fabs(wrap_angle((task.only > 0 ? 0.0 : M_PI) - bearing));
  task.spread = std::max(kStickCone * M_PI / 180.0, now + 0.05);
  return task;
}

// Finds a path to a place from where a gap can be crossed, if it cannot be crossed from here. If there is
// none, and the gap is wide enough to be met at an angle, any path through it counts.
bool HybridAStarPlanner::find(HybridAStarTask task) {
  if (!task.passage) return find_there(task);
  if (find_through(task)) return true;
  HybridAStarTask before = task;
  before.target = (*task.passage * Pose2{rear_ - kLineUp, 0, 0}).position();
  before.passage.reset();
  const bool easy = task.room >= platform_.width + 2 * HybridAStarSearch::kMargin + kEasy;
  if (find_there(before) && (found_.complete || !easy)) return true;
  task.passage.reset();
  return easy && find_there(task);
}

// Finds a path with the full margin; if there is none, one with the tight margin.
bool HybridAStarPlanner::find_there(HybridAStarTask task) {
  for (const bool tight : {false, true}) {
    task.tight = tight;
    const double margin = tight ? HybridAStarSearch::kTightMargin : HybridAStarSearch::kMargin;
    cost_to_go_.fill(distance_field_, task.target, static_cast<float>(platform_.width / 2 + margin));
    if (search_.find(distance_field_, cost_to_go_, task, found_)) return true;
  }
  return false;
}

void HybridAStarPlanner::see_passage(const Target& target, const Pose2& pose,
                                     std::span<const ObstaclePoint> obstacles, HybridAStarTask& task) const {
  if (!target.passage) return;
  const auto strip = fit_widest_strip(pose.inverse() * *target.passage, obstacles);
  if (!strip || strip->room < platform_.width + 2 * HybridAStarSearch::kTightMargin ||
      strip->room > platform_.width + 2 * HybridAStarSearch::kMargin + kGap ||
      strip->line.inverse().x > kBehindPassage)
    return;
  task.passage = Pose2{rear_, 0, 0} * strip->line;
  task.room = strip->room;
}

// Finds a path onto the axis of the gap and straight through it, with the full margin before the gap if there
// is room.
bool HybridAStarPlanner::find_through(HybridAStarTask task) {
  task.target = (*task.passage * Pose2{-kLineUp, 0, 0}).position();
  return find_there(task);
}

// Whether the current path misses the middle of the gap and can still be corrected.
bool HybridAStarPlanner::misses(const Pose2& passage, const Pose2& rear) const {
  const Pose2 to_passage = passage.inverse();
  const Pose2 end = to_passage * rear.inverse() * current_.spots[current_.count - 1].pose;
  const double turned = wrap_angle(end.yaw);
  const double aside = std::fabs(end.y - end.x * std::tan(turned)) + std::fabs(turned) * body_.front();
  return -to_passage.x - (rear_ + body_.front()) > kMends && aside > kMisses;
}

// Whether the new path replaces the current one.
bool HybridAStarPlanner::is_better(const Pose2& rear, bool to_passage) const {
  const double ahead = current_.cost() - static_cast<double>(current_.spots[at_].cost);
  // Through a gap, a central path is worth a slightly longer distance, but no turning.
  if (to_passage) return found_.cost() < ahead + (found_.straight_on() ? kBetter : -kBetter);
  if (found_.through) return true;
  if (found_.tight && !current_.tight) return false;
  const bool other = found_.spots[0].direction != current_.spots[end_].direction;
  if (!other && !changes_ahead() && found_.straight_on()) return true;
  const Eigen::Vector2d end =
      rear.inverse() * (current_.spots[current_.count - 1].pose * Eigen::Vector2d(rear_, 0.0));
  const double left = cost_to_go_.at(static_cast<float>(end.x()), static_cast<float>(end.y()));
  return found_.cost() + found_.left + kBetter < ahead + left;
}

void HybridAStarPlanner::adopt(const Pose2& rear) {
  current_ = found_;
  for (std::size_t i = 0; i < current_.count; ++i) current_.spots[i].pose = rear * current_.spots[i].pose;
  end_ = 0;
  next_part();
}

std::size_t HybridAStarPlanner::end_of_part(std::size_t begin) const {
  std::size_t i = std::min(begin + 1, current_.count - 1);
  while (i + 1 < current_.count && current_.spots[i + 1].direction == current_.spots[begin + 1].direction)
    ++i;
  return i;
}

void HybridAStarPlanner::next_part() {
  at_ = end_;
  end_ = end_of_part(at_);
}

bool HybridAStarPlanner::drives_ahead() const {
  for (std::size_t i = at_ + 1; i < current_.count; ++i)
    if (current_.spots[i].direction < 0) return false;
  return true;
}

bool HybridAStarPlanner::changes_ahead() const { return end_ + 1 < current_.count; }

bool HybridAStarPlanner::follows_on(const Pose2& rear) {
  if (current_.count < 2) return false;
  const auto nearest = [&] {
    double best = std::numeric_limits<double>::infinity();
    std::size_t where = at_;
    for (std::size_t i = at_; i <= end_; ++i) {
      const double d = (current_.spots[i].pose.position() - rear.position()).squaredNorm();
      if (d < best) best = d, where = i;
    }
    return where;
  };
  if (turns()) {
    const auto off = [&](std::size_t i) {
      return std::fabs(wrap_angle(current_.spots[i].pose.yaw - rear.yaw));
    };
    while (at_ + 1 < end_ && off(at_ + 1) < off(at_)) ++at_;
    if (off(end_) > kFaces) return (current_.spots[end_].pose.position() - rear.position()).norm() < kOffPath;
    next_part();
  }
  at_ = nearest();
  const double left = MotionPrimitives::kSpacing * static_cast<double>(end_ - at_);
  if (left < kOver || (left < kTurned && std::fabs(speed_) < kSlow)) {
    if (!changes_ahead()) return false;
    next_part();
    if (turns()) return true;
    at_ = nearest();
  }
  const Pose2& spot = current_.spots[at_].pose;
  return (spot.position() - rear.position()).norm() < kOffPath &&
         std::fabs(wrap_angle(spot.yaw - rear.yaw)) < kOffHeading;
}

bool HybridAStarPlanner::passable(const Pose2& rear) const {
  const Pose2 back = rear.inverse();
  // Places in which the robot already is do not count.
  const std::size_t first = at_ + 8;
  for (std::size_t i = first; i < current_.count; i += 2)
    if (!search_.free(distance_field_, back * current_.spots[i].pose, current_.tight,
                      current_.tight ? kTightLoss : kHysteresis))
      return false;
  return true;
}

// Whether the path up to a spot reaches, before the robot could slow down, a place with only the tight
// margin.
bool HybridAStarPlanner::tightens(const Pose2& back, std::size_t last) const {
  const double slow = std::max(0.0, speed_ * speed_ - kTightPlaceSpeed * kTightPlaceSpeed);
  const double ahead = kTightAhead + slow / (2.0 * platform_.max_acceleration);
  const auto end = std::min(last, at_ + static_cast<std::size_t>(ahead / MotionPrimitives::kSpacing));
  for (std::size_t i = at_; i <= end; i += 2)
    if (!search_.free(distance_field_, back * current_.spots[i].pose, false, 0.0f)) return true;
  return false;
}

void HybridAStarPlanner::write(const Target& target, const Pose2& pose,
                               std::span<const ObstaclePoint> obstacles, Plan& plan) const {
  // A turn is the beginning of the part behind it.
  const std::size_t begin = turns() ? end_ : at_, end_of_plan = turns() ? end_of_part(end_) : end_;
  const std::size_t last = std::min(end_of_plan, begin + Plan::kMaxPath - 1);
  plan.turn_first = turns();
  if (turns())
    plan.turn = wrap_angle(current_.spots[at_ + 1].pose.yaw - current_.spots[at_].pose.yaw) > 0 ? 1 : -1;
  for (std::size_t i = begin; i <= last; ++i)
    plan.poses[plan.pose_count++] = current_.spots[i].pose * Pose2{rear_, 0, 0};
  plan.length = static_cast<double>(plan.pose_count - 1) * MotionPrimitives::kSpacing;
  plan.reverse = current_.spots[end_of_plan].direction < 0;
  const Eigen::Vector2d end = plan.poses[plan.pose_count - 1].position();
  plan.ends_at_goal = target.kind == Target::Kind::goal && (end - target.goal).norm() <= kArrivalTolerance;
  double limit = path_speed(plan, pose, body_, platform_, obstacles);
  if (plan.reverse) limit = std::min(limit, kReverseSpeed);
  const Pose2 back = (pose * Pose2{-rear_, 0, 0}).inverse();
  if (current_.tight && tightens(back, last)) limit = std::min(limit, kTightPlaceSpeed);
  // Ground with a cost is driven slowly.
  float rough = 0.0f;
  for (std::size_t i = at_; i <= last; i += 2) {
    const Pose2 at = back * current_.spots[i].pose;
    rough = std::max(rough, distance_field_.cost(static_cast<float>(at.x), static_cast<float>(at.y)));
  }
  limit = std::min(limit, platform_.max_speed * (1.0 - kRoughSlows * static_cast<double>(rough)));
  plan.max_speed = target.speed > 0.0 ? std::min(limit, target.speed) : limit;
}

}  // namespace adit::nav
