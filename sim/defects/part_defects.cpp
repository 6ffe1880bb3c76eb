// SPDX-License-Identifier: Apache-2.0
// Defects of a part of the agent that a double replaces, and of what its sensors see.
#include <cmath>
#include <cstring>
#include <limits>

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "nav/planners/planner.hpp"
#include "robot_agent/behaviour/mode_module.hpp"
#include "robot_agent/behaviour/mode_table.hpp"
#include "sensor_msgs/msg/PointCloud2.h"
#include "sim/defects/decorations.hpp"

namespace adit::sim {
namespace {

/// Plans straight at the goal, through everything.
class StraightPlanner final : public nav::Planner {
 public:
  explicit StraightPlanner(double max_speed) : max_speed_(max_speed) {}
  nav::Plan plan(const nav::Target& target, const Pose2& pose, std::span<const nav::ObstaclePoint>,
                 double stamp_s) override {
    nav::Plan plan{};
    plan.stamp_s = stamp_s;
    if (target.kind != nav::Target::Kind::goal) return plan;
    const Eigen::Vector2d way = target.goal - pose.position();
    constexpr double kSpacing = 0.05;  // m
    const double yaw = std::atan2(way.y(), way.x());
    plan.max_speed = max_speed_;
    while (plan.pose_count < nav::Plan::kMaxPath && kSpacing * plan.pose_count <= way.norm()) {
      const Eigen::Vector2d at = pose.position() + kSpacing * plan.pose_count * way.normalized();
      plan.poses[plan.pose_count++] = {at.x(), at.y(), yaw};
    }
    plan.length = kSpacing * (plan.pose_count - 1);
    return plan;
  }

 private:
  double max_speed_;
};

/// The shipped modes without the condition that the robot is not stopped.
std::shared_ptr<const agent::ModeTable> modes_without_stop() {
  std::vector<agent::ModeRow> rows = agent::ModeTable::shipped().rows();
  for (agent::ModeRow& row : rows)
    std::erase_if(row.conditions, [](const agent::Condition& condition) {
      return condition.leaf == agent::conditions::kNotStopped.leaf;
    });
  return std::make_shared<const agent::ModeTable>(std::move(rows));
}

/// A convoy_follow that asks for no place in a convoy, and drives ahead.
class FollowsNobody final : public agent::ModeModule {
 public:
  explicit FollowsNobody(const agent::ModeContext& context) : output_(context.output) {}
  static std::unique_ptr<agent::ModeModule> make(const agent::ModeContext& context) {
    return std::make_unique<FollowsNobody>(context);
  }
  void tick(bool, Time now) override { output_.write(agent::Velocity{{0.3, 0.0, 0.0}, true}, now); }

 private:
  agent::Mux::Output output_;
};

std::shared_ptr<const agent::ModeTable> modes_that_follow_nobody() {
  std::vector<agent::ModeRow> rows = agent::ModeTable::shipped().rows();
  for (agent::ModeRow& row : rows) {
    if (row.name != "convoy_follow") continue;
    row.make = FollowsNobody::make;
    for (agent::Condition& condition : row.conditions)
      if (condition.leaf == "InConvoy" || condition.leaf == "LeaderKnown" || condition.leaf == "OrderAgrees")
        condition.holds = [](const agent::Facts&) { return true; };
  }
  return std::make_shared<const agent::ModeTable>(std::move(rows));
}

/// A get_out that operators may request, and that drives ahead without being asked by any robot.
std::shared_ptr<const agent::ModeTable> modes_that_yield_unasked() {
  std::vector<agent::ModeRow> rows = agent::ModeTable::shipped().rows();
  for (agent::ModeRow& row : rows) {
    if (row.name != "get_out") continue;
    row.make = FollowsNobody::make;
    row.commanded_by.holder = true;
    for (agent::Condition& condition : row.conditions)
      if (condition.leaf == "YieldAllowed" || condition.leaf == "InTheWay")
        condition.holds = [](const agent::Facts&) { return true; };
  }
  return std::make_shared<const agent::ModeTable>(std::move(rows));
}

/// Takes out of every scan what stands on the ground.
class SeesGroundAlone final : public Interceptor {
 public:
  /// `lidar_height`: of the origin of the clouds that are not in base_link, m.
  explicit SeesGroundAlone(double lidar_height) : lidar_height_(static_cast<float>(lidar_height)) {}
  std::vector<Arrival> received(Arrival arrival) override {
    sensor_msgs::msg::PointCloud2 cloud;
    if (arrival.topic->name == std::string_view(wire::topics::kPoints.name) &&
        wire::decode(arrival.cdr, cloud)) {
      flatten(cloud);
      wire::encode(cloud, arrival.cdr);
    }
    return Interceptor::received(std::move(arrival));
  }

 private:
  void flatten(sensor_msgs::msg::PointCloud2& cloud) const {
    constexpr float kGround = 0.05f;  // Highest ground, base_link, m.
    const float highest = cloud.header().frame_id() == "base_link" ? kGround : kGround - lidar_height_;
    const std::uint32_t step = cloud.point_step();
    const float away = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t at = 0; step >= 12 && at + step <= cloud.data().size(); at += step) {
      float z = 0.0f;
      std::memcpy(&z, cloud.data().data() + at + 8, sizeof z);
      if (z > highest) std::memcpy(cloud.data().data() + at + 8, &away, sizeof away);
    }
  }

  float lidar_height_;
};

}  // namespace

namespace decorations {

Decoration blind_planner(const Subject& subject) {
  Decoration decoration;
  decoration.parameters = [speed = subject.platform.max_speed](agent::AgentParams& params) {
    params.local_planner = [speed] { return std::make_unique<StraightPlanner>(speed); };
    params.platform.router = "none";  // one that plans blindly is not led either
  };
  return decoration;
}

Decoration blind_and_unwatched(const Subject& subject) {
  Decoration decoration = blind_planner(subject);
  decoration.wires = std::make_unique<SeesGroundAlone>(subject.platform.lidar().mounting.z);
  return decoration;
}

Decoration follows_nobody(const Subject&) {
  Decoration decoration;
  decoration.parameters = [](agent::AgentParams& params) { params.modes = modes_that_follow_nobody(); };
  return decoration;
}

Decoration yields_unasked(const Subject&) {
  Decoration decoration;
  decoration.parameters = [](agent::AgentParams& params) { params.modes = modes_that_yield_unasked(); };
  return decoration;
}

Decoration drives_through_stop(const Subject&) {
  Decoration decoration;
  decoration.parameters = [](agent::AgentParams& params) { params.modes = modes_without_stop(); };
  return decoration;
}

}  // namespace decorations
}  // namespace adit::sim
