// SPDX-License-Identifier: Apache-2.0
#include "bench/alerts/alert_count.hpp"

#include <algorithm>

#include "basestation/model/text.hpp"
#include "core/command/words.hpp"

namespace adit::bench {

using station::Alert;

void AlertCount::count(const Alert& alert, double now) {
  if (alert.seen || unseen_since_.contains(alert.id)) return;
  unseen_since_[alert.id] = now;
  (alert.priority == station::Priority::act ? urgent_ : soon_) += 1;
  ++by_code_[alert.code];
  calls_.push_back(station::fixed(now, 1) + " s " + command::joined(alert.robots, "station") + " " +
                   alert.code + ": " + alert.text);
}

void AlertCount::look(const station::World& world, double now) {
  std::uint64_t newest = 0;
  for (const station::Notice& notice : world.notices) newest = std::max(newest, notice.id);
  if (newest < newest_notice_) newest_notice_ = 0;  // The station was started again.
  for (const station::Notice& notice : world.notices)
    if (notice.id > newest_notice_) queue_.add(notice, world, now);
  newest_notice_ = newest;
  queue_.update(world, now);
  std::set<std::uint64_t> alive;
  for (const Alert& alert : queue_.shown(now)) {
    alive.insert(alert.id);
    count(alert, now);
    if (!alert.seen && now - unseen_since_[alert.id] >= kHandled) {
      queue_.see(alert.id);
      unseen_since_.erase(alert.id);
    }
  }
  std::erase_if(unseen_since_, [&](const auto& entry) { return !alive.contains(entry.first); });
}

}  // namespace adit::bench
