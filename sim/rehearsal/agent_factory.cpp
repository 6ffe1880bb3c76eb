// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/agent_factory.hpp"

#include "nav/planners/falco/falco_planner.hpp"
#include "robot_agent/agent.hpp"
#include "sim/defects/defect.hpp"
#include "sim/defects/intercepted_participant.hpp"

namespace adit::sim {
namespace {

class ProductAgent final : public RehearsedAgent {
 public:
  ProductAgent(agent::AgentParams params, const AgentContext& context, Decoration decoration)
      : decoration_(std::move(decoration)),
        radio_(intercepted(context.radio)),
        robot_(intercepted(context.robot)),
        agent_(std::move(params), context.runtime, radio_ ? *radio_ : context.radio,
               robot_ ? *robot_ : context.robot) {}
  Result<void> start() { return agent_.start(); }
  Result<void> inject(const std::string& component, ComponentFault fault) override {
    return agent_.inject(component, fault);
  }
  Result<void> find(findings::Finding finding) override {
    agent_.report(std::move(finding));
    return {};
  }

 private:
  std::unique_ptr<InterceptedParticipant> intercepted(wire::Participant& inner) {
    return decoration_.wires ? std::make_unique<InterceptedParticipant>(inner, *decoration_.wires) : nullptr;
  }
  Decoration decoration_;
  std::unique_ptr<InterceptedParticipant> radio_, robot_;
  agent::Agent agent_;
};

}  // namespace

Result<AgentFactory> make_agent_factory(const std::string& defect,
                                        std::function<void(agent::AgentParams&)> adjust) {
  const Defect* known = find_defect(defect);
  if (!defect.empty() && !known) return Error{Reason::bad_argument, "no defect of that name: " + defect};
  return AgentFactory([known, adjust = std::move(adjust)](
                          const AgentContext& context) -> Result<std::unique_ptr<RehearsedAgent>> {
    Decoration decoration =
        known ? known->decorate({context.spec.id, context.platform, context.runtime, context.disk})
              : Decoration{};
    agent::AgentParams params = agent::agent_params(context.spec.settings);
    // The map is the world's frame: the ground of the start is where the world has it, unless a key says so.
    params.start_height = context.spec.settings.start_height.value_or(context.start_ground);
    params.seed = context.seed;
    params.library = nav::PlannerLibrary::shared;
    params.disk = decoration.disk ? decoration.disk : context.disk;
    params.end = context.end;
    if (adjust) adjust(params);
    if (decoration.parameters) decoration.parameters(params);
    auto agent = std::make_unique<ProductAgent>(std::move(params), context, std::move(decoration));
    if (auto started = agent->start(); !started) return started.error();
    return std::unique_ptr<RehearsedAgent>(std::move(agent));
  });
}

WireDecorator make_parent_decorator(const std::string& defect) {
  const Defect* known = find_defect(defect);
  return known && known->parent ? WireDecorator(known->parent) : WireDecorator{};
}

}  // namespace adit::sim
