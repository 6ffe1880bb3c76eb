// SPDX-License-Identifier: Apache-2.0
#include "core/supervisor/supervisor.hpp"

namespace adit {

Supervisor::Supervisor(SupervisionParams params, Executor& strand, Log log, Outputs outputs)
    : Component("supervisor", strand, std::move(log)),
      params_(params),
      outputs_(std::move(outputs)),
      restart_policy_(params) {}

void Supervisor::watch(Unit& unit, PartSpec spec) {
  units_.push_back(&unit);
  restart_policy_.add(std::move(spec));
}

Result<void> Supervisor::on_start() {
  const std::function<void()> kick = [strand = &executor(), poll = guard([this] { poll(); })] {
    strand->post(poll);
  };
  for (Unit* unit : units_) {
    unit->on_change(kick);
    unit->restart();
  }
  timer_ = every(params_.period, [this] {
    poll();
    if (outputs_.looked) outputs_.looked(now());
  });
  return {};
}

void Supervisor::on_stop() { timer_.cancel(); }

void Supervisor::poll() {
  std::vector<HealthSample> samples;
  for (std::size_t i = 0; i < units_.size(); ++i) {
    samples.push_back(units_[i]->health_sample());
    if (!restart_policy_.doubts(i)) continue;
    const auto slot = units_[i]->slot();
    if (const auto* thread = dynamic_cast<const OnProcessor*>(slot->strand.get()))
      samples.back().use = thread->processor_use();
  }
  execute(restart_policy_.poll(samples, now()));
}

void Supervisor::execute(const RestartPolicyEngine::Decision& decision) {
  for (const PartEvent& event : decision.events) {
    const std::string& part = units_[event.part]->name();
    log().warn(part + ": " + event.text);
    if (outputs_.notify) outputs_.notify(event, part);
  }
  for (const RestartAction& action : decision.actions) {
    Unit& unit = *units_[action.part];
    switch (action.kind) {
      case RestartAction::Kind::restart:
        unit.restart();
        break;
      case RestartAction::Kind::replace:
        unit.replace();
        break;
      case RestartAction::Kind::abandon:
        unit.abandon();
        break;
      case RestartAction::Kind::escalate:
        unit.revoke();
        if (outputs_.escalate) outputs_.escalate(decision.events.back().text);
        break;
    }
  }
}

Result<void> Supervisor::restart(const std::string& part) {
  const auto decision = restart_policy_.restart(part, now());
  if (!decision) return decision.error();
  execute(*decision);
  return {};
}

Result<void> Supervisor::set_policy(const std::string& part, RestartPolicy policy) {
  const auto decision = restart_policy_.set_policy(part, policy, now());
  if (!decision) return decision.error();
  execute(*decision);
  return {};
}

}  // namespace adit
