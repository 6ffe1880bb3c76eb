// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/link.h"
#include "adit/robot.h"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/BatteryState.h"
#include "sensor_msgs/msg/Imu.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "tf2_msgs/msg/TFMessage.h"

namespace adit::wire {

/// A topic with a well-formed sample of it, and its decoder.
struct Example {
  TopicInfo topic{};
  std::vector<std::uint8_t> bytes{};
  std::function<bool(std::span<const std::uint8_t>)> decodes{};
};

template <class T>
Example example(const Topic<T>& topic, const T& sample) {
  Example result{topic, {}, [](std::span<const std::uint8_t> bytes) {
                   T decoded;
                   return decode(bytes, decoded);
                 }};
  encode(sample, result.bytes);
  return result;
}

/// One sample of every topic there is, with texts and sequences filled.
inline std::vector<Example> examples() {
  std::vector<Example> all;
  radio::Capabilities capabilities;
  capabilities.name("r1");
  capabilities.platform("wheeled");
  capabilities.sensors({"lidar", "imu"});
  capabilities.modes({"hold", "manual", "waypoint"});
  all.push_back(example(topics::kCapabilities, capabilities));
  radio::Presence presence;
  presence.name("op1");
  all.push_back(example(topics::kPresence, presence));
  radio::Command command;
  command.robot("r1");
  command.station("op1");
  command.words({"waypoint"});
  all.push_back(example(topics::kCommand, command));
  radio::Joystick joystick;
  joystick.robot("r1");
  all.push_back(example(topics::kJoystick, joystick));
  radio::Acknowledgement acknowledgement;
  acknowledgement.robot("r1");
  acknowledgement.station("op1");
  acknowledgement.text("locked by op2");
  acknowledgement.route().resize(1);
  acknowledgement.route()[0].points({1.0F, 2.0F, 0.0F});
  all.push_back(example(topics::kAcknowledgement, acknowledgement));
  radio::AuthorityStatus authority;
  authority.robot("r1");
  authority.stops().resize(2);
  authority.stops()[0].station("op1");
  all.push_back(example(topics::kAuthority, authority));
  radio::RobotState state;
  state.robot("r1");
  all.push_back(example(topics::kRobotState, state));
  radio::BehaviourState behaviour;
  behaviour.robot("r1");
  behaviour.modes().resize(4);
  behaviour.modes()[3].mode("waypoint");
  behaviour.areas().resize(2);
  behaviour.areas()[1].name("shaft");
  behaviour.areas()[1].corners({0.0F, 0.0F, 4.0F, 0.0F, 4.0F, 4.0F});
  all.push_back(example(topics::kBehaviour, behaviour));
  radio::Route route;
  route.robot("r1");
  route.corners(3);
  route.points({10, 0, 0, 10, 20, -1});
  all.push_back(example(topics::kRoute, route));
  radio::Notification notification;
  notification.robot("r1");
  notification.code("taken");
  all.push_back(example(topics::kNotification, notification));
  radio::Health health;
  health.robot("r1");
  health.components().resize(3);
  health.components()[1].name("planner");
  all.push_back(example(topics::kHealth, health));
  radio::LinkReport link;
  link.agent("r1");
  link.topics().resize(5);
  link.topics()[2].topic("adit/robot_state");
  all.push_back(example(topics::kLinkReport, link));
  geometry_msgs::msg::Twist twist;
  all.push_back(example(topics::kCmdVel, twist));
  nav_msgs::msg::Odometry odometry;
  odometry.child_frame_id("base_link");
  all.push_back(example(topics::kOdom, odometry));
  sensor_msgs::msg::PointCloud2 points;
  points.fields().resize(3);
  points.fields()[0].name("x");
  points.data().resize(64);
  all.push_back(example(topics::kPoints, points));
  sensor_msgs::msg::Imu imu;
  imu.orientation_covariance()[0] = -1.0;
  all.push_back(example(topics::kImu, imu));
  tf2_msgs::msg::TFMessage frames;
  frames.transforms().resize(2);
  frames.transforms()[0].header().frame_id("base_link");
  frames.transforms()[0].child_frame_id("lidar");
  all.push_back(example(topics::kTfStatic, frames));
  sensor_msgs::msg::BatteryState battery;
  battery.cell_voltage().resize(4);
  all.push_back(example(topics::kBattery, battery));
  return all;
}

}  // namespace adit::wire
