// SPDX-License-Identifier: Apache-2.0
#include "bench/alerts/alert_judge.hpp"

#include <algorithm>

#include "basestation/model/text.hpp"

namespace adit::bench {
namespace {

using sim::Loss;
using station::Alert;
using station::Ends;

std::optional<Loss> loss_of(const Alert& alert) {
  // Also of a robot in hold, which loses no motion by it.
  if (alert.code == "driver_lost") return std::nullopt;
  switch (alert.ends) {
    case Ends::heard:
      return Loss::contact;
    case Ends::stop_cleared:
      return Loss::stopped;
    case Ends::goes_on:
      return Loss::motion;
    default:
      return std::nullopt;
  }
}

bool shows(const std::vector<Alert>& alerts, const std::string& robot, Ends ends) {
  return std::ranges::any_of(alerts, [&](const Alert& alert) {
    return alert.ends <= ends && std::ranges::find(alert.robots, robot) != alert.robots.end();
  });
}

}  // namespace

void AlertJudge::complain(Duration now, const std::string& text) {
  complaints_.push_back(station::fixed(seconds(now), 1) + " s " + text);
}

void AlertJudge::judge(const Alert& alert, Duration now) {
  for (const std::string& robot : alert.robots) {
    if (!known_.emplace(alert.id, robot).second) continue;
    const auto loss = loss_of(alert);
    if (!loss) {
      ++figures_.other;
      continue;
    }
    ++figures_.judged;
    if (truth_.is_true(robot, *loss, now)) continue;
    ++figures_.wrong;
    complain(now, robot + " " + alert.code + ": false");
  }
}

void AlertJudge::look_for(const std::string& robot, Loss loss, const std::vector<Alert>& alerts,
                          Duration now) {
  constexpr Ends kEnds[]{Ends::heard, Ends::stop_cleared, Ends::goes_on};
  const auto lasts = truth_.lasts(robot, loss, now);
  if (!lasts) {
    episodes_.erase({robot, loss});
    return;
  }
  Episode& episode = episodes_[{robot, loss}];
  const Duration unseen = episode.shown ? std::min(*lasts, now - *episode.shown) : *lasts;
  if (shows(alerts, robot, kEnds[static_cast<std::size_t>(loss)])) {
    figures_.slowest = std::max(figures_.slowest, seconds(unseen));
    episode.shown = now;
  }
  if (*lasts < kMustShow) return;
  if (!std::exchange(episode.counted, true)) ++figures_.losses;
  if (unseen < kMustShow || episode.shown == now || std::exchange(episode.missed, true)) return;
  ++figures_.missed;
  complain(now, robot + " lost " + std::string(to_string(loss)) + " " + station::fixed(seconds(*lasts), 1) +
                    " s ago: missed");
}

void AlertJudge::look_for_stand(const std::string& robot, const std::vector<Alert>& alerts, Duration now) {
  const auto stands = truth_.stands_with_goal(robot, now);
  if (!stands || *stands < kSilentStand || shows(alerts, robot, Ends::seen)) {
    silent_.erase(robot);
    return;
  }
  if (!silent_.insert(robot).second) return;
  ++figures_.silent_stands;
  complain(now, robot + " stands with a goal, and no alert says so");
}

void AlertJudge::look(const station::AlertQueue& queue, const station::World& world, Duration now) {
  if (looked_ && now - *looked_ > 250ms) {
    truth_.station_restarted();
    episodes_.clear();
  }
  looked_ = now;
  const std::vector<Alert> alerts = queue.shown(seconds(now));
  for (const Alert& alert : alerts) judge(alert, now);
  std::erase_if(known_, [&](const auto& known) {
    return std::ranges::none_of(alerts, [&](const Alert& alert) { return alert.id == known.first; });
  });
  for (const station::Robot& robot : world.robots) {
    for (const Loss loss : {Loss::contact, Loss::stopped, Loss::motion})
      look_for(robot.name, loss, alerts, now);
    look_for_stand(robot.name, alerts, now);
  }
}

}  // namespace adit::bench
