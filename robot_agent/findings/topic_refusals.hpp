// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/wire/participant.hpp"
#include "robot_agent/motion/input_faults.hpp"

namespace adit::agent {

/// Counts what cannot be used of topics of the robot domain, and reports each reason.
class TopicRefusals {
 public:
  using Fault = std::function<void(const InputFault&)>;

  explicit TopicRefusals(Fault fault) : fault_(std::move(fault)) {}

  /// `topic`: without rt/.
  void refuse(const std::string& topic, const Error& why);
  /// Reports messages of the topics that the wire could not decode. About once a second.
  /// @param text  What is wrong with them.
  void look(const wire::Participant& wire, const std::vector<std::string>& topics, const std::string& text);
  /// Over all topics.
  std::uint64_t count() const;

 private:
  Fault fault_;
  std::map<std::string, std::uint64_t> refused_{};    ///< By topic.
  std::map<std::string, std::uint64_t> malformed_{};  ///< By topic, as the wire counted at the last look.
};

}  // namespace adit::agent
