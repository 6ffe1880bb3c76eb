// SPDX-License-Identifier: Apache-2.0
#include "sim/world/rectangle.hpp"

#include <algorithm>

namespace adit::sim {
namespace {

/// How far one of the axes of `a` separates it from `b`, m.
double along_axes(const Rectangle& a, const Rectangle& b) {
  const Pose2 between = a.pose.inverse() * b.pose;
  const double c = std::abs(std::cos(between.yaw)), s = std::abs(std::sin(between.yaw));
  const double reach_x = 0.5 * (a.length + b.length * c + b.width * s);
  const double reach_y = 0.5 * (a.width + b.length * s + b.width * c);
  return std::max(std::abs(between.x) - reach_x, std::abs(between.y) - reach_y);
}

/// Distance from a point to a rectangle that does not hold it.
double to_point(const Rectangle& a, const Eigen::Vector2d& p) {
  const Eigen::Vector2d q = (a.pose.inverse() * p).cwiseAbs();
  return std::hypot(std::max(0.0, q.x() - 0.5 * a.length), std::max(0.0, q.y() - 0.5 * a.width));
}

}  // namespace

std::array<Eigen::Vector2d, 4> Rectangle::corners() const {
  const double x = 0.5 * length, y = 0.5 * width;
  return {pose * Eigen::Vector2d(x, y), pose * Eigen::Vector2d(-x, y), pose * Eigen::Vector2d(-x, -y),
          pose * Eigen::Vector2d(x, -y)};
}

bool overlap(const Rectangle& a, const Rectangle& b) {
  if ((a.pose.position() - b.pose.position()).norm() >= a.radius() + b.radius()) return false;
  return separation(a, b) < 0.0;
}

double separation(const Rectangle& a, const Rectangle& b) {
  return std::max(along_axes(a, b), along_axes(b, a));
}

double distance(const Rectangle& a, const Rectangle& b) {
  if (overlap(a, b)) return 0.0;
  // Apart, the shortest way always begins at a corner of one of them.
  double shortest = to_point(a, b.corners()[0]);
  for (const Eigen::Vector2d& p : b.corners()) shortest = std::min(shortest, to_point(a, p));
  for (const Eigen::Vector2d& p : a.corners()) shortest = std::min(shortest, to_point(b, p));
  return shortest;
}

}  // namespace adit::sim
