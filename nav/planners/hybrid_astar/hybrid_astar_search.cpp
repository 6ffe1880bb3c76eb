// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/hybrid_astar/hybrid_astar_search.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr float kInflation = 0.25f;   ///< Inflation beyond the margin, m.
constexpr float kNarrowCost = 2.0f;   ///< Additional cost per metre at the margin.
constexpr float kRoughCost = 5.0f;    ///< Additional cost per metre on ground of cost 1.
constexpr double kFarthestEnd = 3.5;  ///< Maximum distance of a path's end from its start, m.
constexpr double kGoalRadius = 0.15;  ///< Goal tolerance, m.
constexpr float kReverseCost = 1.6f;  ///< Cost of a metre backwards relative to one forwards.
constexpr float kChangeCost = 0.8f;   ///< Cost of a change of direction, m.
constexpr double kSteerCost = 0.04;   ///< Cost of changing the curvature by one level, m.
constexpr float kTurnCost = 0.3f;     ///< Cost of a turn on the spot by MotionPrimitives::kTurn, m.
// Minimum gain towards the target of a path that does not reach it, m.
constexpr float kLeastGainTowards = 0.3f;
constexpr int kExpansions = 3000;  ///< Maximum number of expanded nodes.
/// Weight of the heuristic: expands fewer states for slightly longer paths.
constexpr float kHeuristicWeight = 1.25f;
/// A body that starts inside its margin may stay inside for this distance, m.
constexpr float kLeaving = 0.8f;
constexpr float kDeeper = 0.01f;    ///< Tolerance, m, for the size of the cells.
constexpr float kRounding = 1e-4f;  ///< m
/// A body whose clearance by the cells exceeds the margin by this much is free, m.
constexpr float kCoarse = 0.05f;
constexpr double kStraight = 0.25;  ///< The body is straight on the axis this far before a gap, m.
constexpr double kMouth = 0.1;      ///< A gap may begin this far before its middle, m.
/// Maximum error off the axis, position and heading together, with which no corner hits a side, m.
constexpr double kNearlyOn = 0.08;
constexpr double kBehind = 0.9;    ///< The path ends this far behind the middle of a gap, m.
constexpr double kSteepest = 1.0;  ///< Maximum heading error off the axis, rad.

}  // namespace

HybridAStarSearch::HybridAStarSearch(const Platform& platform)
    : primitives_(platform),
      base_(platform.rear_axle()),
      width_(platform.width),
      outline_(Footprint(platform).grown(kTightMargin, kTightMargin)),
      front_(base_ + Footprint(platform).front()),
      turns_(platform.turns_on_spot()),
      closed_(static_cast<std::size_t>(kCells) * kCells * kHeadings * 3, 0) {
  const double count = std::ceil(6.0 * platform.length / platform.width);
  disc_count_ = std::clamp<std::size_t>(static_cast<std::size_t>(count), 1, kMaxDiscs);
  const double half = platform.length / 2 / static_cast<double>(disc_count_);
  for (std::size_t i = 0; i < disc_count_; ++i)
    discs_[i] = static_cast<float>(base_ - platform.length / 2 + half * static_cast<double>(2 * i + 1));
  wide_ = static_cast<float>(
      std::max(platform.width / 2 + kMargin, std::hypot(half, platform.width / 2) + kMargin / 2));
  nodes_.reserve(kMaxNodes);
  open_.reserve(kMaxNodes);
}

bool HybridAStarSearch::free(const DistanceField& field, const Pose2& pose, bool tight, float less) const {
  if (tight) return outline_free(field, pose, less);
  const float radius = wide_ - less;
  const auto c = static_cast<float>(std::cos(pose.yaw)), s = static_cast<float>(std::sin(pose.yaw));
  const auto x = static_cast<float>(pose.x), y = static_cast<float>(pose.y);
  for (std::size_t i = 0; i < disc_count_; ++i)
    if (field.clearance(x + c * discs_[i], y + s * discs_[i]) < radius) return false;
  return true;
}

bool HybridAStarSearch::outline_free(const DistanceField& field, const Pose2& pose, float allowed) const {
  return field.points().depth(outline_, pose * Pose2{base_, 0, 0}) <= std::max(0.0f, allowed);
}

float HybridAStarSearch::price(const DistanceField& field, const Pose2& pose, bool leaving) const {
  const auto c = static_cast<float>(std::cos(pose.yaw)), s = static_cast<float>(std::sin(pose.yaw));
  const auto x = static_cast<float>(pose.x), y = static_cast<float>(pose.y);
  float room = DistanceField::kFar, rough = 0.0f;
  for (std::size_t i = 0; i < disc_count_; ++i) {
    const float px = x + c * discs_[i], py = y + s * discs_[i];
    const float here = field.clearance(px, py);
    if (!tight_ && here < (leaving ? std::min(wide_, least_[i]) : wide_)) return -1.0f;
    room = std::min(room, here - wide_);
    rough = std::max(rough, field.cost(px, py));
  }
  if (tight_ && room < kCoarse && !outline_free(field, pose, leaving ? depth_ : 0.0f)) return -1.0f;
  return 1.0f + kNarrowCost * (1.0f - std::clamp(room / kInflation, 0.0f, 1.0f)) + kRoughCost * rough;
}

std::int32_t HybridAStarSearch::state(const Pose2& pose, int direction) const {
  constexpr float kHalf = kCell * kCells / 2;
  const int i = static_cast<int>(std::floor((static_cast<float>(pose.x) + kHalf) / kCell));
  const int j = static_cast<int>(std::floor((static_cast<float>(pose.y) + kHalf) / kCell));
  if (i < 0 || j < 0 || i >= kCells || j >= kCells) return -1;
  const int turn = static_cast<int>(std::lround(pose.yaw / (2 * M_PI) * kHeadings) + kHeadings) % kHeadings;
  return ((turn * kCells + j) * kCells + i) * 3 + direction + 1;
}

bool HybridAStarSearch::ends(const CostToGo& cost_to_go, const HybridAStarTask& task,
                             const Node& node) const {
  const Eigen::Vector2d base = node.pose * Eigen::Vector2d(base_, 0.0);
  const Eigen::Vector2d start(base_, 0.0);
  if (task.goal && (base - task.target).norm() <= kGoalRadius) return true;
  if (cost_to_go.least() > 0 && node.cost_to_go < cost_to_go.least() + kLeastGainTowards) return true;
  return (base - start).norm() >= kFarthestEnd;
}

void HybridAStarSearch::expand(const DistanceField& field, const CostToGo& cost_to_go,
                               const HybridAStarTask& task, std::int32_t index) {
  for (const int direction : {1, -1}) {
    if (task.only != 0 && direction != task.only) continue;
    for (int level = 0; level < MotionPrimitives::kLevels; ++level) {
      const Node& from = nodes_[index];
      const bool on = from.direction == direction && from.level >= 0;
      if (on && std::abs(level - from.level) > 1) continue;
      const bool changes = from.direction == -direction;
      const MotionPrimitives::MotionPrimitive& motion =
          primitives_.motion(on ? from.level : level, level, direction);
      const bool leaving = from.length < kLeaving;
      const Pose2 middle = from.pose * motion.poses[MotionPrimitives::kPoses / 2];
      const Pose2 end = from.pose * motion.poses[MotionPrimitives::kPoses - 1];
      const double along = direction > 0 ? end.yaw : end.yaw + M_PI;
      if (std::fabs(wrap_angle(along - task.heading)) > task.spread) continue;
      const std::int32_t there = state(end, direction);
      if (there < 0 || closed_[there] == round_) continue;
      const float middle_price = price(field, middle, leaving), end_price = price(field, end, leaving);
      if (middle_price < 0 || end_price < 0) continue;
      const Eigen::Vector2d base = end * Eigen::Vector2d(base_, 0.0);
      const float left = cost_to_go.at(static_cast<float>(base.x()), static_cast<float>(base.y()));
      if (left >= CostToGo::kUnreachable) continue;
      const auto step = static_cast<float>(MotionPrimitives::kStep);
      float cost = 0.5f * (middle_price + end_price) * step;
      if (direction < 0) cost *= kReverseCost;
      if (changes) cost += kChangeCost;
      if (on) cost += static_cast<float>(kSteerCost * std::abs(level - from.level));
      Node next{};
      next.pose = end;
      next.cost = from.cost + cost;
      next.cost_to_go = left;
      next.length = from.length + step;
      next.parent = index;
      next.level = static_cast<std::int8_t>(level);
      next.direction = static_cast<std::int8_t>(direction);
      next.from = on ? from.level : static_cast<std::int8_t>(level);
      add(next);
    }
  }
  if (turns_ && task.only == 0 && (task.turns || task.tight)) turn_on_spot(field, index);
}

void HybridAStarSearch::add(Node next) {
  if (nodes_.size() == kMaxNodes || open_.size() == kMaxNodes) return;
  open_.push_back({next.cost + kHeuristicWeight * next.cost_to_go, static_cast<std::int32_t>(nodes_.size())});
  std::push_heap(open_.begin(), open_.end());
  nodes_.push_back(next);
}

// A robot that drives stops first, which costs as much as a change of direction.
void HybridAStarSearch::turn_on_spot(const DistanceField& field, std::int32_t index) {
  const Node from = nodes_[index];
  for (const int side : {1, -1}) {
    if (from.parent >= 0 && from.direction == 0 && from.from != side) continue;
    const MotionPrimitives::MotionPrimitive& motion = primitives_.turn(side);
    const std::int32_t there = state(from.pose * motion.poses.back(), 0);
    if (there < 0 || closed_[there] == round_) continue;
    float most = 0;
    for (const Pose2& pose : motion.poses) {
      const float here = price(field, from.pose * pose, from.length < kLeaving);
      most = here < 0 ? here : std::max(most, here);
      if (here < 0) break;
    }
    if (most < 0) continue;
    Node next = from;
    next.pose = from.pose * motion.poses.back();
    next.cost += most * kTurnCost;
    if (from.direction != 0) next.cost += kChangeCost;
    next.parent = index;
    next.level = -1;
    next.direction = 0;
    next.from = static_cast<std::int8_t>(side);
    add(next);
  }
}

// Adds a curve onto the axis before the gap. A body that is already in the gap, or nearly on its axis,
// reaches the axis over the next metre or so; from other places that near, a curve would end with a corner in
// a side of the gap.
bool HybridAStarSearch::expand_analytically(const DistanceField& field, const HybridAStarTask& task,
                                            std::int32_t index, HybridAStarPath& path) const {
  const Pose2 at = task.passage->inverse() * nodes_[index].pose;
  const double end = kBehind - base_;
  if (at.x > end - 0.3 || std::fabs(at.yaw) > kSteepest) return false;
  const double before = -front_ - kStraight;
  if (at.x < before - 0.4) return connect_to_axis(field, task, index, before, path);
  const bool outside = at.x < -front_ - kMouth;
  const double nearly_on = std::max(kNearlyOn, (task.room - width_) / 2);
  if (outside && std::fabs(at.y) + std::fabs(at.yaw) * front_ > nearly_on) return false;
  for (const double length : {0.6, 1.0, 1.5})
    if (at.x + length <= end && connect_to_axis(field, task, index, at.x + length, path)) return true;
  return false;
}

bool HybridAStarSearch::connect_to_axis(const DistanceField& field, const HybridAStarTask& task,
                                        std::int32_t index, double straight_from,
                                        HybridAStarPath& path) const {
  const Node& node = nodes_[index];
  const Pose2 at = task.passage->inverse() * node.pose;
  const double length = straight_from - at.x, slope = std::tan(at.yaw);
  const double bend = node.direction > 0 && node.level >= 0 ? primitives_.curvature(node.level) : 0.0;
  // y(u), u in [0, 1]: starts with the node's offset, slope and curvature and ends with all of them zero.
  const double a0 = at.y, a1 = slope * length;
  const double a2 = bend * std::pow(1 + slope * slope, 1.5) * length * length / 2;
  const double a3 = -10 * a0 - 6 * a1 - 3 * a2, a4 = 15 * a0 + 8 * a1 + 3 * a2, a5 = -6 * a0 - 3 * a1 - a2;
  const auto y = [&](double u) { return a0 + u * (a1 + u * (a2 + u * (a3 + u * (a4 + u * a5)))); };
  const auto y1 = [&](double u) {
    return (a1 + u * (2 * a2 + u * (3 * a3 + u * (4 * a4 + u * 5 * a5)))) / length;
  };
  const auto y2 = [&](double u) {
    return (2 * a2 + u * (6 * a3 + u * (12 * a4 + u * 20 * a5))) / (length * length);
  };
  const double most = primitives_.curvature(MotionPrimitives::kLevels - 1);
  constexpr int kLooks = 16;
  for (int i = 1; i < kLooks; ++i) {
    const double u = static_cast<double>(i) / kLooks, d = y1(u);
    if (std::fabs(y2(u)) > most * std::pow(1 + d * d, 1.5)) return false;
  }
  if (node.parent >= 0) {
    write(index, path);
  } else {
    path.spots[0] = {{}, 0.0f, 1};
    path.count = 1;
    path.direction_changes = 0;
  }
  if (path.spots[path.count - 1].direction < 1) ++path.direction_changes;
  const double end = kBehind - base_, spacing = MotionPrimitives::kSpacing;
  float cost = node.cost;
  for (double s = at.x; s + spacing / 2 < end;) {
    const double before = std::atan(s < straight_from ? y1((s - at.x) / length) : 0.0);
    s += spacing * std::cos(before);
    const bool bends = s < straight_from;
    const double u = (s - at.x) / length;
    const Pose2 pose = *task.passage * Pose2{s, bends ? y(u) : 0.0, bends ? std::atan(y1(u)) : 0.0};
    const bool leaving = node.parent < 0 && s - at.x < kLeaving;
    if (path.count == HybridAStarPath::kMax || !outline_free(field, pose, leaving ? depth_ : 0.0f)) {
      path.count = 0;
      return false;
    }
    cost += static_cast<float>(spacing);
    path.spots[path.count++] = {pose, cost, 1};
  }
  if (path.count > 1 && node.parent < 0) path.spots[0].direction = 1;
  path.complete = path.through = path.tight = true;
  path.left = 0;
  return path.count > 1;
}

bool HybridAStarSearch::find(const DistanceField& field, const CostToGo& cost_to_go,
                             const HybridAStarTask& task, HybridAStarPath& path) {
  path.count = 0;
  path.complete = false;
  path.tight = task.tight;
  path.through = false;
  tight_ = task.tight;
  depth_ = tight_ || task.passage ? field.points().depth(outline_, {base_, 0, 0}) : 0.0f;
  // What is inside the body itself may come no deeper, and nothing may come into it.
  depth_ = std::max(depth_, std::min(depth_ + kDeeper / 2, static_cast<float>(kTightMargin))) + kRounding;
  if (++round_ == 0) {  // The round counter wrapped: all old marks are invalid.
    std::fill(closed_.begin(), closed_.end(), 0);
    round_ = 1;
  }
  nodes_.clear();
  open_.clear();
  for (std::size_t i = 0; i < disc_count_; ++i) least_[i] = field.clearance(discs_[i], 0.0f) - kDeeper;
  Node start{};
  start.cost_to_go = cost_to_go.at(static_cast<float>(base_), 0.0f);
  start.level = static_cast<std::int8_t>(task.level);
  start.direction = static_cast<std::int8_t>(task.direction);
  nodes_.push_back(start);
  if (task.passage && expand_analytically(field, task, 0, path)) return true;
  if (start.cost_to_go >= CostToGo::kUnreachable) return false;
  if (!task.passage && cost_to_go.least() > 0 &&
      start.cost_to_go < cost_to_go.least() + 2 * kLeastGainTowards)
    return false;
  open_.push_back({kHeuristicWeight * start.cost_to_go, 0});
  std::int32_t best = -1;
  float nearest = start.cost_to_go - kLeastGainTowards;
  for (int n = 0; n < kExpansions && !open_.empty();) {
    std::pop_heap(open_.begin(), open_.end());
    const std::int32_t index = open_.back().node;
    open_.pop_back();
    const Node& node = nodes_[index];
    if (node.parent >= 0) {
      const auto there = static_cast<std::size_t>(state(node.pose, node.direction));
      if (closed_[there] == round_) continue;
      closed_[there] = round_;
      if (task.passage) {
        if (expand_analytically(field, task, index, path)) return true;
      } else if (node.direction != 0 && ends(cost_to_go, task, node)) {
        path.complete = true;
        write(index, path);
        return path.count > 1;
      }
      if (node.cost_to_go < nearest) {
        nearest = node.cost_to_go;
        best = index;
      }
    }
    expand(field, cost_to_go, task, index);
    ++n;
  }
  if (best < 0 || task.passage) return false;
  write(best, path);
  return path.count > 1;
}

void HybridAStarSearch::write(std::int32_t index, HybridAStarPath& path) const {
  path.left = nodes_[index].cost_to_go;
  std::array<std::int32_t, HybridAStarPath::kMax> chain;
  std::size_t length = 0;
  for (std::int32_t i = index; nodes_[i].parent >= 0; i = nodes_[i].parent) {
    if (length == chain.size()) break;
    chain[length++] = i;
  }
  path.spots[0] = {{}, 0.0f, 0};
  path.count = 1;
  path.direction_changes = 0;
  while (length-- > 0) {
    const Node& node = nodes_[chain[length]];
    const Node& before = nodes_[node.parent];
    if (path.count + MotionPrimitives::kPoses > HybridAStarPath::kMax) {
      path.complete = false;  // A longer path consists of many manoeuvres; the rest is planned later.
      while (path.count > 1 && path.spots[path.count - 1].direction == 0) --path.count;
      break;
    }
    if (path.count > 1 && path.spots[path.count - 1].direction != node.direction) ++path.direction_changes;
    const MotionPrimitives::MotionPrimitive& motion =
        node.direction == 0 ? primitives_.turn(node.from)
                            : primitives_.motion(node.from, node.level, node.direction);
    for (int i = 0; i < MotionPrimitives::kPoses; ++i) {
      const float share = static_cast<float>(i + 1) / MotionPrimitives::kPoses;
      path.spots[path.count++] = {before.pose * motion.poses[i],
                                  before.cost + share * (node.cost - before.cost), node.direction};
    }
  }
  if (path.count > 1) path.spots[0].direction = path.spots[1].direction;
}

}  // namespace adit::nav
