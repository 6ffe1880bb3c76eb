// SPDX-License-Identifier: Apache-2.0
#include "sim/checker/radio_decoder.hpp"

#include <cmath>
#include <limits>

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/robot.h"
#include "adit/team.h"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "geometry_msgs/msg/TwistStamped.h"
#include "nav_msgs/msg/Odometry.h"

namespace adit::sim {
namespace {

namespace topics = wire::topics;

bool is(std::string_view topic, const wire::TopicInfo& other) { return topic == other.name; }

Verb verb_of(radio::CommandKind kind) {
  switch (kind) {
    case radio::CMD_TAKE:
      return Verb::take;
    case radio::CMD_RELEASE:
      return Verb::release;
    case radio::CMD_LOCK:
      return Verb::lock;
    case radio::CMD_UNLOCK:
      return Verb::unlock;
    case radio::CMD_GRANT:
      return Verb::grant;
    case radio::CMD_STOP:
      return Verb::stop;
    case radio::CMD_RESET:
      return Verb::reset;
    case radio::CMD_MODE:
    case radio::CMD_EXPLORE:
      return Verb::mode;
    case radio::CMD_GOTO:
    case radio::CMD_HOME:
      return Verb::go_to;
    case radio::CMD_QUERY:
      return Verb::query;
    case radio::CMD_RESTART:
      return Verb::restart;
    case radio::CMD_POLICY:
      return Verb::policy;
    case radio::CMD_PLAN:
      return Verb::plan;
    case radio::CMD_POSE:
      return Verb::pose;
    case radio::CMD_JOIN:
      return Verb::join;
    case radio::CMD_PEELOFF:
      return Verb::peeloff;
    case radio::CMD_YIELD:
      return Verb::yield;
    case radio::CMD_AREA_ADD:
      return Verb::area_add;
    case radio::CMD_AREA_REMOVE:
      return Verb::area_remove;
  }
  return Verb::unknown;
}

template <class T>
std::optional<T> read(std::span<const std::uint8_t> cdr) {
  T sample;
  if (!wire::decode(cdr, sample)) return std::nullopt;
  return sample;
}

using Decoded = std::optional<DecodedSample>;

Decoded command(std::span<const std::uint8_t> cdr, const wire::ParticipantId& from) {
  const auto c = read<radio::Command>(cdr);
  if (!c) return std::nullopt;
  CommandHeard heard{from,
                     c->station(),
                     c->station_id(),
                     c->epoch().start(),
                     c->epoch().counter(),
                     c->seq(),
                     verb_of(c->kind()),
                     c->words().empty() ? std::string{} : c->words().front(),
                     c->options() != 0 || (c->words().size() == 2 && c->words().back() == "auto"),
                     {}};
  heard.words = c->words();
  heard.numbers = c->numbers();
  heard.options = c->options();
  if (c->kind() == radio::CMD_EXPLORE) heard.text = "explore";
  if (c->numbers().size() >= 2) heard.position = {c->numbers()[0], c->numbers()[1]};
  return DecodedSample{c->robot(), std::move(heard)};
}

Decoded joystick(std::span<const std::uint8_t> cdr, const wire::ParticipantId& from) {
  const auto j = read<radio::Joystick>(cdr);
  if (!j) return std::nullopt;
  return DecodedSample{j->robot(), JoystickHeard{from,
                                                 j->station_id(),
                                                 j->epoch().start(),
                                                 j->epoch().counter(),
                                                 j->seq(),
                                                 j->echo(),
                                                 {j->vx(), j->vy(), j->wz()}}};
}

Decoded station(std::span<const std::uint8_t> cdr, const wire::ParticipantId& from, bool presence) {
  if (presence) {
    const auto p = read<radio::Presence>(cdr);
    if (!p || p->kind() != radio::AGENT_STATION) return std::nullopt;
    return DecodedSample{{}, PresenceHeard{from, p->name(), p->id()}};
  }
  const auto c = read<radio::Capabilities>(cdr);
  if (!c || c->kind() != radio::AGENT_STATION) return std::nullopt;
  return DecodedSample{{}, PresenceHeard{from, c->name(), c->id()}};
}

Decoded acknowledgement(std::span<const std::uint8_t> cdr) {
  const auto a = read<radio::Acknowledgement>(cdr);
  if (!a) return std::nullopt;
  return DecodedSample{a->robot(), AckSent{a->station(), a->station_id(), a->seq(), a->accepted(),
                                           static_cast<Reason>(a->reason()), a->text(), a->holder(),
                                           a->epoch().start(), a->epoch().counter()}};
}

VelocitySent as_velocity(const geometry_msgs::msg::Twist& t) {
  return {{t.linear().x(), t.linear().y(), t.angular().z(), t.linear().z()}};
}

Decoded velocity(std::string_view type, std::span<const std::uint8_t> cdr) {
  std::optional<geometry_msgs::msg::Twist> t;
  if (type == topics::kCmdVelStamped.type) {
    if (const auto stamped = read<geometry_msgs::msg::TwistStamped>(cdr)) t = stamped->twist();
  } else {
    t = read<geometry_msgs::msg::Twist>(cdr);
  }
  if (!t) return std::nullopt;
  return DecodedSample{{}, as_velocity(*t)};
}

Decoded authority(std::span<const std::uint8_t> cdr) {
  const auto a = read<radio::AuthorityStatus>(cdr);
  if (!a) return std::nullopt;
  AuthoritySent sent{{a->epoch().start(), a->epoch().counter(), a->holder(), a->holder_id(), a->locked()},
                     {}};
  for (const auto& stop : a->stops()) sent.stops.push_back({stop.station(), stop.station_id()});
  return DecodedSample{a->robot(), sent};
}

}  // namespace

Decoded decode_received(std::string_view topic, std::span<const std::uint8_t> cdr,
                        const wire::ParticipantId& from) {
  if (is(topic, topics::kCommand)) return command(cdr, from);
  if (is(topic, topics::kJoystick)) return joystick(cdr, from);
  if (is(topic, topics::kPresence)) return station(cdr, from, true);
  if (is(topic, topics::kCapabilities)) return station(cdr, from, false);
  if (is(topic, topics::kTeam)) {
    const auto b = read<radio::TeamBeacon>(cdr);
    if (!b) return std::nullopt;
    return DecodedSample{
        {}, BeaconHeard{b->robot(), b->ask().empty() ? std::vector<std::string>{} : b->ask().front().to()}};
  }
  if (is(topic, topics::kPoints)) return DecodedSample{{}, ScanHeard{}};
  if (is(topic, topics::kOdom)) {
    const auto o = read<nav_msgs::msg::Odometry>(cdr);
    if (!o) return std::nullopt;
    const auto& p = o->pose().pose().position();
    const auto& q = o->pose().pose().orientation();
    const double yaw =
        std::atan2(2 * (q.w() * q.z() + q.x() * q.y()), 1 - 2 * (q.y() * q.y() + q.z() * q.z()));
    return DecodedSample{{}, OdometryHeard{{p.x(), p.y(), yaw}}};
  }
  if (is(topic, topics::kExternalCmdVel)) {
    const auto t = read<geometry_msgs::msg::Twist>(cdr);
    if (!t) return std::nullopt;
    return DecodedSample{{}, ProgramHeard{as_velocity(*t).velocity}};
  }
  return std::nullopt;
}

Decoded decode_sent(std::string_view topic, std::string_view type, std::span<const std::uint8_t> cdr) {
  if (is(topic, topics::kCmdVel)) return velocity(type, cdr);
  if (is(topic, topics::kRobotState)) {
    const auto s = read<radio::RobotState>(cdr);
    if (!s) return std::nullopt;
    constexpr std::uint16_t kNoSigma = 65535;
    const double sigma = s->sigma() == kNoSigma ? std::numeric_limits<double>::infinity()
                                                : 1e-3 * static_cast<double>(s->sigma());
    // A number that this program does not know promises nothing.
    const auto localisation = s->localisation() > static_cast<std::uint8_t>(Localisation::lost)
                                  ? Localisation::lost
                                  : static_cast<Localisation>(s->localisation());
    return DecodedSample{s->robot(), StateSent{s->stamp(), Pose3::level({s->x(), s->y(), s->yaw()}, s->z()),
                                               sigma, localisation}};
  }
  if (is(topic, topics::kAcknowledgement)) return acknowledgement(cdr);
  if (is(topic, topics::kAuthority)) return authority(cdr);
  if (is(topic, topics::kBehaviour)) {
    const auto b = read<radio::BehaviourState>(cdr);
    if (!b) return std::nullopt;
    return DecodedSample{
        b->robot(),
        BehaviourSent{
            .mode = b->mode(),
            .stopped = b->stopped(),
            .has_goal = b->goal_state() != radio::GOAL_NONE,
            .drives_to_goal = b->goal_state() == radio::GOAL_ACTIVE || b->goal_state() == radio::GOAL_BLOCKED,
            .goal_id = b->goal_id(),
            .reason = static_cast<Reason>(b->reason()),
            .convoy = b->convoy(),
            .exploration =
                b->exploration().empty() ? 0 : static_cast<int>(b->exploration().front().phase())}};
  }
  if (is(topic, topics::kNotification)) {
    const auto n = read<radio::Notification>(cdr);
    if (!n) return std::nullopt;
    return DecodedSample{n->robot(), NotificationSent{n->code(), n->operator_name(), n->seq(),
                                                      static_cast<Reason>(n->reason())}};
  }
  return std::nullopt;
}

}  // namespace adit::sim
