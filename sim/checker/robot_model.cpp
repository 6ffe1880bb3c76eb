// SPDX-License-Identifier: Apache-2.0
#include "sim/checker/robot_model.hpp"

#include <algorithm>
#include <cmath>

namespace adit::sim {

void RobotModel::take_in(const Event& event) {
  std::visit([this](const auto& e) { take_in_event(e); }, event);
}

void RobotModel::take_in_event(const AgentStarted& e) {
  // A new process or a restarted component knows what is on its disk: what it then says is compared with
  // what was. It does not know whom it heard.
  RobotModel next(facts_);
  if (authority_.start != 0 || before_) next.before_ = authority_.start != 0 ? remember() : *before_;
  next.commands_ = std::move(commands_);
  std::erase_if(next.commands_, [](const auto& c) { return !c.second; });
  if (next.before_ && next.before_->disk_failed) next.commands_.clear();
  next.now_ = next.started_ = now_;
  next.died_ = died_;
  next.velocity_ = velocity_;
  next.velocity_at_ = velocity_at_;
  next.truth_ = truth_;
  next.jumps_ = std::move(jumps_);
  next.scanned_ = scanned_;
  next.programmed_ = programmed_;
  next.disk_full_ = disk_full_;
  next.disk_freed_ = disk_freed_;
  next.participant_ = e.participant;
  next.alive_ = true;
  // A component alone: who is heard is the radio's edge to know.
  if (alive_ && e.participant == participant_) next.participants_ = std::move(participants_);
  *this = std::move(next);
}

RobotModel::Before RobotModel::remember() const {
  return {authority_, latches_, behaviour_, unanswered(), lock_lapsed(), disk_failed()};
}

bool RobotModel::begins_again(const Event& event) const {
  if (!faulted_ || authority_.start == 0) return false;
  const auto* status = std::get_if<AuthoritySent>(&event);
  const auto* ack = std::get_if<AckSent>(&event);
  const std::uint64_t start = status ? status->authority.start : ack ? ack->start : 0;
  return start != 0 && start != authority_.start;
}

bool RobotModel::disk_failed() const { return disk_full_ || (disk_freed_ && now_ - *disk_freed_ < 2500ms); }

bool RobotModel::asked(const std::deque<Pending>& open, std::initializer_list<Verb> verbs) {
  return std::any_of(open.begin(), open.end(), [&](const Pending& p) {
    return std::find(verbs.begin(), verbs.end(), p.command.verb) != verbs.end();
  });
}

bool RobotModel::may_hold(const Authority& was, const std::deque<Pending>& open, const std::string& holder) {
  if (holder == was.holder) return true;
  return std::any_of(open.begin(), open.end(), [&](const Pending& p) {
    if (p.command.verb == Verb::take) return p.command.station == holder;
    if (p.command.verb == Verb::grant) return p.command.text == holder;
    return p.command.verb == Verb::release && holder.empty();
  });
}

bool RobotModel::ahead_of_answer(const AuthoritySent& status) const {
  if (pending_.empty() || authority_.start == 0 || !may_hold(authority_, pending_, status.authority.holder))
    return false;
  const Authority& now = status.authority;
  const bool other_holder = now.holder != authority_.holder || now.counter != authority_.counter;
  const bool other_lock = now.locked != authority_.locked;
  const bool other_stops =
      !std::is_permutation(latches_.begin(), latches_.end(), status.stops.begin(), status.stops.end());
  if (!other_holder && !other_lock && !other_stops) return false;
  if (other_holder && !asked(pending_, {Verb::take, Verb::release, Verb::grant})) return false;
  if (other_lock && !asked(pending_, {Verb::lock, Verb::unlock, Verb::take, Verb::release, Verb::grant}))
    return false;
  return !other_stops || asked(pending_, {Verb::stop, Verb::reset});
}

double RobotModel::holder_silence() const {
  const Heard* holder = heard(authority_.holder);
  return seconds(age(holder ? holder->last : started_));
}

bool RobotModel::lock_lapsed() const {
  return facts_.lock_lease > 0.0 && holder_silence() >= facts_.lock_lease - 0.05;
}

void RobotModel::take_in_event(const ComponentFaulted& e) {
  if (e.component == "command" && alive_) faulted_ = now_;
}

void RobotModel::take_in_event(const ProgramHeard& e) {
  const Twist2& v = e.velocity;
  if (std::isfinite(v.vx) && std::isfinite(v.vy) && std::isfinite(v.wz)) programmed_ = now_;
}

void RobotModel::take_in_event(const DiskChanged& e) {
  disk_full_ = e.full;
  if (!e.full) disk_freed_ = now_;
}

Duration RobotModel::age(Duration then) const {
  Duration out = now_ - then;
  for (const auto& [at, by] : jumps_)
    if (at >= then) out += by;
  return out;
}

void RobotModel::take_in_event(const AgentDied&) {
  alive_ = false;
  died_ = now_;
  faulted_.reset();
  unanswered_ = std::move(pending_);
  pending_.clear();
}

void RobotModel::hear(const std::string& station, const StationId& id, const wire::ParticipantId& from) {
  auto [it, fresh] = stations_.try_emplace(station, Heard{id, from, now_, {}});
  Heard& heard = it->second;
  // Another id may use the name only when the first was silent.
  if (!fresh && heard.id != id && age(heard.last) < kHearing) return;
  auto former = heard.former;
  if (!fresh && heard.id == id && heard.participant != from) former = {heard.participant, now_};
  heard = {id, from, now_, former};
}

void RobotModel::take_in_event(const PresenceHeard& e) {
  if (!alive_) return;
  participants_[e.from].insert({e.station, e.id});
  hear(e.station, e.id, e.from);
}

void RobotModel::take_in_event(const CommandHeard& e) {
  if (!alive_) return;
  const bool repeat = commands_.contains(key(e));
  commands_.try_emplace(key(e));
  pending_.push_back({e, now_, repeat});
  // The holder may have the command component restarted: it speaks under another epoch after that.
  const bool restarts = e.verb == Verb::restart && e.text == "command" && !repeat;
  if (restarts && is_holder(e) && current_epoch(e.start, e.counter)) faulted_ = now_;
  // A command is a sign of life of its station, but while the holder is heard as another participant it does
  // not show a new one to be his.
  const Heard* known = heard(e.station);
  const bool contested =
      known && known->participant != e.from && e.station == authority_.holder && age(known->last) < kHearing;
  if (!known || (known->id == e.id && !contested)) hear(e.station, e.id, e.from);
}

const RobotModel::Heard* RobotModel::heard(const std::string& station) const {
  const auto it = stations_.find(station);
  return it == stations_.end() ? nullptr : &it->second;
}

StationId RobotModel::id_of(const std::string& station) const {
  if (const Heard* known = heard(station)) return known->id;
  return station == restored_.holder ? restored_.holder_id : StationId{};
}

bool RobotModel::is_holder(const CommandHeard& command) const {
  if (authority_.holder.empty() || command.station != authority_.holder || command.id != authority_.holder_id)
    return false;
  const Heard* bound = heard(command.station);
  if (bound && bound->id == command.id) {
    if (bound->participant == command.from) return true;
    // A station that took the place during a silence keeps it briefly when the first is heard again: a
    // command may have been under way.
    if (bound->former && bound->former->first == command.from && age(bound->former->second) < kGivingBack)
      return true;
  }
  const auto it = participants_.find(command.from);
  return it != participants_.end() && it->second.contains({command.station, command.id});
}

const RobotModel::Pending* RobotModel::answered_by(const AckSent& ack) const {
  for (const Pending& p : pending_)
    if (p.command.station == ack.station && p.command.id == ack.id && p.command.seq == ack.seq) return &p;
  return nullptr;
}

const AckSent* RobotModel::first_answer(const CommandKey& key) const {
  const auto it = commands_.find(key);
  return it == commands_.end() || !it->second ? nullptr : &*it->second;
}

void RobotModel::take_in_event(const AckSent& e) {
  const Pending* found = answered_by(e);
  if (!found) return;
  const Pending pending = *found;
  pending_.erase(
      std::find_if(pending_.begin(), pending_.end(), [&](const Pending& p) { return &p == found; }));
  std::optional<AckSent>& first = commands_[key(pending.command)];
  if (first) return;
  first = e;
  if (e.accepted) apply(pending.command, e);
}

void RobotModel::apply(const CommandHeard& command, const AckSent& ack) {
  const std::string holder_before = authority_.holder;
  const StationId id_before = authority_.holder_id;
  switch (command.verb) {
    case Verb::take:
      if (command.station != authority_.holder || command.id != authority_.holder_id)
        authority_.locked = false;
      authority_.holder = command.station;
      authority_.holder_id = command.id;
      break;
    case Verb::release:
      authority_.holder.clear();
      authority_.holder_id = {};
      authority_.locked = false;
      break;
    case Verb::grant: {
      authority_.holder = command.text;
      authority_.holder_id = id_of(command.text);
      authority_.locked = false;
      break;
    }
    case Verb::lock:
      authority_.locked = true;
      break;
    case Verb::unlock:
      authority_.locked = false;
      break;
    case Verb::stop: {
      const Latch latch{command.station, command.id};
      if (std::find(latches_.begin(), latches_.end(), latch) == latches_.end()) latches_.push_back(latch);
      break;
    }
    case Verb::reset:
      if (command.flag)
        latches_.clear();
      else
        std::erase(latches_, Latch{command.station, command.id});
      break;
    default:
      break;
  }
  if (authority_.holder != holder_before || authority_.holder_id != id_before) holder_changed_ = now_;
  authority_.start = ack.start;
  authority_.counter = ack.counter;
}

void RobotModel::take_in_event(const AuthoritySent& e) {
  if (ahead_of_answer(e)) return;
  // Before the first answer, and when a lease ran out, the published state is all there is to know.
  if (authority_.start == 0) {
    latches_ = e.stops;
    restored_ = e.authority;
  }
  authority_ = e.authority;
}

void RobotModel::take_in_event(const BehaviourSent& e) {
  behaviour_ = e;
  if (e.mode == mode_) return;
  mode_before_ = mode_;
  mode_ = e.mode;
  mode_changed_ = now_;
}

void RobotModel::take_in_event(const StateSent& e) {
  stamps_.emplace_back(e.stamp, now_);
  while (stamps_.size() > 64) stamps_.pop_front();
}

void RobotModel::take_in_event(const VelocitySent& e) {
  velocity_ = e;
  velocity_at_ = now_;
}

std::string RobotModel::refusal(const JoystickHeard& sample) const {
  if (authority_.holder.empty()) return "nobody held the robot";
  const Heard* bound = heard(authority_.holder);
  const auto known = participants_.find(sample.from);
  const bool shown =
      known != participants_.end() && known->second.contains({authority_.holder, authority_.holder_id});
  if (sample.id != authority_.holder_id || !((bound && bound->participant == sample.from) || shown))
    return "it was not sent by the holder";
  if (!current_epoch(sample.start, sample.counter)) return "its epoch was not in force";
  const auto echoed =
      std::find_if(stamps_.begin(), stamps_.end(), [&](const auto& s) { return s.first == sample.echo; });
  if (echoed == stamps_.end()) return "it echoes no recent stamp of the robot";
  if (age(echoed->second) > kOldestEcho) return "its echo was older than 600 ms";
  return {};
}

void RobotModel::take_in_event(const JoystickHeard& e) {
  if (!alive_) return;
  const std::string why = refusal(e);
  if (!why.empty()) {
    if (!e.stick.zero()) forbidden_stick_ = {why, now_};
    return;
  }
  stick_ = Stick{e.stick, now_};
  if (!e.stick.zero()) pushed_stick_ = stick_;
}

}  // namespace adit::sim
