// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/team_robot.hpp"

#include <algorithm>
#include <cmath>

namespace adit::agent {
namespace {

constexpr double kPoseErrors = 0.3;  // m: errors of both poses.
constexpr double kTallest = 2.0;     // m: of a robot with its mast, above the ground.
constexpr double kReach = 20.0;      // m: the route map takes in nothing from farther away.
constexpr double kOutline = 0.1;     // m: cells of the map around a robot's outline that are its own.

/// The outline of a robot, body frame of this one.
struct Box {
  PlanarTransform T_box_body;
  double length{}, width{};  ///< Half of them, with the margin, m.
  double low{}, high{};      ///< Heights in odom, m.
  float near_x{}, near_y{};  ///< Its centre in the body frame, m.
  float near2{};             ///< Squared radius around it that the outline does not leave, m2.

  /// Whether a point is near enough for contains(), which costs much more. Also true where something is not a
  /// number.
  bool is_near(const Eigen::Vector3f& point) const {
    const float dx = point.x() - near_x, dy = point.y() - near_y;
    return !(dx * dx + dy * dy > near2);
  }
  bool contains(const Eigen::Vector2d& place, double height) const {
    const Eigen::Vector2d in_box = T_box_body * place;
    return height > low && height < high && std::fabs(in_box.x()) < length && std::fabs(in_box.y()) < width;
  }
};

}  // namespace

std::shared_ptr<const Scan> without_team(const std::shared_ptr<const Scan>& scan,
                                         const std::vector<TeamRobot>& team) {
  const Pose2 body = scan->body.planar();
  std::vector<Box> boxes;
  for (const TeamRobot& robot : team) {
    if (!((robot.pose.position() - body.position()).norm() <= kReach)) continue;
    constexpr double kRounding = 1e-3;  // m2: of single precision, within kReach.
    const Eigen::Vector2d centre = (body.inverse() * robot.pose).position();
    const double length = robot.length / 2 + kPoseErrors, width = robot.width / 2 + kPoseErrors;
    boxes.push_back({PlanarTransform(robot.pose.inverse() * body), length, width, robot.z - kPoseErrors,
                     robot.z + kTallest, static_cast<float>(centre.x()), static_cast<float>(centre.y()),
                     static_cast<float>((length * length + width * width) * (1 + kRounding) + kRounding)});
  }
  if (boxes.empty()) return scan;
  // Returns on a robot, in their order.
  std::vector<std::size_t> on_robot;
  for (const Box& box : boxes)
    for (std::size_t n = 0; n < scan->points.size(); ++n) {
      const Eigen::Vector3f& point = scan->points[n];
      if (!box.is_near(point)) continue;
      const Eigen::Vector3d turned = scan->body.orientation * point.cast<double>();
      if (box.contains(point.head<2>().cast<double>(), scan->body.position.z() + turned.z()))
        on_robot.push_back(n);
    }
  if (on_robot.empty()) return scan;
  std::ranges::sort(on_robot);
  on_robot.erase(std::ranges::unique(on_robot).begin(), on_robot.end());
  auto rest = std::make_shared<Scan>();
  rest->body = scan->body;
  rest->located = scan->located;
  rest->jumps = scan->jumps;
  rest->planar = scan->planar;
  rest->movers = scan->movers;
  rest->parts = scan->parts;
  std::size_t part = 0, end = scan->parts.empty() ? scan->points.size() : scan->parts[0].count;
  for (const std::size_t n : on_robot) {
    while (n >= end && part + 1 < scan->parts.size()) end += scan->parts[++part].count;
    if (!rest->parts.empty()) --rest->parts[part].count;
  }
  const auto copy_others = [&on_robot](const auto& from, auto& to) {
    to.reserve(from.size());
    std::size_t begin = 0;
    const auto copy_until = [&](std::size_t n) {
      to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
                from.begin() + static_cast<std::ptrdiff_t>(n));
      begin = n + 1;
    };
    for (const std::size_t n : on_robot) copy_until(n);
    copy_until(from.size());
  };
  copy_others(scan->points, rest->points);
  if (!scan->isolated.empty()) copy_others(scan->isolated, rest->isolated);
  return rest;
}

// Cells that one call clears at most: 25 cars of 2 x 5 m. What a larger body hides stays in the map.
constexpr double kMostCleared = 100'000;

void set_team(nav::RoutePlanner& planner, const std::vector<TeamRobot>& team, double half_width) {
  constexpr double kStep = nav::kRouteCell / 2;
  std::vector<nav::TeamPlace> places;
  double rest = kMostCleared;
  for (const TeamRobot& robot : team) {
    const double length = robot.length / 2 + kOutline, width = robot.width / 2 + kOutline;
    const double cells = (2 * length / kStep + 1) * (2 * width / kStep + 1);
    if (cells <= rest) {  // False for NaN.
      rest -= cells;
      for (double x = -length; x <= length; x += kStep)
        for (double y = -width; y <= width; y += kStep) {
          const Eigen::Vector2d at = robot.pose * Eigen::Vector2d(x, y);
          planner.map().clear_obstacle({at.x(), at.y(), robot.z});
        }
    }
    if (robot.cost > 0.0)
      places.push_back({{robot.pose.x, robot.pose.y, robot.z},
                        std::max(robot.length, robot.width) / 2 + half_width,
                        robot.cost});
  }
  planner.map().set_team(std::move(places));
}

}  // namespace adit::agent
