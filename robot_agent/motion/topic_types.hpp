// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/config/platform.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/motion/input_faults.hpp"
#include "robot_agent/motion/velocity_writer.hpp"

namespace adit::agent {

/// A topic of the robot domain as the agent uses it.
struct TopicUse {
  std::string topic{};               ///< DDS name.
  std::vector<std::string> types{};  ///< DDS types of which any fits; the first one is the usual one.
  bool writes{};                     ///< The agent writes it; otherwise it reads it.
};

/// The topics that an agent with this platform uses. `detections`, `reports`: names without rt/.
std::vector<TopicUse> used_topics(const Platform& platform, VelocityType velocity,
                                  const std::vector<std::string>& detections = {},
                                  const std::vector<std::string>& reports = {});

/// The writers and readers of other participants that have one of these topics with another type: DDS
/// delivers nothing between them and says nothing. One fault for each topic.
std::vector<InputFault> type_clashes(const wire::Participant& wire, const std::vector<TopicUse>& topics);

/// The ROS 2 name of a DDS type: "geometry_msgs/msg/Twist" of "geometry_msgs::msg::dds_::Twist_".
std::string ros_type(const std::string& dds_type);

}  // namespace adit::agent
