#include "core/supervisor/supervisor.hpp"

namespace adit {

Supervisor::Supervisor(SupervisionParams params, Executor& strand, Log log, Outputs outputs)
    : Component("supervisor", strand, std::move(log)),
      params_(params),
      outputs_(std::move(outputs)),
      overseer_(params) {}

void Supervisor::watch(Unit& unit, PartSpec spec) {
  units_.push_back(&unit);
  overseer_.add(std::move(spec));
}

Result<void> Supervisor::on_start() {
  const std::function<void()> kick = [strand = &executor(), look = guard([this] { look(); })] {
    strand->post(look);
  };
  for (Unit* unit : units_) {
    unit->on_change(kick);
    unit->restart();
  }
  timer_ = every(params_.period, [this] {
    look();
    if (outputs_.looked) outputs_.looked(now());
  });
  return {};
}

void Supervisor::on_stop() { timer_.cancel(); }

void Supervisor::look() {
  std::vector<Pulse> pulses;
  for (std::size_t i = 0; i < units_.size(); ++i) {
    pulses.push_back(units_[i]->pulse());
    if (!overseer_.doubts(i)) continue;
    const auto seat = units_[i]->seat();
    if (const auto* thread = dynamic_cast<const OnProcessor*>(seat->strand.get()))
      pulses.back().use = thread->processor_use();
  }
  carry_out(overseer_.look(pulses, now()));
}

void Supervisor::carry_out(const Overseer::Verdict& verdict) {
  for (const PartEvent& event : verdict.events) {
    const std::string& part = units_[event.part]->name();
    log().warn(part + ": " + event.text);
    if (outputs_.tell) outputs_.tell(event, part);
  }
  for (const Order& order : verdict.orders) {
    Unit& unit = *units_[order.part];
    switch (order.kind) {
      case Order::Kind::restart:
        unit.restart();
        break;
      case Order::Kind::replace:
        unit.replace();
        break;
      case Order::Kind::abandon:
        unit.abandon();
        break;
      case Order::Kind::escalate:
        unit.revoke();
        if (outputs_.escalate) outputs_.escalate(verdict.events.back().text);
        break;
    }
  }
}

Result<void> Supervisor::restart(const std::string& part) {
  const auto verdict = overseer_.restart(part, now());
  if (!verdict) return verdict.error();
  carry_out(*verdict);
  return {};
}

Result<void> Supervisor::set_policy(const std::string& part, RestartPolicy policy) {
  const auto verdict = overseer_.set_policy(part, policy, now());
  if (!verdict) return verdict.error();
  carry_out(*verdict);
  return {};
}

}  // namespace adit
