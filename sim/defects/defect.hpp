// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/store/disk.hpp"
#include "robot_agent/agent.hpp"
#include "sim/defects/interceptor.hpp"

namespace adit::sim {

/// The robot that gets a defect, at one start of its agent.
struct Subject {
  std::string robot{};
  const Platform& platform;
  Runtime& runtime;  ///< Of the agent's machine
  std::shared_ptr<store::Disk> disk{};
};

/// What a defect puts around one robot's agent; a part that is empty changes nothing.
struct Decoration {
  std::unique_ptr<Interceptor> wires{};                   ///< On both of its wires
  std::shared_ptr<store::Disk> disk{};                    ///< Instead of the robot's
  std::function<void(agent::AgentParams&)> parameters{};  ///< Called last, before the agent is made
};

/// A rule that is broken on purpose, so that tests see who finds it.
struct Defect {
  std::string_view name{};
  std::string_view what{};  ///< What the robot does wrong, in one line
  /// Decorates one start of one robot's agent.
  Decoration (*decorate)(const Subject&){};
  /// Decorates the wire of the robot's parent process; null: nothing does.
  std::unique_ptr<wire::Participant> (*parent)(std::unique_ptr<wire::Participant>){};
};

/// Every defect, in the order of the rules.
std::span<const Defect> defects();
/// The defect of that name, null when there is none.
const Defect* find_defect(std::string_view name);

}  // namespace adit::sim
