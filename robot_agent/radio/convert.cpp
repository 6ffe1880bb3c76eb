// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/radio/convert.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/wire/topics.hpp"
#include "robot_agent/common/clipped.hpp"

namespace adit::agent {
namespace {

// A message that is too large for its topic is not sent, and a refusal would be lost without notice. A
// complete acknowledgement stays below 512 bytes, a notification below 1 kB.
constexpr std::size_t kAnswerText = 200;
constexpr std::size_t kNoticeText = 500;
constexpr std::size_t kName = 32;
constexpr std::string_view kNameTaken = "name_taken:";

radio::Severity to_radio(Severity severity) {
  switch (severity) {
    case Severity::info:
      return radio::SEVERITY_INFO;
    case Severity::warning:
      return radio::SEVERITY_WARNING;
    case Severity::error:
      return radio::SEVERITY_ERROR;
  }
  return radio::SEVERITY_ERROR;
}

radio::GoalState to_radio(GoalState state) {
  switch (state) {
    case GoalState::none:
      return radio::GOAL_NONE;
    case GoalState::kept:
      return radio::GOAL_KEPT;
    case GoalState::active:
      return radio::GOAL_ACTIVE;
    case GoalState::blocked:
      return radio::GOAL_BLOCKED;
    case GoalState::reached:
      return radio::GOAL_REACHED;
  }
  return radio::GOAL_NONE;
}

/// Returns the name, or for a longer one 32 bytes that are no valid name: a plainly cut name could be another
/// station's.
std::string bounded_name(const std::string& name) { return clipped(name, kName); }

}  // namespace

Command from_radio(const radio::Command& in, const wire::ParticipantId& sender) {
  Command c{};
  c.robot = in.robot();
  c.from = {bounded_name(in.station()), in.station_id(), sender};
  c.epoch = from_radio(in.epoch());
  c.seq = in.seq();
  const auto number = static_cast<std::int32_t>(in.kind());
  auto request = command::unpack({number, in.words(), in.numbers(), in.options()});
  if (request) {
    c.request = std::move(*request);
    return c;
  }
  // An unknown command number does not end the conversion; neither do wrong arguments.
  c.invalid = request.error();
  if (const command::CommandInfo* row = command::find_number(number))
    c.request = command::Request(command::verb_of(*row));
  return c;
}

StickSample from_radio(const radio::Joystick& in, const wire::ParticipantId& sender) {
  return {in.robot(),
          in.station_id(),
          sender,
          from_radio(in.epoch()),
          in.seq(),
          in.echo(),
          {in.vx(), in.vy(), in.wz()}};
}

Peer from_radio(const radio::Capabilities& in, const wire::ParticipantId& sender) {
  Peer r{};
  r.name = bounded_name(in.name());
  r.id = in.id();
  r.station = in.kind() == radio::AGENT_STATION;
  r.participant = sender;
  r.protocol = in.protocol();
  r.software = in.software();
  r.platform = in.platform();
  r.length = in.length();
  r.width = in.width();
  r.height = in.height();
  r.max_speed = in.max_speed();
  r.modes = in.modes();
  const auto& services = in.services();
  r.carries_maps = !r.station &&
                   std::find(services.begin(), services.end(), wire::topics::kCarryService) != services.end();
  const Eigen::Vector3d place(in.place()[0], in.place()[1], in.place()[2]);
  if (r.station && in.placed() && place.allFinite()) r.place = place;
  return r;
}

std::string service_word(const Namesakes::Claim& claim) {
  char digits[17]{};
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(claim.start));
  return std::string(kNameTaken) + (claim.held ? "held:" : "free:") + digits;
}

std::optional<Namesakes::Claim> claim_of(const radio::Capabilities& in) {
  for (const std::string& word : in.services()) {
    if (!word.starts_with(kNameTaken)) continue;
    Namesakes::Claim claim;
    claim.held = word.substr(kNameTaken.size(), 5) == "held:";
    const std::size_t digits = kNameTaken.size() + 5;
    if (word.size() > digits)
      std::from_chars(word.data() + digits, word.data() + word.size(), claim.start, 16);
    return claim;
  }
  return std::nullopt;
}

radio::Acknowledgement to_radio(const Answer& answer, const std::string& robot) {
  radio::Acknowledgement out;
  out.robot(robot);
  out.station(clipped(answer.station, kName));
  out.station_id(answer.station_id);
  out.seq(answer.seq);
  out.accepted(answer.accepted());
  out.reason(static_cast<std::uint16_t>(answer.reason));
  out.text(clipped(answer.text, kAnswerText));
  out.holder(answer.holder);
  out.epoch(to_radio(answer.epoch));
  if (answer.route) out.route({to_radio(*answer.route)});
  return out;
}

radio::PlannedRoute to_radio(const PlannedRoute& route) {
  radio::PlannedRoute out;
  out.length(static_cast<float>(route.length));
  out.unknown_length(static_cast<float>(route.unknown_length));
  out.corners(static_cast<std::uint16_t>(std::min<std::size_t>(route.corners, UINT16_MAX)));
  for (const Eigen::Vector3d& corner : route.points) {
    if (out.points().size() == 3 * PlannedRoute::kMaxCorners) break;
    for (const double metres : {corner.x(), corner.y(), corner.z()})
      out.points().push_back(static_cast<float>(metres));
  }
  return out;
}

radio::Notification to_radio(const Notice& notice, const std::string& robot) {
  radio::Notification out;
  out.robot(robot);
  out.operator_name(notice.operator_name);
  out.severity(to_radio(notice.severity));
  out.code(notice.code);
  out.reason(static_cast<std::uint16_t>(notice.reason));
  out.text(clipped(notice.text, kNoticeText));
  return out;
}

radio::AuthorityStatus to_radio(const CommandInterface& commands, const std::string& robot, Time now) {
  const Authority& authority = commands.authority();
  radio::AuthorityStatus out;
  out.robot(robot);
  out.epoch(to_radio(authority.epoch()));
  if (authority.holder()) {
    out.holder(authority.holder()->name);
    out.holder_id(authority.holder()->id);
  }
  out.locked(authority.locked());
  out.lock_lease_left(static_cast<float>(authority.lease_left(now)));
  for (const Party& stopper : commands.stops().all()) {
    radio::Stopper latch;
    latch.station(stopper.name);
    latch.station_id(stopper.id);
    out.stops().push_back(latch);
  }
  return out;
}

static radio::Exploration to_radio(const ExplorationView& view) {
  radio::Exploration out;
  out.phase(static_cast<radio::ExplorationPhase>(view.state));
  out.reason(static_cast<std::uint16_t>(view.reason));
  out.volume(view.volume);
  out.share(view.share);
  out.open(view.open);
  out.unreachable(view.unreachable);
  return out;
}

static radio::Area to_radio(const nav::Area& area) {
  radio::Area out;
  out.name(area.name);
  out.kind(static_cast<radio::AreaKind>(area.kind));
  out.z_min(static_cast<float>(area.z_min));
  out.z_max(static_cast<float>(area.z_max));
  out.weight(static_cast<float>(area.weight));
  for (const Eigen::Vector2d& corner : area.corners)
    for (const double metres : {corner.x(), corner.y()}) out.corners().push_back(static_cast<float>(metres));
  return out;
}

radio::Route to_radio(const FollowedRoute& route, const std::string& robot) {
  constexpr double kDecimetres = 10.0;
  radio::Route out;
  out.robot(robot);
  out.goal_id(route.goal_id);
  out.unknown(route.unknown);
  out.corners(static_cast<std::uint16_t>(std::min<std::size_t>(route.corners, 65535)));
  if (route.points.empty()) return out;
  const Eigen::Vector3f from = route.points.front().cast<float>();
  out.from({from.x(), from.y(), from.z()});
  for (std::size_t i = 1; i < std::min(route.points.size(), FollowedRoute::kMaxCorners); ++i) {
    const Eigen::Vector3d offset = kDecimetres * (route.points[i] - from.cast<double>());
    if (!(offset.cwiseAbs().maxCoeff() < 32767.0)) break;
    for (const double length : {offset.x(), offset.y(), offset.z()})
      out.points().push_back(static_cast<std::int16_t>(std::lround(length)));
  }
  return out;
}

radio::BehaviourState to_radio(const BehaviourView& view, const std::vector<ModeOption>& options,
                               const std::string& robot) {
  radio::BehaviourState out;
  out.robot(robot);
  out.mode(std::string(view.mode));
  out.stopped(view.stopped);
  out.moving_allowed(view.moving_allowed);
  out.reason(static_cast<std::uint16_t>(view.reason));
  out.goal_state(to_radio(view.goal_state));
  out.goal_id(view.goal_id);
  out.goal({view.goal.x(), view.goal.y(), view.goal.z()});
  out.convoy(view.convoy);
  out.yields(view.yields);
  out.yields_to(view.yields_to);
  if (view.exploration.state != ExplorationState::none)
    out.exploration().push_back(to_radio(view.exploration));
  for (const nav::Area& area : view.areas.all()) out.areas().push_back(to_radio(area));
  for (const ModeOption& option : options) {
    radio::ModeOption mode;
    mode.mode(std::string(option.mode));
    mode.available(option.reason == Reason::none);
    mode.reason(static_cast<std::uint16_t>(option.reason));
    out.modes().push_back(mode);
  }
  return out;
}

radio::Capabilities to_radio(const Platform& platform, const std::string& robot, const Id& id,
                             std::uint16_t protocol, const ModeTable& modes) {
  radio::Capabilities out;
  out.name(robot);
  out.kind(radio::AGENT_ROBOT);
  out.id(id);
  out.protocol(protocol);
  out.software(ADIT_VERSION);
  out.platform(platform.name);
  out.holonomic(platform.sideways());
  out.length(static_cast<float>(platform.length));
  out.width(static_cast<float>(platform.width));
  out.height(static_cast<float>(platform.height));
  out.max_speed(static_cast<float>(platform.max_speed));
  out.max_turn(static_cast<float>(platform.max_turn));
  out.max_acceleration(static_cast<float>(platform.max_acceleration));
  out.step(static_cast<float>(platform.step));
  out.slope(static_cast<float>(std::atan(platform.max_slope)));
  out.stairs(platform.stairs);
  out.sensors({"lidar", "odometry", "battery"});
  if (platform.router != "none") out.services().push_back("route");
  for (const char* word : {"tilt", "map_revision"}) out.services().push_back(word);
  if (platform.turns_on_spot()) out.services().push_back("turn_on_spot");
  if (platform.stairs) out.services().push_back("stairs");
  if (platform.flies()) out.services().push_back("flight");
  for (const ModeRow& row : modes.rows()) out.modes().push_back(std::string(row.name));
  return out;
}

transfer::Ack from_radio(const radio::BulkAck& in, const std::string& robot) {
  transfer::Ack out{in.station_id(), in.start(), {}, {}};
  if (in.look().size() == 3) {
    const transfer::Look look{in.look()[0], in.look()[1], in.look()[2]};
    if (std::isfinite(look.x) && std::isfinite(look.y) && look.radius > 0.0F &&
        look.radius <= transfer::Look::kMaxRadius)
      out.look = look;
  }
  for (const radio::BulkReceipt& receipt : in.receipts()) {
    if (receipt.robot() == robot) out.receipt = {receipt.session(), receipt.newest(), receipt.received()};
    out.senders.push_back(receipt.robot());
  }
  out.carrier = in.carrier();
  out.all_digests = in.all_digests();
  for (const radio::BulkDigest& digest : in.digests())
    out.digests.push_back({digest.robot(), digest.parts()});
  return out;
}

}  // namespace adit::agent
