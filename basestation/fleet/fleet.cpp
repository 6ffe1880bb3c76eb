// SPDX-License-Identifier: Apache-2.0
#include "basestation/fleet/fleet.hpp"

#include <algorithm>

#include "adit/authority.h"
#include "adit/discovery.h"
#include "adit/link.h"
#include "adit/robot.h"
#include "basestation/model/action.hpp"
#include "core/command/words.hpp"
#include "core/contract/authority.hpp"
#include "core/contract/discovery.hpp"

namespace adit::station {

using contract::AgentKind;
using contract::Party;

namespace {

using namespace std::chrono_literals;

constexpr Duration kForgetAfter = 60s;
constexpr Duration kOldestNotice = 240h;  // Maximum age that a robot may claim.

/// Sets what follows from the holder and the stops.
void set_owner(RobotView& robot, const std::string& own_name, const Id& own_id) {
  robot.mine = robot.holder == own_name && robot.holder_id == own_id;
  robot.stops.clear();
  robot.stopped_by_holder = false;
  const Party holder{robot.holder, robot.holder_id};
  for (const Party& latch : robot.latches) {
    robot.stops.push_back(latch.name);
    if (latch == holder) robot.stopped_by_holder = true;
  }
}

}  // namespace

Robot described(const RobotView& robot, Time now) {
  Robot out = robot;
  out.age = seconds(now - robot.last_heard);
  out.stopped = robot.stopped || !robot.latches.empty();
  for (const ComponentHealth& part : robot.components)
    if (!part.healthy) out.troubles.push_back(part.name + " " + word(part.state));
  // The station adds a centred stick to a mode that is driven by hand.
  for (ModeOption& option : out.options)
    if (can_enter(option)) option = {option.mode, true, Reason::none};
  return out;
}

Notice described(const StoredNotice& notice, Time now) {
  Notice out = notice;
  out.age = seconds(now - notice.at);
  return out;
}

RobotView* Fleet::touch(const std::string& name, const wire::SampleInfo& info) {
  const auto known = robots_.find(name);
  if (known != robots_.end()) {
    if (known->second.participant != info.sender) return touch_namesake(known->second, info);
    known->second.spoke = info.received;
    return &known->second;
  }
  if (!command::valid_robot_name(name) || robots_.size() == kMaxRobots) {
    ++ignored_;
    return nullptr;
  }
  RobotView& robot = robots_[name];
  robot.name = name;
  robot.participant = info.sender;
  robot.first_heard = robot.last_heard = robot.spoke = info.received;
  if (on_robot) on_robot(robot);
  return &robot;
}

template <class Message>
RobotView* Fleet::touch(const std::optional<Message>& message, const wire::SampleInfo& info) {
  if (message) return touch(message->robot, info);
  ++ignored_;
  return nullptr;
}

void Fleet::hear(const radio::Capabilities& sample, const wire::SampleInfo& info) {
  const auto said = contract::decode(sample);
  if (!said) return (void)++ignored_;
  if (said->kind == AgentKind::station) {
    hear(contract::Presence{said->name, said->kind, said->id, said->protocol}, info);
    const auto station = stations_.find(said->name);
    if (station != stations_.end()) station->second.place = said->place;
    return;
  }
  RobotView* robot = touch(said->name, info);
  if (!robot) return;
  robot->described = true;
  robot->platform = said->platform;
  robot->software = said->software;
  robot->protocol = said->protocol;
  robot->max_speed = said->max_speed;
  robot->max_turn = said->max_turn;
  robot->max_acceleration = said->max_acceleration;
  robot->holonomic = said->holonomic;
  robot->size = {said->length, said->width, said->height};
  robot->max_step = said->max_step;
  robot->max_slope = said->max_slope;
  robot->climbs_stairs = said->stairs;
  robot->modes = said->modes;
  robot->sensors = said->sensors;
  robot->services = said->services;
}

void Fleet::hear(const radio::Presence& sample, const wire::SampleInfo& info) {
  const auto presence = contract::decode(sample);
  if (!presence) return (void)++ignored_;
  hear(*presence, info);
}

void Fleet::hear(const contract::Presence& presence, const wire::SampleInfo& info) {
  if (presence.name != own_name_ && speaks_for(presence.name, info.sender))
    links_.heard(presence.name, presence.seq, info.received);
  if (presence.kind == AgentKind::robot) {
    // RobotState has more content, but on a full link it is as rare as this.
    const auto robot = robots_.find(presence.name);
    if (robot != robots_.end() && robot->second.participant == info.sender)
      robot->second.last_sign = robot->second.spoke = info.received;
    return;
  }
  if (presence.name == own_name_ && presence.id != own_id_) {
    // Robots will refuse one of the two stations: its operator must choose another name.
    if (!clashed_ || info.received - last_clash_ > kForgetAfter)
      say({.severity = Severity::warning,
           .code = "name_in_use",
           .reason = Reason::name_in_use,
           .text = "another station on the air calls itself " + own_name_ + "; choose another --name"},
          info.received);
    clashed_ = true;
    last_clash_ = info.received;
    return;
  }
  if (presence.name == own_name_) return;
  if (!stations_.contains(presence.name) && stations_.size() == kMaxStations) return (void)++ignored_;
  StationView& station = stations_[presence.name];
  if (station.id != presence.id) station.place.reset();  // Another station has that name.
  station.name = presence.name;
  station.id = presence.id;
  station.participant = info.sender;
  station.last_heard = info.received;
}

void Fleet::hear(const radio::RobotState& sample, const wire::SampleInfo& info) {
  auto state = contract::decode(sample);
  RobotView* robot = touch(state, info);
  if (!robot) return;
  static_cast<contract::RobotState&>(*robot) = std::move(*state);
  robot->located = true;
  robot->last_heard = info.received;
  robot->stamped_by = info.sender;
  for (StoredNotice& waits : notices_)
    if (waits.robot == robot->name) date(waits, *robot);
  if (!robot->lost) return;
  robot->lost = false;
  say({.code = "back", .text = robot->name + " is heard again", .robot = robot->name}, info.received);
}

void Fleet::hear(const radio::Route& sample, const wire::SampleInfo& info) {
  auto route = contract::decode(sample);
  if (RobotView* robot = touch(route, info)) robot->route = std::move(*route);
}

void Fleet::hear(const radio::AuthorityStatus& sample, const wire::SampleInfo& info) {
  const auto status = contract::decode(sample);
  RobotView* robot = touch(status, info);
  if (!robot) return;
  // An acknowledgement can be newer than a status that arrives later.
  if (robot->owned && robot->epoch.start == status->epoch.start &&
      status->epoch.counter < robot->epoch.counter)
    return;
  robot->owned = true;
  robot->epoch = status->epoch;
  const Party holder = status->holder.value_or(Party{});
  robot->holder = holder.name;
  robot->holder_id = holder.id;
  robot->locked = status->locked;
  robot->lease_left = status->lease_left;
  robot->latches = status->stops;
  set_owner(*robot, own_name_, own_id_);
}

void Fleet::hear(const radio::BehaviourState& sample, const wire::SampleInfo& info) {
  auto state = contract::decode(sample);
  RobotView* robot = touch(state, info);
  if (!robot) return;
  static_cast<contract::BehaviourState&>(*robot) = std::move(*state);
  ++robot->behaviour_count;
}

void Fleet::hear(const radio::Notification& sample, const wire::SampleInfo& info) {
  auto said = contract::decode(sample);
  const RobotView* robot = touch(said, info);
  if (!robot) return;
  StoredNotice stored{{std::move(*said)}, info.received, info.sender};
  date(stored, *robot);
  notice(std::move(stored));
}

/// Computes the time of a notice from the robot's clock only: its last stamp, and the time since then. A
/// notification that is repeated after a gap keeps its true age; the clock may differ after a restart of the
/// robot.
void Fleet::date(StoredNotice& notice, const RobotView& robot) const {
  if (notice.stamp == 0 || !robot.located || robot.stamped_by != notice.said_by) return;
  const Duration since_shown = notice.at - robot.last_heard;
  // Negative if the event is newer than the stamp. Clamped, because the robot's values are not trusted.
  const auto shown = std::clamp(Duration(static_cast<std::int64_t>(robot.stamp - notice.stamp)),
                                -kOldestNotice, kOldestNotice);
  notice.at -= std::clamp(shown + since_shown, Duration{}, kOldestNotice);
  notice.stamp = 0;
}

void Fleet::hear(const radio::Health& sample, const wire::SampleInfo& info) {
  auto health = contract::decode(sample);
  if (RobotView* robot = touch(health, info)) robot->components = std::move(health->components);
}

void Fleet::hear(const radio::LinkReport& sample, const wire::SampleInfo& info) {
  auto report = contract::decode(sample);
  if (!report || report->agent == own_name_ ||
      (!traffic_.contains(report->agent) && traffic_.size() == kMaxRobots + kMaxStations)) {
    ++ignored_;
    return;
  }
  for (const contract::PeerLink& peer : report->peers)
    if (peer.peer == own_name_)
      links_.echoed(report->agent, peer.number, from_seconds(peer.held), info.received);
  TrafficView& view = traffic_[report->agent];
  view = {std::move(*report), info.received};
}

void Fleet::learn_authority(const std::string& robot, const std::string& holder, const Epoch& epoch) {
  const auto known = robots_.find(robot);
  if (known == robots_.end()) return;
  RobotView& view = known->second;
  if (view.owned && view.epoch.start == epoch.start && epoch.counter < view.epoch.counter) return;
  const bool changed = !view.owned || view.epoch != epoch || view.holder != holder;
  view.owned = true;
  view.epoch = epoch;
  if (!changed) return;
  view.holder = holder;
  // The acknowledgement has only the holder's name; the next status has its id.
  view.holder_id = holder == own_name_ ? own_id_ : Id{};
  view.locked = false;  // Every change of holder ends a lock.
  view.lease_left = -1.0F;
  set_owner(view, own_name_, own_id_);
}

void Fleet::own_traffic(TrafficView traffic) { traffic_[own_name_] = std::move(traffic); }

void Fleet::check(Time now) {
  for (auto& [name, robot] : robots_) {
    if (robot.lost || now - std::max(robot.last_heard, robot.last_sign) <= kLostAfter) continue;
    robot.lost = true;
    say({.severity = Severity::warning,
         .code = "lost",
         .text = name + " has not been heard for 2.5 s",
         .robot = name},
        now);
  }
  const auto silent = [now](const auto& entry) { return now - entry.second.last_heard > kForgetAfter; };
  std::erase_if(stations_, silent);
  std::erase_if(traffic_, silent);
  std::erase_if(namesakes_,
                [now](const auto& entry) { return now - entry.second.view.spoke > kForgetAfter; });
}

const RobotView* Fleet::robot(const std::string& name) const {
  const auto found = robots_.find(name);
  return found == robots_.end() ? nullptr : &found->second;
}

std::vector<std::string> Fleet::robot_names() const {
  std::vector<std::string> names;
  for (const auto& [name, robot] : robots_) names.push_back(name);
  return names;
}

void Fleet::notice(StoredNotice notice) {
  notice.id = ++last_notice_;
  notice.mine = notice.operator_name.empty() || notice.operator_name == own_name_;
  if (notices_.size() == kMaxNotices) notices_.pop_front();
  notices_.push_back(notice);
  if (on_notice) on_notice(notices_.back());
}

}  // namespace adit::station
