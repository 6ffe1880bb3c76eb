// SPDX-License-Identifier: Apache-2.0
// Selects which of several robots with one name is shown and commanded. The robots decide who gives way
// (robot_agent/discovery/namesakes.hpp); a station follows them.
#include "basestation/fleet/fleet.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;

// RobotState has 10 Hz: after this silence another participant may be a restart.
constexpr Duration kQuiet = 250ms;
constexpr Duration kGrace = 1s;       // Samples of an agent that ended may arrive this late.
constexpr Duration kSilent = 3s;      // After this silence a rejected participant may get the name.
constexpr Duration kForgotten = 60s;  // After this silence a robot that gives way may get the name.

bool gives_way(const RobotView& robot) { return contract::claim_of(robot.services).has_value(); }

}  // namespace

bool Fleet::replaces(const Namesake& namesake, const RobotView& shown, Time now) {
  const Duration since = now - shown.spoke;
  if (gives_way(namesake.view) != gives_way(shown)) return gives_way(shown) || since >= kForgotten;
  // A displaced participant that is heard again is alive, so the new one was no restart.
  if (namesake.displaced) return now - *namesake.displaced >= kGrace;
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
      // The robot's state stays until its new participant sends another one.
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
