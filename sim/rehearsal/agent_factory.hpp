#pragma once
#include <functional>
#include <memory>

#include "core/config/platform.hpp"
#include "core/exec/executor.hpp"
#include "core/wire/wire.hpp"
#include "sim/rehearsal/scenario.hpp"

namespace adit::sim {

/// What an agent is made of in a rehearsal.
struct AgentContext {
  const RobotSpec& spec;
  const Platform& platform;
  std::uint64_t seed{};
  Duration lock_lease{};
  Runtime& runtime;
  wire::Wire& radio;
  wire::Wire& robot;
};

/// Makes and starts an agent; it stops when the pointer is dropped. The rehearsal knows nothing more of
/// it, so tests put agents with deliberate defects in its place.
using AgentFactory = std::function<Result<std::shared_ptr<void>>(const AgentContext&)>;

/// The product's agent. `defect`: one of robot_agent/defects.hpp, in the library adit::rehearsal_defects
/// only; there the empty name means none. Reason::bad_argument for a name it does not know.
Result<AgentFactory> make_agent_factory(const std::string& defect = {});

}  // namespace adit::sim
