// SPDX-License-Identifier: Apache-2.0
#include "basestation/fleet/fleet.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "adit/authority.h"
#include "adit/discovery.h"
#include "adit/link.h"
#include "adit/robot.h"
#include "core/command/vocabulary.hpp"
#include "core/command/words.hpp"
#include "core/contract/authority.hpp"
#include "core/contract/discovery.hpp"

namespace adit::station {

using contract::AgentKind;
using contract::Party;

namespace {

using namespace std::chrono_literals;

constexpr std::size_t kTextLimit = 240;
constexpr std::size_t kNameLimit = 32;
constexpr Duration kForgetAfter = 60s;
constexpr Duration kOldestNotice = 240h;  // Maximum age that a robot may claim.

/// Validates an amount in a sample; 0 for an invalid value.
float amount(float value) { return value >= 0.0F && value < 1e12F ? value : 0.0F; }
double number(float value) { return static_cast<double>(amount(value)); }

/// An area as a robot sent it; nothing if it is malformed.
std::optional<AreaView> view_of(const radio::Area& area) {
  constexpr std::array kKinds{"keep_in", "keep_out", "prefer"};
  const auto kind = static_cast<std::uint32_t>(area.kind());
  const bool whole = area.corners().size() >= 6 && area.corners().size() % 2 == 0;
  if (kind >= kKinds.size() || !whole || !command::valid_name(area.name())) return std::nullopt;
  if (std::isnan(area.z_min()) || std::isnan(area.z_max())) return std::nullopt;
  AreaView view{area.name(), kKinds[kind], {}, area.z_min(), area.z_max(), amount(area.weight())};
  for (std::size_t i = 0; i + 1 < area.corners().size(); i += 2) {
    const float x = area.corners()[i], y = area.corners()[i + 1];
    if (!std::isfinite(x) || !std::isfinite(y)) return std::nullopt;
    view.corners.push_back({x, y});
  }
  return view;
}

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
  for (const ComponentView& part : robot.components)
    if (!part.healthy) out.troubles.push_back(part.name + " " + word(part.phase));
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
  // A robot of such a name would make other commands of those that name it.
  const bool word = name == "all" || name.starts_with('-');
  if (!command::valid_name(name) || word || robots_.size() == kMaxRobots) {
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
      say({.level = Level::warning,
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
  RobotView* robot = touch(sample.robot(), info);
  if (!robot) return;
  robot->located = true;
  robot->last_heard = info.received;
  robot->stamp = sample.stamp();
  robot->stamped_by = info.sender;
  for (StoredNotice& waits : notices_)
    if (waits.undated && waits.robot == robot->name) date(waits, *robot);
  robot->x = sample.x();
  robot->y = sample.y();
  robot->z = sample.z();
  robot->yaw = sample.yaw();
  robot->vx = sample.vx();
  robot->vy = sample.vy();
  robot->wz = sample.wz();
  robot->battery = sample.battery();
  robot->roll = static_cast<float>(sample.tilt()[0]) * 1e-3F;
  robot->pitch = static_cast<float>(sample.tilt()[1]) * 1e-3F;
  robot->map_revision = sample.map_revision();
  robot->sigma = sample.sigma() * 1e-3;
  const auto lost = static_cast<std::uint8_t>(Localisation::lost);
  robot->localisation = static_cast<Localisation>(std::min(sample.localisation(), lost));
  if (!robot->lost) return;
  robot->lost = false;
  say({.robot = robot->name, .code = "back", .text = robot->name + " is heard again"}, info.received);
}

void Fleet::hear(const radio::Route& sample, const wire::SampleInfo& info) {
  RobotView* robot = touch(sample.robot(), info);
  if (!robot) return;
  constexpr float kDecimetre = 0.1F;  // m
  RouteView route{sample.goal_id(), {}, sample.unknown(), sample.corners()};
  const auto& from = sample.from();
  if (route.corners > 0) route.points.push_back(from);
  for (std::size_t i = 0;
       i + 2 < sample.points().size() && route.corners > 0 && route.points.size() < RouteView::kMaxCorners;
       i += 3)
    route.points.push_back({from[0] + kDecimetre * static_cast<float>(sample.points()[i]),
                            from[1] + kDecimetre * static_cast<float>(sample.points()[i + 1]),
                            from[2] + kDecimetre * static_cast<float>(sample.points()[i + 2])});
  const bool finite =
      std::all_of(from.begin(), from.end(), [](float metres) { return std::isfinite(metres); });
  robot->route = finite ? std::move(route) : RouteView{};
}

void Fleet::hear(const radio::AuthorityStatus& sample, const wire::SampleInfo& info) {
  const auto status = contract::decode(sample);
  if (!status) return (void)++ignored_;
  RobotView* robot = touch(status->robot, info);
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
  RobotView* robot = touch(sample.robot(), info);
  if (!robot) return;
  ++robot->behaviour_count;
  robot->mode = command::clean(sample.mode(), kNameLimit);
  robot->stopped = sample.stopped();
  robot->moving_allowed = sample.moving_allowed();
  robot->reason = static_cast<Reason>(sample.reason());
  const auto phase = static_cast<std::uint32_t>(sample.goal_state());
  robot->goal_phase = phase <= 4 ? static_cast<GoalPhase>(phase) : GoalPhase::none;
  robot->goal_id = sample.goal_id();
  robot->goal = {sample.goal()[0], sample.goal()[1], sample.goal()[2]};
  robot->yields = sample.yields();
  robot->yields_to = command::valid_name(sample.yields_to()) ? sample.yields_to() : std::string{};
  robot->convoy.clear();
  for (const std::string& member : sample.convoy())
    if (robot->convoy.size() < command::kMaxConvoy && command::valid_name(member))
      robot->convoy.push_back(member);
  robot->exploration = {};
  if (!sample.exploration().empty()) {
    const auto& e = sample.exploration().front();
    const auto explores = static_cast<std::uint32_t>(e.phase());
    robot->exploration = {explores <= 6 ? static_cast<ExplorationPhase>(explores) : ExplorationPhase::none,
                          static_cast<Reason>(e.reason()),
                          e.volume(),
                          e.share(),
                          e.open(),
                          e.unreachable()};
  }
  robot->areas.clear();
  for (const auto& area : sample.areas())
    if (auto view = view_of(area); view && robot->areas.size() < 16) robot->areas.push_back(std::move(*view));
  robot->choices.clear();
  for (const auto& option : sample.modes()) {
    if (robot->choices.size() == 16) break;
    robot->choices.push_back({command::clean(option.mode(), kNameLimit), option.available(),
                              static_cast<Reason>(option.reason())});
  }
}

void Fleet::hear(const radio::Notification& sample, const wire::SampleInfo& info) {
  const RobotView* robot = touch(sample.robot(), info);
  if (!robot) return;
  const auto severity = static_cast<std::uint32_t>(sample.severity());
  StoredNotice told{{.robot = sample.robot(),
                     .operator_name = command::clean(sample.operator_name(), kNameLimit),
                     .level = severity <= 2 ? static_cast<Level>(severity) : Level::error,
                     .code = command::clean(sample.code(), kNameLimit),
                     .reason = static_cast<Reason>(sample.reason()),
                     .text = command::clean(sample.text(), kTextLimit)},
                    info.received,
                    {},
                    info.sender};
  if (sample.stamp() != 0) told.undated = sample.stamp();
  date(told, *robot);
  notice(std::move(told));
}

/// Computes the time of a notice from the robot's clock only: its last stamp, and the time since then. A
/// notification that is repeated after a gap keeps its true age; the clock may differ after a restart of the
/// robot.
void Fleet::date(StoredNotice& notice, const RobotView& robot) const {
  if (!notice.undated || !robot.located || robot.stamped_by != notice.said_by) return;
  const Duration since_shown = notice.at - robot.last_heard;
  // Negative if the event is newer than the stamp. Clamped, because the robot's values are not trusted.
  const auto shown = std::clamp(Duration(static_cast<std::int64_t>(robot.stamp - *notice.undated)),
                                -kOldestNotice, kOldestNotice);
  notice.at -= std::clamp(shown + since_shown, Duration{}, kOldestNotice);
  notice.undated.reset();
}

void Fleet::hear(const radio::Health& sample, const wire::SampleInfo& info) {
  RobotView* robot = touch(sample.robot(), info);
  if (!robot) return;
  robot->components.clear();
  for (const auto& part : sample.components()) {
    if (robot->components.size() == 32) break;
    const auto phase = static_cast<std::uint32_t>(part.state());
    robot->components.push_back(
        {.name = command::clean(part.name(), kNameLimit),
         .phase = phase <= 4 ? static_cast<ComponentPhase>(phase) : ComponentPhase::failed,
         .healthy = part.healthy(),
         .automatic = part.automatic(),
         .silent_for = part.silent_for(),
         .restarts = part.restarts(),
         .hung = part.hung(),
         .text = command::clean(part.text(), kTextLimit)});
  }
}

void Fleet::hear(const radio::LinkReport& sample, const wire::SampleInfo& info) {
  if (!command::valid_name(sample.agent()) || sample.agent() == own_name_ ||
      (!traffic_.contains(sample.agent()) && traffic_.size() == kMaxRobots + kMaxStations)) {
    ++ignored_;
    return;
  }
  TrafficView view{.agent = sample.agent(),
                   .last_heard = info.received,
                   .discovery_out = sample.discovery_out(),
                   .discovery_in = sample.discovery_in(),
                   .total_out = sample.total_out(),
                   .total_in = sample.total_in(),
                   .malformed = sample.malformed()};
  view.sender.link = command::clean(sample.link(), 32);
  view.sender.bandwidth = number(sample.bandwidth());
  view.sender.queue = number(sample.queue());
  view.sender.state_rate = number(sample.state_rate());
  view.sender.dropped = sample.dropped();
  for (const auto& row : sample.topics()) {
    if (view.topics.size() == 16) break;
    view.topics.push_back({command::clean(row.topic(), 64), row.bytes_out(), row.samples_out(),
                           row.bytes_in(), row.samples_in(), row.dropped()});
  }
  for (const auto& peer : sample.peers()) {
    // False for NaN, too.
    if (command::valid_name(peer.peer()) && peer.lost() >= 0.0F && peer.lost() <= 1.0F)
      view.hears[peer.peer()] = peer.lost();
    if (peer.peer() != own_name_) continue;
    if (peer.held() >= 0.0F && peer.held() < 1e6F)  // Also false for NaN.
      links_.echoed(view.agent, peer.number(), from_seconds(peer.held()), info.received);
    if (peer.lost() >= 0.0F && peer.lost() <= 1.0F) view.lost_there = peer.lost();
  }
  traffic_[view.agent] = std::move(view);
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
    say({.robot = name,
         .level = Level::warning,
         .code = "lost",
         .text = name + " has not been heard for 2.5 s"},
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
