#include "sim/checker/robot_model.hpp"

#include <algorithm>

namespace adit::sim {

void RobotModel::take_in(const Event& event) {
  std::visit([this](const auto& e) { take_in_event(e); }, event);
}

void RobotModel::take_in_event(const AgentStarted&) {
  // A new process remembers nothing: neither holder nor stops nor whom it heard.
  const RobotFacts facts = facts_;
  const Motion truth = truth_;
  const auto jumps = jumps_;
  const Duration now = now_, died = died_, velocity_at = velocity_at_;
  const std::optional<VelocitySent> velocity = velocity_;
  *this = RobotModel(facts);
  now_ = started_ = now;
  died_ = died;
  velocity_ = velocity;
  velocity_at_ = velocity_at;
  truth_ = truth;
  jumps_ = jumps;
  alive_ = true;
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
  pending_.clear();
}

void RobotModel::hear(const std::string& station, const StationId& id, const wire::ParticipantId& from) {
  auto [it, fresh] = stations_.try_emplace(station, Heard{id, from, now_});
  Heard& heard = it->second;
  // Another id may use the name only when the first was silent.
  if (!fresh && heard.id != id && age(heard.last) < hearing) return;
  heard = {id, from, now_};
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
  // A command is a sign of life of its station, but while the holder is heard as another participant it does
  // not show a new one to be his.
  const Heard* known = heard(e.station);
  const bool contested =
      known && known->participant != e.from && e.station == authority_.holder && age(known->last) < hearing;
  if (!known || (known->id == e.id && !contested)) hear(e.station, e.id, e.from);
}

const RobotModel::Heard* RobotModel::heard(const std::string& station) const {
  const auto it = stations_.find(station);
  return it == stations_.end() ? nullptr : &it->second;
}

bool RobotModel::is_holder(const CommandHeard& command) const {
  if (authority_.holder.empty() || command.station != authority_.holder || command.id != authority_.holder_id)
    return false;
  const Heard* bound = heard(command.station);
  if (bound && bound->id == command.id && bound->participant == command.from) return true;
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
      const Heard* next = heard(command.text);
      authority_.holder = command.text;
      authority_.holder_id = next ? next->id : StationId{};
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
  // Before the first answer, and when a lease ran out, the published state is all there is to know.
  authority_ = e.authority;
}

void RobotModel::take_in_event(const BehaviourSent& e) {
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
  if (age(echoed->second) > oldest_echo) return "its echo was older than 600 ms";
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
