// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/input_faults.hpp"

namespace adit::agent {

InputFault two_sources(const std::string& topic, const OneSource& source) {
  return {topic,
          "two_sources",
          Severity::error,
          {Reason::two_sources,
           "two participants send /" + topic + ": " + source.describe() + "; end one of them"}};
}

void InputFaults::report(const InputFault& fault, Time now) {
  contract::ComponentHealth health;
  {
    const std::lock_guard lock(mutex_);
    const Key key{fault.topic, fault.code, fault.cause.reason};
    const auto known = entries_.find(key);
    if (known != entries_.end()) {
      const bool lasts = now - known->second.seen < kQuiet;
      known->second.seen = now;
      if (lasts) return;
    } else if (entries_.size() >= kMost) {
      return;
    }
    entries_[key] = {fault.severity, fault.cause.text, now};
    health = row();
  }
  outputs_.tell({{}, fault.severity, fault.code, fault.cause.reason, robot_ + ": " + fault.cause.text});
  outputs_.note(health);
}

void InputFaults::tick(Time now) {
  contract::ComponentHealth health;
  {
    const std::lock_guard lock(mutex_);
    if (std::erase_if(entries_, [&](const auto& each) { return now - each.second.seen >= kQuiet; }) == 0)
      return;
    health = row();
  }
  outputs_.note(health);
}

contract::ComponentHealth InputFaults::row() const {
  contract::ComponentHealth health{
      .name = "inputs", .state = PartState::up, .healthy = true, .automatic = true};
  std::string warnings;
  for (const auto& [key, entry] : entries_) {
    const bool serious = entry.severity == Severity::error;
    std::string& text = serious ? health.text : warnings;
    text += (text.empty() ? "" : "; ") + entry.text;
    health.healthy = health.healthy && !serious;
  }
  if (!warnings.empty()) health.text += (health.text.empty() ? "" : "; ") + warnings;
  return health;
}

}  // namespace adit::agent
