// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>

#include "core/component/fault.hpp"
#include "core/config/platform.hpp"
#include "core/exec/executor.hpp"
#include "core/findings/finding.hpp"
#include "core/store/disk.hpp"
#include "core/wire/participant.hpp"
#include "sim/rehearsal/scenario.hpp"

namespace adit::agent {
struct AgentParams;
}

namespace adit::sim {

/// An agent that runs in a rehearsal, as its faults see it; it stops when it is destroyed.
class RehearsedAgent {
 public:
  virtual ~RehearsedAgent() = default;
  RehearsedAgent() = default;
  RehearsedAgent(const RehearsedAgent&) = delete;
  RehearsedAgent& operator=(const RehearsedAgent&) = delete;

  /// Makes a callback of that component throw, or never return, from its own strand.
  /// Errors: bad_argument (no such component), not_supported.
  virtual Result<void> inject(const std::string& component, ComponentFault fault);
  /// One of its components has found something. Errors: not_supported.
  virtual Result<void> find(findings::Finding finding);
};

/// What an agent is made of in a rehearsal.
struct AgentContext {
  const RobotSpec& spec;
  const Platform& platform;
  std::uint64_t seed{};
  Runtime& runtime;
  wire::Participant& radio;
  wire::Participant& robot;
  std::shared_ptr<store::Disk> disk{};  ///< The robot's disk, which outlives the agent. Null: none.
  std::function<void(const std::string& why)> end{};  ///< Ends the agent's process, which is then restarted.
  double start_ground{};  ///< Height of the ground at the robot's start, world frame, m
};

/// Makes and starts an agent. The rehearsal knows nothing more of it, so tests put agents with deliberate
/// defects in its place.
using AgentFactory = std::function<Result<std::unique_ptr<RehearsedAgent>>(const AgentContext&)>;

/// Decorates a wire.
using WireDecorator = std::function<std::unique_ptr<wire::Participant>(std::unique_ptr<wire::Participant>)>;

/// The product's agent. `defect`: one of sim/defects/defect.hpp, which decorates what the agent is made of
/// and speaks through; empty: none. Errors: bad_argument for a name that no defect has. `adjust`, for tests:
/// changes what each agent is made of.
Result<AgentFactory> make_agent_factory(const std::string& defect = {},
                                        std::function<void(agent::AgentParams&)> adjust = {});
/// What the defect puts around the wire of each robot's parent process; empty: nothing, or no such defect.
WireDecorator make_parent_decorator(const std::string& defect);

}  // namespace adit::sim
