// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/supervisor/agent_supervisor.hpp"

#include <algorithm>
#include <cstdio>
#include <deque>

#include "adit/robot.h"
#include "core/contract/refusals.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"

namespace adit::agent {

using contract::ComponentHealth;

namespace {

constexpr Duration kHealthPeriod = 5s;
// After this silence of the command strand the supervisor sends zero itself.
constexpr Duration kCommandSilent = 120ms;
constexpr Duration kLastWords = 100ms;  // Time for the notification of an escalated failure.
constexpr const char* kAgent = "agent";

}  // namespace

class AgentSupervisor::Impl {
 public:
  Impl(AgentSupervisorParams params, Executor& strand, Notifier& notifier)
      : params_(std::move(params)),
        strand_(strand),
        notifier_(notifier),
        supervisor_(params_.supervision, strand, params_.log,
                    {[this](const PartEvent& event, const std::string& part) { notify(event, part); },
                     [this](const std::string& why) { escalate(why); }, [this](Time now) { looked(now); }}) {}

  Result<void> open(wire::Participant& radio, wire::Participant& robot) {
    radio_ = &radio;
    auto health = wire::Writer<radio::Health>::make(radio, wire::topics::kHealth);
    if (!health) return health.error();
    health_ = std::move(*health);
    auto zero = VelocityWriter::make(robot, params_.velocity);
    if (!zero) return zero.error();
    zero_ = std::move(*zero);
    return {};
  }

  void watch(Unit& unit, PartSpec spec) {
    specs_.push_back(spec);
    supervisor_.watch(unit, std::move(spec));
  }
  Executor& strand() { return strand_; }
  Supervisor& supervisor() { return supervisor_; }

  const PartSpec* find(const std::string& part) const {
    const auto found =
        std::find_if(specs_.begin(), specs_.end(), [&](const PartSpec& s) { return s.name == part; });
    return found == specs_.end() ? nullptr : &*found;
  }
  /// `verb`: "restart" also takes the agent. Driver and store have rows in the health report, too.
  Error unknown(const std::string& verb, const std::string& part) const {
    std::string names = verb == "restart" ? kAgent : "";
    for (const PartSpec& spec : specs_) names += (names.empty() ? "" : ", ") + spec.name;
    return {Reason::bad_argument, part + " is no component of the agent; " + verb + " takes " + names};
  }

  void note(ComponentHealth row, std::optional<Time> heard) {
    const auto known =
        std::find_if(notes_.begin(), notes_.end(), [&](const Note& n) { return n.row.name == row.name; });
    if (known != notes_.end())
      *known = {std::move(row), heard};
    else if (notes_.size() < kNotes)
      notes_.push_back({std::move(row), heard});
    changed_ = true;
  }

  std::vector<ComponentHealth> rows() const {
    std::vector<ComponentHealth> rows;
    for (const PartStatus& s : supervisor_.status())
      rows.push_back({s.spec.name, s.state, s.state == PartState::up,
                      s.spec.policy == RestartPolicy::automatic, static_cast<float>(seconds(s.silent)),
                      s.restarts, s.hangs, s.text});
    for (const Note& note : notes_) {
      rows.push_back(note.row);
      if (note.heard) rows.back().silent_for = static_cast<float>(seconds(strand_.now() - *note.heard));
    }
    return rows;
  }

  void escalate(const std::string& why) {
    if (ending_.active()) return;
    changed_ = true;
    ending_ = strand_.after(kLastWords, [this, why] {
      if (params_.end) params_.end(why);
    });
  }
  void touched() { changed_ = true; }
  void report_escalated(const std::string& why) {
    say(Severity::error, "escalated", why + "; the agent is restarted");
  }

 private:
  /// The state of a part of the robot that is not one of the supervisor's components.
  struct Note {
    ComponentHealth row{};
    std::optional<Time> heard{};
  };
  static constexpr std::size_t kNotes = 16;
  static constexpr std::size_t kUnsaid = 32;

  void notify(const PartEvent& event, const std::string& part) {
    changed_ = true;
    switch (event.kind) {
      case PartEvent::Kind::failed:
        return say(Severity::error, "component_failed", part + ": " + event.text);
      case PartEvent::Kind::hung:
        return say(Severity::error, "component_hung", part + ": " + event.text);
      case PartEvent::Kind::back:
        return say(Severity::info, "component_back", part + ": " + event.text);
      case PartEvent::Kind::escalated:
        return report_escalated(event.text);
    }
  }
  void say(Severity severity, const char* code, const std::string& text) {
    const Reason reason = severity == Severity::info ? Reason::none : Reason::internal;
    if (unsaid_.size() < kUnsaid) unsaid_.push_back({{}, severity, code, reason, text});
    say_all();
  }
  /// Sends the queued notifications; those that another strand blocks are sent at the next call.
  void say_all() {
    while (!unsaid_.empty() && notifier_.try_send(unsaid_.front())) unsaid_.pop_front();
  }

  /// Reports what the radio refused, and ends the process when a thread that receives hangs: nothing arrives
  /// any more then, not even a stop.
  void look_at_radio(Time now) {
    if (now - looked_at_radio_ < kRadioPeriod) return;
    looked_at_radio_ = now;
    const wire::WireCounters counters = radio_->counters();
    receiver_hangs_ = counters.receiving > kReceiverHangs ? receiver_hangs_ + 1 : 0;
    // A process that was stopped for a while hangs at the first look alone.
    if (receiver_hangs_ == 3) {
      const std::string why = "a thread that receives from the radio has hung for " +
                              std::to_string(counters.receiving / 1s) + " s";
      report_escalated(why);
      escalate(why);
    }
    const std::string told = refusals_.told(counters.refused, now);
    if (told.empty()) return;
    const std::string text =
        "datagrams that were refused since the start: " + contract::describe(counters.refused);
    note({.name = "radio", .state = PartState::up, .healthy = true, .automatic = true, .text = text}, {});
    say(Severity::warning, "radio_refused", params_.robot + " refuses datagrams: " + told);
  }

  void looked(Time now) {
    look_at_radio(now);
    const PartStatus& command = supervisor_.status().front();
    const bool commands = command.state == PartState::up && command.silent <= kCommandSilent;
    const bool ends = supervisor_.escalated() || ending_.active();
    if (!commands || ends) zero_.write({});
    if (commands && !ends && params_.alive) params_.alive();
    say_all();
    if (!changed_ && now - sent_ < kHealthPeriod) return;
    changed_ = false;
    sent_ = now;
    radio::Health sample = encode(contract::Health{params_.robot, rows()});
    sample.seq(++seq_);
    (void)health_.write(sample);
  }

  static constexpr Duration kRadioPeriod = 1s, kReceiverHangs = 5s;

  AgentSupervisorParams params_;
  Executor& strand_;
  Notifier& notifier_;
  Supervisor supervisor_;
  wire::Participant* radio_{};
  Time looked_at_radio_{};
  int receiver_hangs_{};
  contract::RefusalNews refusals_{};
  wire::Writer<radio::Health> health_{};
  VelocityWriter zero_{};
  std::vector<PartSpec> specs_{};  // Constant after the start: read from any thread.
  std::vector<Note> notes_{};
  std::deque<Notice> unsaid_{};
  std::uint64_t seq_{};
  bool changed_{true};
  Time sent_{};
  Timer ending_{};
};

AgentSupervisor::AgentSupervisor(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
AgentSupervisor::~AgentSupervisor() = default;

Result<std::unique_ptr<AgentSupervisor>> AgentSupervisor::open(AgentSupervisorParams params, Executor& strand,
                                                               wire::Participant& radio,
                                                               wire::Participant& robot, Notifier& notifier) {
  auto impl = std::make_unique<Impl>(std::move(params), strand, notifier);
  if (const auto opened = impl->open(radio, robot); !opened) return opened.error();
  return std::unique_ptr<AgentSupervisor>(new AgentSupervisor(std::move(impl)));
}

void AgentSupervisor::watch(Unit& unit, PartSpec spec) { impl_->watch(unit, std::move(spec)); }

void AgentSupervisor::start() {
  impl_->strand().post([impl = impl_.get()] { (void)impl->supervisor().start(); });
}

void AgentSupervisor::stop() { impl_->supervisor().stop(); }

void AgentSupervisor::note(ComponentHealth row, std::optional<Time> heard) {
  impl_->strand().post([impl = impl_.get(), row = std::move(row), heard] { impl->note(row, heard); });
}

Result<void> AgentSupervisor::restart(const std::string& component) {
  if (component == kAgent) {
    impl_->strand().post_control([impl = impl_.get()] {
      impl->report_escalated("an operator asked for it");
      impl->escalate("an operator asked for it");
    });
    return {};
  }
  if (!impl_->find(component)) return impl_->unknown("restart", component);
  impl_->strand().post_control([impl = impl_.get(), component] {
    (void)impl->supervisor().restart(component);
    impl->touched();
  });
  return {};
}

Result<void> AgentSupervisor::set_policy(const std::string& component, bool automatic) {
  const PartSpec* spec = impl_->find(component);
  if (!spec) return impl_->unknown("policy", component);
  if (spec->always && !automatic)
    return {Reason::not_supported, component + " takes the operators' word itself: it is always restarted"};
  impl_->strand().post_control([impl = impl_.get(), component, automatic] {
    (void)impl->supervisor().set_policy(component,
                                        automatic ? RestartPolicy::automatic : RestartPolicy::by_operator);
    impl->touched();
  });
  return {};
}

void AgentSupervisor::describe(std::function<void(const std::string&)> answer) {
  impl_->strand().post([impl = impl_.get(), answer = std::move(answer)] {
    std::string text;
    for (const ComponentHealth& row : impl->rows()) {
      char line[320];
      std::snprintf(line, sizeof line, "%-10s %-9s %-5s restarts %u, hung %u, silent %.1f s%s%s\n",
                    row.name.c_str(), name(row.state).data(),
                    !impl->find(row.name) ? "-"
                    : row.automatic       ? "auto"
                                          : "manual",
                    row.restarts, row.hung, row.silent_for, row.text.empty() ? "" : ": ", row.text.c_str());
      text += line;
    }
    answer(text);
  });
}

}  // namespace adit::agent
