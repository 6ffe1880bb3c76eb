// SPDX-License-Identifier: Apache-2.0
#include "nav/recovery/escape.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

constexpr double kStep = 0.10;                // Length of a motion, m.
constexpr double kTurn = 5.0 * M_PI / 180.0;  // Angle of a turn on the spot, rad.
constexpr double kCell = 0.05;                // States in the same cell and turn are equal, m.
constexpr float kMinClearance = 0.02f;        // An obstacle that is farther away may come as near as this, m.
constexpr float kCloser = 0.002f;             // A smaller change does not count as closer, m.
constexpr float kChange = 0.1f;               // Cost of a change of direction, m.

}  // namespace

// The poses of a car are those of base_link here. A curve moves base_link sideways, because a car turns about
// its rear axle.
Escape::Escape(const Platform& platform)
    : platform_(platform),
      body_(platform),
      bend_(platform.turns_on_spot() ? 1.0 / platform.length : 0.92 / platform.least_radius()),
      closed_(static_cast<std::size_t>(kSide) * kSide * kTurns, 0) {
  nodes_.reserve(kMaxNodes);
  open_.reserve(kMaxNodes);
}

std::optional<Plan> Escape::plan(const Pose2& pose, std::span<const ObstaclePoint> obstacles) {
  if (side_of(obstacles) == Side::none) return std::nullopt;
  points_.fill(obstacles, 0.0f);
  if (++round_ == 0) {
    std::fill(closed_.begin(), closed_.end(), 0);
    round_ = 1;
  }
  nodes_.clear();
  open_.clear();
  const float depth = points_.depth(body_, {});
  nodes_.push_back({.depth = depth, .least = depth});
  open_.push_back({0.0f, 0});
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end());
    const std::int32_t index = open_.back().node;
    open_.pop_back();
    const Node& node = nodes_[index];
    if (node.direction != 0 && node.depth <= -static_cast<float>(kClear)) return write(index, pose);
    expand(index);
  }
  return std::nullopt;
}

void Escape::expand(std::int32_t index) {
  const double rear = platform_.rear_axle();
  for (const int direction : {1, -1})
    for (const double bend : {0.0, bend_, -bend_}) {
      const double turn = direction * kStep * bend;
      const Pose2 motion =
          Pose2{-rear, 0, 0} *
          Pose2{direction * kStep * std::cos(turn / 2), direction * kStep * std::sin(turn / 2), turn} *
          Pose2{rear, 0, 0};
      offer(index, motion, direction, static_cast<float>(kStep));
    }
  if (!platform_.turns_on_spot()) return;
  for (const double turn : {kTurn, -kTurn})
    offer(index, {0, 0, turn}, 0, static_cast<float>(kTurn * body_.radius()));
}

void Escape::offer(std::int32_t from, const Pose2& motion, int direction, float cost) {
  const Node& before = nodes_[from];
  const Pose2 pose = before.pose * motion;
  const int x = static_cast<int>(std::floor(pose.x / kCell)) + kSide / 2;
  const int y = static_cast<int>(std::floor(pose.y / kCell)) + kSide / 2;
  if (x < 0 || y < 0 || x >= kSide || y >= kSide || nodes_.size() == kMaxNodes || open_.size() == kMaxNodes)
    return;
  const int turn = static_cast<int>(std::lround(pose.yaw / kTurn) + 2 * kTurns) % kTurns;
  auto& closed = closed_[(turn * kSide + y) * kSide + x];
  if (closed == round_) return;
  const float depth = points_.depth(body_, pose);
  if (depth > std::max(before.least, -kMinClearance) + kCloser) return;
  closed = round_;
  if (before.direction != direction && from != 0) cost += kChange;
  const float total = before.cost + cost;
  nodes_.push_back(
      {pose, total, depth, std::min(before.least, depth), from, static_cast<std::int8_t>(direction)});
  open_.push_back({total, static_cast<std::int32_t>(nodes_.size()) - 1});
  std::push_heap(open_.begin(), open_.end());
}

Side Escape::side_of(std::span<const ObstaclePoint> obstacles) const {
  float deepest = -static_cast<float>(kClear);
  Side side = Side::none;
  for (const ObstaclePoint& o : obstacles) {
    const float depth = o.cost < 1.0f ? -1.0f : body_.depth(o.x, o.y);
    if (depth <= deepest) continue;
    deepest = depth;
    const double along = o.x / platform_.length, across = o.y / platform_.width;
    side = std::fabs(along) > std::fabs(across) ? (along > 0 ? Side::ahead : Side::behind)
                                                : (across > 0 ? Side::left : Side::right);
  }
  return side;
}

Plan Escape::write(std::int32_t index, const Pose2& pose) const {
  std::array<std::int32_t, Plan::kMaxPath> chain;
  std::size_t length = 0;
  for (std::int32_t i = index; i > 0; i = nodes_[i].parent) {
    if (length == chain.size()) std::copy(chain.begin() + 1, chain.end(), chain.begin()), --length;
    chain[length++] = i;
  }
  Plan plan{};
  Pose2 start{};
  while (length > 0 && nodes_[chain[length - 1]].direction == 0) start = nodes_[chain[--length]].pose;
  plan.turn_first = start.yaw != 0.0;
  plan.turn = start.yaw > 0 ? 1 : start.yaw < 0 ? -1 : 0;
  plan.poses[plan.pose_count++] = pose * start;
  const int direction = length > 0 ? nodes_[chain[length - 1]].direction : 1;
  while (length > 0 && nodes_[chain[length - 1]].direction == direction && plan.pose_count < Plan::kMaxPath)
    plan.poses[plan.pose_count++] = pose * nodes_[chain[--length]].pose;
  plan.reverse = direction < 0;
  plan.length = kStep * static_cast<double>(plan.pose_count - 1);
  plan.max_speed = kSpeed;
  return plan;
}

}  // namespace adit::nav
