// Several robots with one name: which of them is shown and commanded. The robots decide who gives way
// (robot_agent/discovery/namesakes.hpp); a station follows them.
#include <algorithm>

#include "basestation/fleet/fleet.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;

constexpr Duration kQuiet =
    250ms;                        // RobotStates come ten times a second: another participant may be a restart
constexpr Duration kGrace = 1s;   // samples of an agent that ended may come so late
constexpr Duration kSilent = 3s;  // then a participant that was found out may speak for the name
constexpr Duration kForgotten = 60s;  // then one that gives way may

bool gives_way(const RobotView& robot) {
  return std::any_of(robot.services.begin(), robot.services.end(),
                     [](const std::string& word) { return word.starts_with("name_taken"); });
}

}  // namespace

bool Fleet::replaces(const Namesake& namesake, const RobotView& shown, Time now) {
  const Duration since = now - shown.spoke;
  if (gives_way(namesake.view) != gives_way(shown)) return gives_way(shown) || since >= kForgotten;
  if (namesake.displaced)
    return now - *namesake.displaced >= kGrace;  // it lives, the newcomer was no restart
  return since >= (namesake.rival ? kSilent : kQuiet);
}

RobotView* Fleet::touch_namesake(RobotView& shown, const wire::SampleInfo& info) {
  const std::string name = shown.name;
  const auto known = namesakes_.find({name, info.sender});
  if (known == namesakes_.end()) {
    if (namesakes_.size() == kMaxNamesakes) {
      ++ignored_;
      return nullptr;
    }
    Namesake fresh;
    if (replaces(fresh, shown, info.received)) {
      // What is known of the robot stays until its new participant says something else.
      namesakes_[{name, shown.participant}] = {shown, info.received, false};
      shown.participant = info.sender;
      shown.spoke = info.received;
      return &shown;
    }
    fresh.view.name = name;
    fresh.view.participant = info.sender;
    fresh.view.first_heard = fresh.view.last_heard = fresh.view.spoke = info.received;
    return &(namesakes_[{name, info.sender}] = std::move(fresh)).view;
  }
  known->second.view.spoke = info.received;
  if (!replaces(known->second, shown, info.received)) return &known->second.view;
  const bool back = known->second.displaced.has_value();
  Namesake former{std::move(shown), back ? std::nullopt : std::optional(info.received), back};
  shown = std::move(known->second.view);
  namesakes_.erase(known);
  const wire::ParticipantId gone = former.view.participant;
  namesakes_[{name, gone}] = std::move(former);
  return &shown;
}

bool Fleet::speaks_for(const std::string& robot, const wire::ParticipantId& participant) const {
  const auto known = robots_.find(robot);
  return known == robots_.end() || known->second.participant == participant ||
         !namesakes_.contains({robot, participant});
}

}  // namespace adit::station
