// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/topic_types.hpp"

#include <algorithm>

#include "core/wire/topics.hpp"

namespace adit::agent {
namespace {

namespace topics = wire::topics;

constexpr std::size_t kShownType = 80;  // Characters; a stranger chooses its names.

TopicUse use(const wire::TopicInfo& topic, bool writes, const std::string& named = {}) {
  return {named.empty() ? topic.name : "rt/" + named, {topic.type}, writes};
}

std::string advice(const TopicUse& topic) {
  if (topic.topic != topics::kCmdVel.name) return "";
  const bool stamped = topic.types.front() == topics::kCmdVelStamped.type;
  return std::string(": set `cmd_vel: ") + (stamped ? "twist" : "twist_stamped") +
         "` in the robot's file, or change the driver";
}

}  // namespace

std::string ros_type(const std::string& dds_type) {
  std::string name = dds_type.substr(0, kShownType);
  if (const auto dds = name.find("::dds_::"); dds != std::string::npos) {
    name.erase(dds, 6);
    if (name.back() == '_') name.pop_back();
  }
  for (auto at = name.find("::"); at != std::string::npos; at = name.find("::")) name.replace(at, 2, "/");
  return name;
}

std::vector<TopicUse> used_topics(const Platform& platform, VelocityType velocity,
                                  const std::vector<std::string>& detections,
                                  const std::vector<std::string>& reports) {
  std::vector<TopicUse> all{use(topics::kOdom, false), use(topics::kScan, false),
                            use(topics::kTfStatic, false), use(topics::kBattery, false),
                            use(topics::kExternalCmdVel, false)};
  all.back().types.push_back(topics::kExternalCmdVelStamped.type);
  if (velocity == VelocityType::twist_stamped)
    all.push_back(use(topics::kCmdVelStamped, true));
  else
    all.push_back(use(topics::kCmdVel, true));
  for (const LidarConfig& lidar : platform.all_lidars())
    all.push_back(use(topics::kPoints, false, lidar.topic));
  if (platform.imu) all.push_back(use(topics::kImu, false, platform.imu->topic));
  for (const std::string& topic : detections) all.push_back(use(topics::kDetections, false, topic));
  for (const std::string& topic : reports) all.push_back(use(topics::kReports, false, topic));
  return all;
}

std::vector<InputFault> type_clashes(const wire::Participant& wire, const std::vector<TopicUse>& topics) {
  std::vector<InputFault> clashes;
  for (const TopicUse& topic : topics) {
    const auto endpoints = wire.endpoints(topic.topic);
    const auto fits = [&](const wire::RemoteEndpoint& endpoint) {
      return std::find(topic.types.begin(), topic.types.end(), endpoint.type) != topic.types.end();
    };
    const auto other = std::find_if_not(endpoints.begin(), endpoints.end(), fits);
    if (other == endpoints.end()) continue;
    const std::string name = topic.topic.substr(topic.topic.find('/') + 1);
    const bool served = std::any_of(endpoints.begin(), endpoints.end(), [&](const auto& endpoint) {
      return endpoint.writes != topic.writes && fits(endpoint);
    });
    clashes.push_back(
        {name,
         "type_differs",
         Severity::error,
         {Reason::type_differs, "/" + name + ": participant " + wire::to_string(other->participant) +
                                    (other->writes ? " sends " : " reads ") + ros_type(other->type) +
                                    ", but the agent " + (topic.writes ? "sends " : "reads ") +
                                    ros_type(topic.types.front()) +
                                    (served         ? ""
                                     : topic.writes ? ", which nobody reads"
                                                    : ", and hears nothing") +
                                    advice(topic)}});
  }
  return clashes;
}

}  // namespace adit::agent
