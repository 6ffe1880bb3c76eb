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

bool over(const Robot& robot, Ends ends) {
  // It is the concern of the operator who holds it now.
  if (ends != Ends::seen && !robot.mine && !robot.holder.empty()) return true;
  switch (ends) {
    case Ends::seen:
      return false;
    case Ends::heard:
      return !robot.lost;
    case Ends::stop_cleared:
      return !robot.stopped;
    case Ends::goes_on:
      return robot.reason == Reason::none && robot.goal_state != GoalState::blocked;
    case Ends::busy:
      return !robot.mine || robot.goal_state == GoalState::active || is_by_hand(robot.mode) ||
             robot.exploration.phase == ExplorationPhase::exploring;
    case Ends::not_asked:
      return !robot.mine || !robot.locked;
    case Ends::healthy:
      return robot.troubles.empty();
    case Ends::by_hand:
      return !is_by_hand(robot.mode);
  }
  return false;
}

}  // namespace

Alert* AlertQueue::find(const std::string& robot, const std::string& code) {
  for (Alert& alert : alerts_) {
    if (alert.code != code) continue;
    if (robot.empty() ? alert.robots.empty() : std::ranges::count(alert.robots, robot) > 0) return &alert;
  }
  return nullptr;
}

void AlertQueue::close(const std::string& robot, const std::string& closing) {
  for (Alert& alert : alerts_) {
    const AlertRow* row = alert_row(alert.code);
    if (row && row->closed_by == closing) std::erase(alert.robots, robot);
  }
  std::erase_if(alerts_, [&](const Alert& alert) {
    const AlertRow* row = alert_row(alert.code);
    return row && row->closed_by == closing && alert.robots.empty();
  });
}

Priority AlertQueue::add(const Notice& notice, const World& world, double now) {
  if (notice.mine && !notice.code.empty()) close(notice.robot, notice.code);
  const AlertRow* row = alert_row(notice.code);
  const Priority priority = priority_of(notice, row, world.robot(notice.robot));
  if (priority > Priority::soon) return priority;
  const double at = now - std::max(notice.age, 0.0);
  if (Alert* known = find(notice.robot, notice.code)) {
    ++known->count;
    known->last = std::max(known->last, at);
    known->text = notice.text;
    known->reason = notice.reason;
    known->seen = false;
    known->hidden_until = 0.0;
    known->priority = std::min(known->priority, priority);
    return priority;
  }
  if (Alert* covering =
          row && !row->part_of.empty() ? find(notice.robot, std::string(row->part_of)) : nullptr;
      covering && std::abs(at - covering->last) <= kTogether)
    return priority;
  make_room();
  Alert alert{next_++, priority, notice.code, {}, notice.text, notice.reason, 1, at, at, false, 0.0};
  if (!notice.robot.empty()) alert.robots.push_back(notice.robot);
  alerts_.push_back(alert);
  if (notice.robot.empty()) return priority;
  absorb(alert);
  gather(alert);
  return priority;
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
  for (Alert& alert : alerts_) {
    const AlertRow* row = alert_row(alert.code);
    if (!row || row->ends == Ends::seen) continue;
    // The state of the robot may be older than the notification.
    std::erase_if(alert.robots, [&](const std::string& name) {
      const Robot* robot = world.robot(name);
      const bool newer = robot && (row->ends == Ends::heard || now - robot->age > alert.last);
      return newer && over(*robot, row->ends);
    });
  }
  std::erase_if(alerts_, [&](const Alert& alert) {
    const AlertRow* row = alert_row(alert.code);
    const bool stays = !row || row->ends == Ends::seen;
    return stays ? alert.seen : alert.robots.empty();
  });
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
  std::ranges::stable_sort(out, {},
                           [](const Alert& alert) { return std::tuple(alert.priority, alert.first); });
  return out;
}

bool AlertQueue::concerns(const std::string& robot) const {
  return std::ranges::any_of(alerts_,
                             [&](const Alert& alert) { return std::ranges::count(alert.robots, robot) > 0; });
}

}  // namespace adit::station
