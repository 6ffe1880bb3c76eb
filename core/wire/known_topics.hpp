// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>

#include "core/wire/participant.hpp"

namespace adit::wire {

/// The topics of one participant. DDS has one type per topic name and one kind of key per type name; both
/// adapters refuse a topic that contradicts that here.
class KnownTopics {
 public:
  /// Whether a topic of this name is known with another type, key or bound.
  bool contradicts(const TopicInfo& topic) const {
    const auto known = topics_.find(topic.name);
    return known != topics_.end() && known->second != Known{topic.type, topic.keyed, topic.max_bytes};
  }
  void forget(const std::string& name) { topics_.erase(name); }
  /// Adds a topic. Error bad_argument: a topic of this name has another type, key or bound, or the type is
  /// keyed in another topic and not here (or the reverse).
  Result<void> add(const TopicInfo& topic) {
    if (contradicts(topic)) {
      return Error{Reason::bad_argument,
                   std::string(topic.name) + " is a topic of type " + topics_.at(topic.name).type +
                       " already, with another type, key or bound than asked for (" + topic.type + ")"};
    }
    const auto type = types_.try_emplace(topic.type, topic.keyed).first;
    if (type->second != topic.keyed) {
      return Error{Reason::bad_argument, std::string(topic.name) + ": its type " + topic.type +
                                             " is used both with and without a key"};
    }
    topics_.try_emplace(topic.name, Known{topic.type, topic.keyed, topic.max_bytes});
    return {};
  }

 private:
  struct Known {
    std::string type{};
    bool keyed{};
    std::uint32_t max_bytes{};
    bool operator==(const Known&) const = default;
  };
  std::map<std::string, Known> topics_{};
  std::map<std::string, bool> types_{};  // Whether each type is keyed.
};

}  // namespace adit::wire
