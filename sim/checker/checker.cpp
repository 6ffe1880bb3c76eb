// SPDX-License-Identifier: Apache-2.0
#include "sim/checker/checker.hpp"

#include <algorithm>

namespace adit::sim {
namespace {

constexpr std::uint64_t kMaxPerRule = 100;

// Within one instant the order on the wire says nothing about the order of thought.
int rank(const Event& event) {
  if (std::holds_alternative<Motion>(event)) return 3;
  if (std::holds_alternative<VelocitySent>(event)) return 2;
  if (std::holds_alternative<AuthoritySent>(event) || std::holds_alternative<BehaviourSent>(event) ||
      std::holds_alternative<NotificationSent>(event))
    return 1;
  return 0;
}

}  // namespace

struct Checker::WatchedRobot {
  explicit WatchedRobot(RobotFacts facts) : model(std::move(facts)) {
    rules[0] = make_one_holder_rule();
    rules[1] = make_lock_rule();
    rules[2] = make_acknowledge_rule();
    rules[3] = make_stop_rule();
    rules[4] = make_one_source_rule();
    rules[5] = make_stale_is_zero_rule();
    rules[6] = make_no_surprise_rule();
    rules[7] = make_peers_rule();
    rules[8] = make_nothing_lost_rule();
    rules[9] = make_areas_rule();
    rules[10] = make_honest_pose_rule();
  }
  RobotModel model;
  std::array<std::unique_ptr<Rule>, Checker::kNumbers.size()> rules{};  ///< Same order as kNumbers.
  Duration instant{};
  std::vector<Event> waiting{};
};

const char* Checker::title(int number) {
  static constexpr std::array titles{"one holder",           "locks",
                                     "no silent refusal",    "a stop needs no authority",
                                     "one source",           "stale means zero",
                                     "no unexpected motion", "peers need permission",
                                     "lost links",           "areas are hard limits",
                                     "honest poses"};
  return titles.at(static_cast<std::size_t>(number - 1));
}

Checker::Checker(std::vector<RobotFacts> robots) {
  for (RobotFacts& facts : robots) {
    const std::string robot = facts.name;
    robots_.emplace(robot, std::make_unique<WatchedRobot>(std::move(facts)));
  }
}

Checker::~Checker() = default;

void Checker::observe(const std::string& robot, Duration at, Event event) {
  const auto it = robots_.find(robot);
  if (it == robots_.end()) return;
  WatchedRobot& watch = *it->second;
  if (at > watch.instant) {
    dispatch(watch);
    watch.instant = at;
  }
  watch.waiting.push_back(std::move(event));
}

void Checker::advance(Duration now) {
  for (auto& [name, watch] : robots_) {
    if (watch->instant >= now) continue;
    dispatch(*watch);
    watch->instant = now;
    dispatch(*watch);
  }
}

void Checker::dispatch(WatchedRobot& watch) {
  // Of several states published in one instant the last is the one that holds after it.
  const auto is_status = [](const Event& e) { return std::holds_alternative<AuthoritySent>(e); };
  const auto last = std::find_if(watch.waiting.rbegin(), watch.waiting.rend(), is_status);
  if (last != watch.waiting.rend()) {
    const Event status = *last;
    std::erase_if(watch.waiting, is_status);
    // Published first: a restarted component is recognised by it.
    watch.waiting.insert(watch.waiting.begin(), status);
  }
  std::stable_sort(watch.waiting.begin(), watch.waiting.end(),
                   [](const Event& a, const Event& b) { return rank(a) < rank(b); });
  watch.model.set_now(watch.instant);
  for (const Event& event : watch.waiting) {
    // A failed command component that publishes under another start id was restarted.
    if (watch.model.begins_again(event)) judge(watch, AgentStarted{watch.model.participant()});
    judge(watch, event);
  }
  watch.waiting.clear();
  for (std::size_t i = 0; i < kNumbers.size(); ++i)
    watch.rules[i]->on_time(watch.model, violation_reporter(watch, kNumbers[i]));
}

void Checker::judge(WatchedRobot& watch, const Event& event) {
  for (std::size_t i = 0; i < kNumbers.size(); ++i)
    watch.rules[i]->on_event(watch.model, event, violation_reporter(watch, kNumbers[i]));
  watch.model.take_in(event);
}

ReportViolation Checker::violation_reporter(WatchedRobot& watch, int rule) {
  return [this, rule, &watch](std::string text) {
    if (++counts_[static_cast<std::size_t>(rule)] > kMaxPerRule) return;
    violations_.push_back({rule, watch.instant, watch.model.facts().name, std::move(text)});
  };
}

}  // namespace adit::sim
