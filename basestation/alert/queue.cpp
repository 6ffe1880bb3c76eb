// SPDX-License-Identifier: Apache-2.0
#include "basestation/alert/queue.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace adit::station {
namespace {

/// The priority of a notification in the state that the robot has.
Priority priority_of(const Notice& notice, const AlertRow* row, const Robot* robot) {
  if (!notice.mine) return Priority::log;
  // A code of a later version: its severity says how much it matters.
  if (!row) return notice.severity == Severity::info ? Priority::know : Priority::soon;
  if (row->priority == Priority::act && row->by_hand && (!robot || !is_by_hand(robot->mode)))
    return Priority::soon;
  return row->priority;
}

Priority priority_of(const Condition& condition, const Robot& robot) {
  const AlertRow* row = alert_row(condition.code);
  if (!row || (row->by_hand && !is_by_hand(robot.mode))) return Priority::soon;
  // Some reasons have the name of news; a robot that does not move because of them is more than that.
  return std::min(row->priority, Priority::soon);
}

/// The place of an alert among those of its priority: that of its row, or of a blocked robot if it has none.
std::size_t rank_of(const Alert& alert) {
  const AlertRow* row = alert_row(alert.code);
  if (!row) row = alert_row("blocked");
  return static_cast<std::size_t>(row - alert_table().data());
}

bool names(const Alert& alert, const std::string& robot) {
  return std::ranges::find(alert.robots, robot) != alert.robots.end();
}

}  // namespace

Alert* AlertQueue::find(const std::string& robot, const std::string& code) {
  for (Alert& alert : alerts_) {
    if (alert.code != code) continue;
    if (robot.empty() ? alert.robots.empty() : names(alert, robot)) return &alert;
  }
  return nullptr;
}

Alert* AlertQueue::find_from_state(const std::string& robot, Ends ends) {
  for (Alert& alert : alerts_)
    if (alert.from_state && alert.ends == ends && alert.robots.size() == 1 && names(alert, robot))
      return &alert;
  return nullptr;
}

bool AlertQueue::covers(const std::string& robot, const Condition& condition) const {
  return std::ranges::any_of(alerts_, [&](const Alert& alert) {
    return (alert.ends <= condition.ends || alert.code == condition.code) && names(alert, robot);
  });
}

bool AlertQueue::is_over(const Alert& alert, const Robot& robot, double now) const {
  if (alert.ends == Ends::seen) return false;
  // It is the concern of the operator who holds it now.
  if (!robot.mine && !robot.holder.empty()) return true;
  if (alert.ends == Ends::heard) return !robot.lost;
  // The state may be older than the notification.
  if (robot.lost || now - robot.age <= alert.last) return false;
  if (alert.ends == Ends::not_locked) return !robot.mine || !robot.locked;
  const auto found = conditions_.find({robot.name, alert.ends});
  // A condition that the state did not show yet may be in a message that was lost.
  if (found == conditions_.end()) return alert.confirmed || now - alert.last >= kEvidence;
  const bool other = alert.confirmed && *alert.confirmed != found->second.condition.reason;
  return other && !alert.from_state && now - found->second.code_since >= kSettles;
}

void AlertQueue::close(const std::string& robot, const std::string& closing, double now) {
  for (Alert& alert : alerts_) {
    const AlertRow* row = alert_row(alert.code);
    if (!row || row->closed_by != closing || std::erase(alert.robots, robot) == 0) continue;
    // The state may be older than this notification.
    if (const auto known = conditions_.find({robot, alert.ends}); known != conditions_.end())
      known->second.since = known->second.code_since = now;
  }
  std::erase_if(alerts_, [&](const Alert& alert) {
    const AlertRow* row = alert_row(alert.code);
    return row && row->closed_by == closing && alert.robots.empty();
  });
}

Priority AlertQueue::add(const Notice& notice, const World& world, double now) {
  if (notice.mine && !notice.code.empty()) close(notice.robot, notice.code, now);
  const AlertRow* row = alert_row(notice.code);
  const Priority priority = priority_of(notice, row, world.robot(notice.robot));
  if (priority > Priority::soon) return priority;
  const double at = now - std::max(notice.age, 0.0);
  if (Alert* known = find(notice.robot, notice.code)) {
    if (!known->from_state) ++known->count;
    renew(*known, notice, std::min(known->priority, priority), at);
    return priority;
  }
  if (Alert* covering =
          row && !row->part_of.empty() ? find(notice.robot, std::string(row->part_of)) : nullptr;
      covering && std::abs(at - covering->last) <= kTogether)
    return priority;
  const Ends ends = row ? row->ends : Ends::seen;
  // The state showed it first: it stays the same alert.
  if (Alert* shown = ends < Ends::seen ? find_from_state(notice.robot, ends) : nullptr) {
    renew(*shown, notice, priority, at);
    return priority;
  }
  insert({.priority = priority,
          .code = notice.code,
          .ends = ends,
          .robots = notice.robot.empty() ? std::vector<std::string>{} : std::vector{notice.robot},
          .text = notice.text,
          .reason = notice.reason,
          .first = at,
          .last = at});
  return priority;
}

void AlertQueue::renew(Alert& alert, const Notice& notice, Priority priority, double at) {
  alert.code = notice.code;
  alert.text = notice.text;
  alert.reason = notice.reason;
  alert.priority = priority;
  alert.last = std::max(alert.last, at);
  alert.from_state = false;
  alert.seen = false;
  alert.hidden_until = 0.0;
}

void AlertQueue::insert(Alert alert) {
  make_room();
  alert.id = next_++;
  alerts_.push_back(alert);
  if (alert.robots.empty()) return;
  absorb(alert);
  gather(alert);
}

void AlertQueue::take_conditions(const Robot& robot, const std::string& station, double now) {
  const std::vector<Condition> conditions = conditions_of(robot, station);
  for (const Condition& condition : conditions) {
    const Settling begins{condition, now, now};
    Settling& settling = conditions_.try_emplace({robot.name, condition.ends}, begins).first->second;
    if (settling.condition.code != condition.code) settling.code_since = now;
    settling.condition = condition;
    for (Alert& alert : alerts_)
      if (alert.ends == condition.ends && names(alert, robot.name) && !alert.confirmed)
        alert.confirmed = condition.reason;
    if (Alert* shown = find_from_state(robot.name, condition.ends)) {
      shown->code = condition.code;
      shown->text = condition.text;
      shown->reason = condition.reason;
      shown->priority = priority_of(condition, robot);
    }
  }
  std::erase_if(conditions_, [&](const auto& entry) {
    const auto& [name, ends] = entry.first;
    return name == robot.name && std::ranges::find(conditions, ends, &Condition::ends) == conditions.end();
  });
}

void AlertQueue::add_condition(const Robot& robot, const Settling& settling) {
  const Condition& condition = settling.condition;
  insert({.priority = priority_of(condition, robot),
          .code = condition.code,
          .ends = condition.ends,
          .from_state = true,
          .confirmed = condition.reason,
          .robots = {robot.name},
          .text = condition.text,
          .reason = condition.reason,
          .first = settling.since,
          .last = settling.since});
}

void AlertQueue::absorb(const Alert& newest) {
  const auto is_part = [&](const Alert& alert) {
    const AlertRow* row = alert_row(alert.code);
    return row && !row->part_of.empty() && row->part_of == newest.code;
  };
  for (Alert& alert : alerts_)
    if (is_part(alert) && newest.last - alert.last <= kTogether)
      std::erase(alert.robots, newest.robots.front());
  std::erase_if(alerts_, [&](const Alert& alert) { return is_part(alert) && alert.robots.empty(); });
}

/// Makes one alert of those with the newest one's code, if there are many at its time.
void AlertQueue::gather(const Alert& newest) {
  const auto alike = [&](const Alert& alert) {
    return alert.code == newest.code && !alert.robots.empty() && newest.last - alert.last <= kTogether;
  };
  std::size_t robots = 0;
  for (const Alert& alert : alerts_)
    if (alike(alert)) robots += alert.robots.size();
  if (robots < kManyRobots) return;
  Alert all{};
  for (const Alert& alert : alerts_) {
    if (!alike(alert)) continue;
    if (all.id == 0) {
      all = alert;
      continue;
    }
    all.robots.insert(all.robots.end(), alert.robots.begin(), alert.robots.end());
    all.priority = std::min(all.priority, alert.priority);
    all.count += alert.count;
    all.first = std::min(all.first, alert.first);
    all.last = std::max(all.last, alert.last);
    all.text = alert.text;
    all.seen = all.seen && alert.seen;
    all.hidden_until = 0.0;
  }
  std::erase_if(alerts_, alike);
  alerts_.push_back(std::move(all));
}

void AlertQueue::make_room() {
  if (alerts_.size() < kMaxAlerts) return;
  const auto least = std::ranges::max_element(
      alerts_, {}, [](const Alert& alert) { return std::tuple(alert.priority, -alert.last); });
  alerts_.erase(least);
}

void AlertQueue::update(const World& world, double now) {
  std::erase_if(conditions_, [&](const auto& entry) { return !world.robot(entry.first.first); });
  for (const Robot& robot : world.robots) take_conditions(robot, world.station, now);
  for (Alert& alert : alerts_)
    if (alert.ends != Ends::seen)
      std::erase_if(alert.robots, [&](const std::string& name) {
        const Robot* robot = world.robot(name);
        return robot && is_over(alert, *robot, now);
      });
  std::erase_if(alerts_, [](const Alert& alert) {
    return alert.ends == Ends::seen ? alert.seen : alert.robots.empty();
  });
  for (const auto& [key, settling] : conditions_) {
    const std::string& name = key.first;
    const Robot* robot = world.robot(name);
    const double settles = settling.condition.certain ? kSettles : kEvidence;
    if (robot->mine && now - settling.since >= settles && !covers(name, settling.condition))
      add_condition(*robot, settling);
  }
}

void AlertQueue::see(std::uint64_t id) {
  for (Alert& alert : alerts_)
    if (alert.id == id) alert.seen = true;
}

void AlertQueue::later(std::uint64_t id, double now) {
  for (Alert& alert : alerts_)
    if (alert.id == id) alert.hidden_until = now + kLater;
}

std::vector<Alert> AlertQueue::shown(double now) const {
  std::vector<Alert> out;
  for (const Alert& alert : alerts_)
    if (now >= alert.hidden_until) out.push_back(alert);
  std::ranges::stable_sort(
      out, {}, [](const Alert& alert) { return std::tuple(alert.priority, rank_of(alert), alert.first); });
  return out;
}

}  // namespace adit::station
