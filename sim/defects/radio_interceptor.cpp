// SPDX-License-Identifier: Apache-2.0
#include "sim/defects/radio_interceptor.hpp"

#include <string_view>

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "geometry_msgs/msg/TwistStamped.h"

namespace adit::sim {
namespace {

namespace topics = wire::topics;

bool is(const wire::TopicInfo& topic, const wire::TopicInfo& other) {
  return std::string_view(topic.name) == other.name && std::string_view(topic.type) == other.type;
}

/// Decodes, changes and encodes again. `change` returns false for a sample that is dropped.
template <class T, class Change>
bool edit(Cdr& cdr, const Change& change) {
  T sample;
  if (!wire::decode(cdr, sample)) return true;
  if (!change(sample)) return false;
  wire::encode(sample, cdr);
  return true;
}

Twist2 read(const geometry_msgs::msg::Twist& t) {
  return {t.linear().x(), t.linear().y(), t.angular().z(), t.linear().z()};
}

void write(const Twist2& velocity, geometry_msgs::msg::Twist& t) {
  t.linear().x(velocity.vx);
  t.linear().y(velocity.vy);
  t.linear().z(velocity.vz);
  t.angular().z(velocity.wz);
}

template <class T>
Arrival encoded(const wire::TopicInfo& topic, const From<T>& from) {
  Arrival out{&topic, {}, from.info, {}};
  wire::encode(from.sample, out.cdr);
  return out;
}

}  // namespace

void RadioInterceptor::on_command(const CommandFrom& command, std::vector<Arrival>& out) {
  out.push_back(arrival(command));
}

void RadioInterceptor::on_stick(const StickFrom& stick, std::vector<Arrival>& out) {
  out.push_back(arrival(stick));
}

void RadioInterceptor::on_other(Arrival arrival, std::vector<Arrival>& out) {
  out.push_back(std::move(arrival));
}

Arrival RadioInterceptor::arrival(const CommandFrom& command) { return encoded(topics::kCommand, command); }
Arrival RadioInterceptor::arrival(const StickFrom& stick) { return encoded(topics::kJoystick, stick); }

std::optional<wire::ParticipantId> RadioInterceptor::holders_participant() const {
  const auto found = participants_.find(authority_.holder_id());
  if (authority_.holder().empty() || found == participants_.end()) return std::nullopt;
  return found->second;
}

std::optional<Duration> RadioInterceptor::stick_age() const {
  if (!stick_at_) return std::nullopt;
  return now() - *stick_at_;
}

std::vector<Arrival> RadioInterceptor::received(Arrival arrival) {
  std::vector<Arrival> out;
  if (CommandFrom c{{}, arrival.info};
      is(*arrival.topic, topics::kCommand) && wire::decode(arrival.cdr, c.sample)) {
    participants_[c.sample.station_id()] = c.info.sender;
    on_command(c, out);
    return out;
  }
  if (StickFrom s{{}, arrival.info};
      is(*arrival.topic, topics::kJoystick) && wire::decode(arrival.cdr, s.sample)) {
    if (held_by(s.sample.station_id())) {
      stick_ = {s.sample.vx(), s.sample.vy(), s.sample.wz()};
      stick_at_ = now();
    }
    on_stick(s, out);
    return out;
  }
  on_other(std::move(arrival), out);
  return out;
}

bool RadioInterceptor::change(const wire::TopicInfo& topic, Cdr& cdr) {
  const auto velocity = [this](geometry_msgs::msg::Twist& twist) {
    Twist2 v = read(twist);
    on_velocity(v);
    stands_ = v.zero();
    if (!v.zero()) last_motion_ = v;
    write(v, twist);
    return true;
  };
  if (is(topic, topics::kCmdVel)) return edit<geometry_msgs::msg::Twist>(cdr, velocity);
  if (is(topic, topics::kCmdVelStamped))
    return edit<geometry_msgs::msg::TwistStamped>(cdr,
                                                  [&](auto& stamped) { return velocity(stamped.twist()); });
  if (is(topic, topics::kAcknowledgement))
    return edit<radio::Acknowledgement>(cdr, [this](auto& answer) { return on_answer(answer); });
  if (is(topic, topics::kAuthority))
    return edit<radio::AuthorityStatus>(cdr, [this](auto& status) {
      on_authority(status);
      authority_ = status;
      return true;
    });
  if (is(topic, topics::kBehaviour))
    return edit<radio::BehaviourState>(cdr, [this](auto& behaviour) {
      on_behaviour(behaviour);
      mode_ = behaviour.mode();
      return true;
    });
  if (is(topic, topics::kRobotState))
    return edit<radio::RobotState>(cdr, [this](auto& state) {
      on_state(state);
      stamp_ = state.stamp();
      return true;
    });
  return true;
}

std::vector<Cdr> RadioInterceptor::sent(const wire::TopicInfo& topic, Cdr cdr) {
  std::vector<Cdr> out;
  if (change(topic, cdr)) out.push_back(std::move(cdr));
  return out;
}

}  // namespace adit::sim
