// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/topic_refusals.hpp"

#include <algorithm>

namespace adit::agent {

void TopicRefusals::refuse(const std::string& topic, const Error& why) {
  const std::uint64_t count = ++refused_[topic];
  fault_({topic,
          "sensor_refused",
          Severity::warning,
          {why.reason, "/" + topic + ": " + why.text + " (" + std::to_string(count) + " refused so far)"}});
}

void TopicRefusals::look(const wire::Participant& wire, const std::vector<std::string>& topics,
                         const std::string& text) {
  std::map<std::string, std::uint64_t> malformed;
  for (const wire::TopicCount& count : wire.counters().topics)
    for (const std::string& topic : topics)
      if (count.topic == "rt/" + topic) malformed[topic] += count.malformed;
  for (const auto& [topic, count] : malformed)
    if (const std::uint64_t more = count - std::min(malformed_[topic], count); more > 0) {
      refused_[topic] += more - 1;
      refuse(topic, {Reason::malformed, text});
    }
  malformed_ = std::move(malformed);
}

std::uint64_t TopicRefusals::count() const {
  std::uint64_t sum = 0;
  for (const auto& [topic, count] : refused_) sum += count;
  return sum;
}

}  // namespace adit::agent
