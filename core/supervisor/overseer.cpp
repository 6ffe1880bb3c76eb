#include "core/supervisor/overseer.hpp"

#include <algorithm>

namespace adit {

void Overseer::add(PartSpec spec) {
  status_.push_back({std::move(spec)});
  courses_.emplace_back();
}

Result<std::size_t> Overseer::find(const std::string& part) const {
  std::string names;
  for (std::size_t i = 0; i < status_.size(); ++i) {
    if (status_[i].spec.name == part) return i;
    names += (names.empty() ? "" : ", ") + status_[i].spec.name;
  }
  return Error{Reason::bad_argument, "no component is named " + part + " (" + names + ")"};
}

Overseer::Verdict Overseer::look(const std::vector<Pulse>& pulses, Time now) {
  Verdict verdict;
  // A look that comes a little late is followed by one that comes early: on the whole each is worth a period.
  allowance_ = std::min(allowance_ + params_.period, 2 * params_.period);
  const Duration lived = looked_ ? std::min(now - *looked_, allowance_) : Duration{};
  allowance_ -= lived;
  looked_ = now;
  for (std::size_t i = 0; i < status_.size() && i < pulses.size() && !escalated_; ++i)
    watch(i, pulses[i], lived, now, verdict);
  return verdict;
}

void Overseer::watch(std::size_t part, const Pulse& pulse, Duration lived, Time now, Verdict& verdict) {
  PartStatus& status = status_[part];
  Course& course = courses_[part];
  switch (status.state) {
    case PartState::waiting:
      if (now >= course.resume) order(part, Order::Kind::restart, verdict);
      return;
    case PartState::failed:
    case PartState::hung:
      return;
    case PartState::starting:
    case PartState::up:
      break;
  }
  if (pulse.failed) return failed(part, pulse.text, now, verdict);
  const bool beats = pulse.running && (status.state == PartState::starting || pulse.beats != course.beats);
  course.beats = pulse.beats;
  const bool compared = !beats && pulse.use && course.use;
  const Duration counts = compared ? answerable(*course.use, *pulse.use, lived) : lived;
  course.use = beats ? std::nullopt : pulse.use;
  status.silent = beats ? Duration{} : status.silent + lived;
  status.stalled = beats ? Duration{} : status.stalled + counts;
  const Duration patience = status.state == PartState::starting ? params_.start : params_.silence;
  if (status.stalled > patience) return hung(part, verdict);
  if (!pulse.running || status.state == PartState::up) return;
  status.state = PartState::up;
  if (!course.was_down) return;
  course.was_down = false;
  ++status.restarts;
  verdict.events.push_back({PartEvent::Kind::back, part, "works again"});
}

void Overseer::failed(std::size_t part, const std::string& text, Time now, Verdict& verdict) {
  PartStatus& status = status_[part];
  Course& course = courses_[part];
  status.text = text;
  course.was_down = true;
  verdict.events.push_back({PartEvent::Kind::failed, part, text});
  if (status.spec.policy == RestartPolicy::by_operator) {
    status.state = PartState::failed;
    return;
  }
  while (!course.attempts.empty() && now - course.attempts.front() >= params_.window)
    course.attempts.pop_front();
  if (course.attempts.size() >= static_cast<std::size_t>(std::max(1, params_.attempts)))
    return escalate(part, "failed once more after " + std::to_string(course.attempts.size()) + " restarts",
                    verdict);
  Duration pause = params_.first_pause;
  for (std::size_t i = 0; i < course.attempts.size() && pause < params_.longest_pause; ++i) pause *= 4;
  course.attempts.push_back(now);
  course.resume = now + std::min(pause, params_.longest_pause);
  status.state = PartState::waiting;
}

void Overseer::hung(std::size_t part, Verdict& verdict) {
  PartStatus& status = status_[part];
  courses_[part].was_down = true;
  ++status.hangs;
  status.text = "does not return";
  verdict.events.push_back({PartEvent::Kind::hung, part, status.text});
  if (!status.spec.replaceable) return escalate(part, "hangs and cannot be replaced", verdict);
  if (++left_behind_ > params_.hangs) return escalate(part, "hangs, and so does another component", verdict);
  if (status.spec.policy == RestartPolicy::automatic) return order(part, Order::Kind::replace, verdict);
  status.state = PartState::hung;
  verdict.orders.push_back({Order::Kind::abandon, part});
}

void Overseer::order(std::size_t part, Order::Kind kind, Verdict& verdict) {
  status_[part].state = PartState::starting;
  status_[part].silent = status_[part].stalled = Duration{};
  courses_[part].use.reset();
  verdict.orders.push_back({kind, part});
}

void Overseer::escalate(std::size_t part, const std::string& why, Verdict& verdict) {
  escalated_ = true;
  if (status_[part].state != PartState::hung) status_[part].state = PartState::failed;
  verdict.orders.push_back({Order::Kind::escalate, part});
  verdict.events.push_back({PartEvent::Kind::escalated, part, status_[part].spec.name + " " + why});
}

Result<Overseer::Verdict> Overseer::restart(const std::string& part, Time) {
  const auto found = find(part);
  if (!found) return found.error();
  Verdict verdict;
  if (escalated_) return verdict;
  courses_[*found].attempts.clear();
  courses_[*found].was_down = true;
  const bool hangs = status_[*found].state == PartState::hung;
  // A part that does not return does not return sooner because it is restarted: its silence goes on counting.
  const PartStatus before = status_[*found];
  order(*found, hangs ? Order::Kind::replace : Order::Kind::restart, verdict);
  if (!hangs) {
    status_[*found].silent = before.silent;
    status_[*found].stalled = before.stalled;
  }
  return verdict;
}

Result<Overseer::Verdict> Overseer::set_policy(const std::string& part, RestartPolicy policy, Time now) {
  const auto found = find(part);
  if (!found) return found.error();
  PartStatus& status = status_[*found];
  if (status.spec.always && policy != RestartPolicy::automatic)
    return Error{Reason::not_supported, part + " takes the operators' word itself: it is restarted always"};
  status.spec.policy = policy;
  const bool down = status.state == PartState::failed || status.state == PartState::hung;
  if (policy == RestartPolicy::automatic && down) return restart(part, now);
  return Verdict{};
}

}  // namespace adit
