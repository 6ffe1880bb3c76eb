// SPDX-License-Identifier: Apache-2.0
#include "core/supervisor/restart_policy_engine.hpp"

#include <algorithm>

namespace adit {

void RestartPolicyEngine::add(PartSpec spec) {
  status_.push_back({std::move(spec)});
  histories_.emplace_back();
}

Result<std::size_t> RestartPolicyEngine::find(const std::string& part) const {
  std::string names;
  for (std::size_t i = 0; i < status_.size(); ++i) {
    if (status_[i].spec.name == part) return i;
    names += (names.empty() ? "" : ", ") + status_[i].spec.name;
  }
  return Error{Reason::bad_argument, "no component is named " + part + " (" + names + ")"};
}

RestartPolicyEngine::Decision RestartPolicyEngine::poll(const std::vector<HealthSample>& samples, Time now) {
  Decision decision;
  // A late poll is followed by an early one: on average each is worth one period.
  allowance_ = std::min(allowance_ + params_.period, 2 * params_.period);
  const Duration lived = polled_ ? std::min(now - *polled_, allowance_) : Duration{};
  allowance_ -= lived;
  polled_ = now;
  for (std::size_t i = 0; i < status_.size() && i < samples.size() && !escalated_; ++i)
    watch(i, samples[i], lived, now, decision);
  return decision;
}

void RestartPolicyEngine::watch(std::size_t part, const HealthSample& sample, Duration lived, Time now,
                                Decision& decision) {
  PartStatus& status = status_[part];
  History& history = histories_[part];
  switch (status.state) {
    case PartState::waiting:
      if (now >= history.resume) add_action(part, RestartAction::Kind::restart, decision);
      return;
    case PartState::failed:
    case PartState::hung:
      return;
    case PartState::starting:
    case PartState::up:
      break;
  }
  if (sample.failed) return failed(part, sample.text, now, decision);
  const bool is_beating =
      sample.running && (status.state == PartState::starting || sample.heartbeats != history.heartbeats);
  history.heartbeats = sample.heartbeats;
  const bool compared = !is_beating && sample.use && history.use;
  const Duration counts = compared ? answerable(*history.use, *sample.use, lived) : lived;
  history.use = is_beating ? std::nullopt : sample.use;
  status.silent = is_beating ? Duration{} : status.silent + lived;
  status.stalled = is_beating ? Duration{} : status.stalled + counts;
  const Duration patience = status.state == PartState::starting ? params_.start : params_.silence;
  if (status.stalled > patience) return hung(part, decision);
  if (!sample.running || status.state == PartState::up) return;
  status.state = PartState::up;
  if (!history.was_down) return;
  history.was_down = false;
  ++status.restarts;
  decision.events.push_back({PartEvent::Kind::back, part, "works again"});
}

void RestartPolicyEngine::failed(std::size_t part, const std::string& text, Time now, Decision& decision) {
  PartStatus& status = status_[part];
  History& history = histories_[part];
  status.text = text;
  history.was_down = true;
  decision.events.push_back({PartEvent::Kind::failed, part, text});
  if (status.spec.policy == RestartPolicy::by_operator) {
    status.state = PartState::failed;
    return;
  }
  while (!history.attempts.empty() && now - history.attempts.front() >= params_.window)
    history.attempts.pop_front();
  if (history.attempts.size() >= static_cast<std::size_t>(std::max(1, params_.attempts)))
    return escalate(part, "failed once more after " + std::to_string(history.attempts.size()) + " restarts",
                    decision);
  Duration pause = params_.first_pause;
  for (std::size_t i = 0; i < history.attempts.size() && pause < params_.longest_pause; ++i) pause *= 4;
  history.attempts.push_back(now);
  history.resume = now + std::min(pause, params_.longest_pause);
  status.state = PartState::waiting;
}

void RestartPolicyEngine::hung(std::size_t part, Decision& decision) {
  PartStatus& status = status_[part];
  histories_[part].was_down = true;
  ++status.hangs;
  status.text = "does not return";
  decision.events.push_back({PartEvent::Kind::hung, part, status.text});
  if (!status.spec.replaceable) return escalate(part, "hangs and cannot be replaced", decision);
  if (++left_behind_ > params_.hangs) return escalate(part, "hangs, and so does another component", decision);
  if (status.spec.policy == RestartPolicy::automatic)
    return add_action(part, RestartAction::Kind::replace, decision);
  status.state = PartState::hung;
  decision.actions.push_back({RestartAction::Kind::abandon, part});
}

void RestartPolicyEngine::add_action(std::size_t part, RestartAction::Kind kind, Decision& decision) {
  status_[part].state = PartState::starting;
  status_[part].silent = status_[part].stalled = Duration{};
  histories_[part].use.reset();
  decision.actions.push_back({kind, part});
}

void RestartPolicyEngine::escalate(std::size_t part, const std::string& why, Decision& decision) {
  escalated_ = true;
  if (status_[part].state != PartState::hung) status_[part].state = PartState::failed;
  decision.actions.push_back({RestartAction::Kind::escalate, part});
  decision.events.push_back({PartEvent::Kind::escalated, part, status_[part].spec.name + " " + why});
}

Result<RestartPolicyEngine::Decision> RestartPolicyEngine::restart(const std::string& part, Time) {
  const auto found = find(part);
  if (!found) return found.error();
  Decision decision;
  if (escalated_) return decision;
  histories_[*found].attempts.clear();
  histories_[*found].was_down = true;
  const bool hangs = status_[*found].state == PartState::hung;
  // Restarting a component that hangs does not make it return sooner: its silence continues to count.
  const PartStatus before = status_[*found];
  add_action(*found, hangs ? RestartAction::Kind::replace : RestartAction::Kind::restart, decision);
  if (!hangs) {
    status_[*found].silent = before.silent;
    status_[*found].stalled = before.stalled;
  }
  return decision;
}

Result<RestartPolicyEngine::Decision> RestartPolicyEngine::set_policy(const std::string& part,
                                                                      RestartPolicy policy, Time now) {
  const auto found = find(part);
  if (!found) return found.error();
  PartStatus& status = status_[*found];
  if (status.spec.always && policy != RestartPolicy::automatic)
    return Error{Reason::not_supported, part + " takes the operators' word itself: it is restarted always"};
  status.spec.policy = policy;
  const bool down = status.state == PartState::failed || status.state == PartState::hung;
  if (policy == RestartPolicy::automatic && down) return restart(part, now);
  return Decision{};
}

}  // namespace adit
