// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/convoy/without_members.hpp"

#include <algorithm>
#include <cmath>

namespace adit::agent {
namespace {

constexpr Duration kMaxAge = 1s;  // An older beacon says too little of where the robot is.
constexpr double kMargin = 0.3;   // m: errors of both poses.
constexpr double kReach = 20.0;   // m: the route map takes in nothing from farther away.

/// The outline of a robot, body frame of this one.
struct Box {
  Pose2 T_box_body{};
  double length{}, width{};  ///< Half of them, with the margin, m.
};

}  // namespace

std::shared_ptr<const Scan> without_members(const std::shared_ptr<const Scan>& scan, const Pose2& T_map_body,
                                            const std::vector<std::string>& members, const PeerTable& peers,
                                            Time now) {
  std::vector<Box> boxes;
  for (const std::string& name : members) {
    const Peer* peer = peers.find(name);
    if (!peer || !peer->heard_beacon || now - peer->heard_beacon->at > kMaxAge) continue;
    const TeamBeacon& beacon = peer->heard_beacon->beacon;
    const double age = seconds(now - peer->heard_beacon->at);
    const Pose2 pose = beacon.pose * Pose2{beacon.twist.vx * age, beacon.twist.vy * age, 0.0};
    if ((pose.position() - T_map_body.position()).norm() > kReach) continue;
    boxes.push_back({pose.inverse() * T_map_body, peer->length / 2 + kMargin, peer->width / 2 + kMargin});
  }
  if (boxes.empty()) return scan;
  auto rest = std::make_shared<Scan>();
  rest->body = scan->body;
  rest->points.reserve(scan->points.size());
  for (const Eigen::Vector3f& point : scan->points) {
    const Eigen::Vector2d place = point.head<2>().cast<double>();
    const bool inside = std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
      const Eigen::Vector2d in_box = box.T_box_body * place;
      return std::fabs(in_box.x()) < box.length && std::fabs(in_box.y()) < box.width;
    });
    if (!inside) rest->points.push_back(point);
  }
  return rest;
}

}  // namespace adit::agent
