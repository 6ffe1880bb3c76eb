// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/state/snapshot_fields.hpp"

#include <algorithm>
#include <cmath>

#include "robot_agent/command/stop_latches.hpp"

namespace adit::agent::fields {
namespace {

using store::Packer;
using store::Unpacker;

void put(Packer& out, const Party& party) { out.text(party.name).put(party.id); }

Party party(Unpacker& in) {
  Party p{};
  p.name = in.text(kName);
  p.id = in.array<16>();
  return p;
}

void put(Packer& out, const std::optional<Binding::Stored>& speaker) {
  out.flag(speaker.has_value());
  if (!speaker) return;
  out.put(speaker->participant);
  for (const auto& other : {speaker->previous, speaker->rejected}) {
    out.flag(other.has_value());
    if (other) out.put(*other);
  }
}

std::optional<Binding::Stored> speaker(Unpacker& in) {
  if (!in.flag()) return std::nullopt;
  Binding::Stored stored{};
  stored.participant = in.array<12>();
  if (in.flag()) stored.previous = in.array<12>();
  if (in.flag()) stored.rejected = in.array<12>();
  return stored;
}

bool is_sigma(double value) { return std::isfinite(value) && value >= 0.0; }

}  // namespace

void put(Packer& out, const StoredAuthority& authority) {
  out.put(authority.epoch.start).put(authority.epoch.counter).flag(authority.holder.has_value());
  if (authority.holder) put(out, *authority.holder);
  put(out, authority.speaker);
  out.flag(authority.locked);
}

StoredAuthority authority(Unpacker& in) {
  StoredAuthority a{};
  a.epoch.start = in.get<std::uint64_t>();
  a.epoch.counter = in.get<std::uint32_t>();
  if (in.flag()) a.holder = party(in);
  a.speaker = speaker(in);
  a.locked = in.flag();
  return a;
}

StoredAuthority sanitized(StoredAuthority a) {
  if (a.holder && !valid_name(a.holder->name)) a.holder.reset();
  if (!a.holder) a.speaker.reset();
  if (!a.holder) a.locked = false;
  a.stops.clear();
  return a;
}

void put(Packer& out, const std::vector<Party>& stops) {
  out.put(static_cast<std::uint16_t>(stops.size()));
  for (const Party& stopper : stops) put(out, stopper);
}

std::vector<Party> stops(Unpacker& in) {
  std::vector<Party> all;
  for (std::size_t left = in.count(Snapshot::kStops); left > 0; --left) all.push_back(party(in));
  return all;
}

// A stop is never lost: one whose name cannot be written becomes a stop that only an override clears.
std::vector<Party> sanitized(std::vector<Party> stops) {
  const Party others{StopLatches::kOthers, Id{}};
  for (Party& stopper : stops)
    if (!valid_name(stopper.name)) stopper = others;
  if (stops.size() > Snapshot::kStops) {
    stops.resize(Snapshot::kStops);
    stops.back() = others;
  }
  return stops;
}

void put(Packer& out, const StoredBehaviour& b) {
  out.text(b.mode).put(static_cast<std::uint16_t>(b.reason));
  out.flag(b.goal_known).flag(b.goal_reached).put(b.goal_id);
  for (const double value : {b.goal.x(), b.goal.y(), b.goal.z()}) out.put(value);
  out.flag(b.goal_on_floor);
}

StoredBehaviour behaviour(Unpacker& in) {
  StoredBehaviour b{};
  b.mode = in.text(kName);
  b.reason = static_cast<Reason>(in.get<std::uint16_t>());
  b.goal_known = in.flag();
  b.goal_reached = in.flag();
  b.goal_id = in.get<std::uint32_t>();
  for (int axis = 0; axis < 3; ++axis) b.goal[axis] = in.number();
  b.goal_on_floor = in.flag();
  return b;
}

StoredBehaviour sanitized(StoredBehaviour b) {
  if (!valid_name(b.mode)) b.mode = "hold";
  if (!b.goal.allFinite()) {
    b.goal.setZero();
    b.goal_known = b.goal_reached = b.goal_on_floor = false;
  }
  b.areas = b.areas.only([](const nav::Area& area) {
    const auto valid = nav::checked(area);
    return valid && *valid == area;
  });
  // A module's state that does not fit, or is its second one, is left out: the module starts without it.
  std::vector<StoredMode> modes;
  for (StoredMode& m : b.modes) {
    const bool twice = std::any_of(modes.begin(), modes.end(),
                                   [&](const StoredMode& other) { return other.mode == m.mode; });
    if (valid_name(m.mode) && m.bytes.size() <= Snapshot::kModeBytes && !twice) modes.push_back(std::move(m));
  }
  b.modes = std::move(modes);
  if (b.modes.size() > Snapshot::kModes) b.modes.resize(Snapshot::kModes);
  return b;
}

void put(Packer& out, const Pose3& pose) {
  const Eigen::Vector3d& p = pose.position;
  const Eigen::Quaterniond& q = pose.orientation;
  for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) out.put(value);
}

void get(Unpacker& in, Pose3& pose) {
  for (double& value : pose.position) value = in.number();
  auto& q = pose.orientation;
  for (double* value : {&q.w(), &q.x(), &q.y(), &q.z()}) *value = in.number();
}

void put(Packer& out, const StoredFrames& place) {
  for (const double value : {place.T_map_odom.x, place.T_map_odom.y, place.T_map_odom.yaw}) out.put(value);
  out.put(place.odom_epoch).flag(place.newest.has_value());
  if (place.newest) {
    put(out, place.newest->T_odom_base);
    out.put(place.newest->stamp).put(to_stamp(place.newest->received));
  }
  out.flag(place.height.has_value());
  if (place.height) out.put(*place.height);
  out.put(place.map_epoch);
  put(out, place.T_odom_driver);
  out.flag(place.recognised);
}

StoredFrames place(Unpacker& in) {
  StoredFrames stored{};
  for (double* value : {&stored.T_map_odom.x, &stored.T_map_odom.y, &stored.T_map_odom.yaw})
    *value = in.number();
  stored.odom_epoch = in.get<std::uint32_t>();
  if (in.flag()) {
    OdometrySample& newest = stored.newest.emplace();
    get(in, newest.T_odom_base);
    newest.stamp = in.get<std::uint64_t>();
    newest.received = from_stamp(in.get<std::uint64_t>());
  }
  if (in.flag()) stored.height = in.number();
  stored.map_epoch = in.get<std::uint32_t>();
  get(in, stored.T_odom_driver);
  stored.recognised = in.flag();
  return stored;
}

void put_sigma(Packer& out, const StoredFrames& place) {
  out.put(place.pose_sigma.value_or(0.0)).put(place.yaw_sigma);
}

bool read_sigma(Unpacker& in, StoredFrames& place) {
  const double pose_sigma = in.number(), yaw_sigma = in.number();
  if (!in.done() || !is_sigma(pose_sigma) || !is_sigma(yaw_sigma)) return false;
  place.pose_sigma = pose_sigma;
  place.yaw_sigma = yaw_sigma;
  return true;
}

// An invalid place counts as missing odometry: no mode resumes by itself.
StoredFrames sanitized(StoredFrames place) {
  const Pose2& frame = place.T_map_odom;
  if (!std::isfinite(frame.x) || !std::isfinite(frame.y) || !std::isfinite(frame.yaw)) return {};
  if (place.height && !std::isfinite(*place.height)) return {};
  const auto is_pose = [](const Pose3& pose) {
    return pose.position.allFinite() && std::fabs(pose.orientation.norm() - 1.0) < 1e-6;
  };
  if (!is_pose(place.T_odom_driver)) {
    // Without the correction the poses are of another frame.
    place.T_odom_driver = {};
    place.newest.reset();
  }
  if (place.newest && !is_pose(place.newest->T_odom_base)) place.newest.reset();
  if (place.pose_sigma && (!is_sigma(*place.pose_sigma) || !is_sigma(place.yaw_sigma)))
    place.pose_sigma.reset();
  if (!place.pose_sigma) place.yaw_sigma = 0.0;
  return place;
}

void put(Packer& out, const nav::Area& area) {
  out.text(area.name).put(static_cast<std::uint8_t>(area.kind));
  for (const double value : {area.z_min, area.z_max, area.weight}) out.put(value);
  out.put(static_cast<std::uint16_t>(area.corners.size()));
  for (const Eigen::Vector2d& corner : area.corners) out.put(corner.x()).put(corner.y());
}

nav::Area area(Unpacker& in) {
  nav::Area a{};
  a.name = in.text(kName);
  a.kind = static_cast<nav::AreaKind>(in.get<std::uint8_t>());
  for (double* value : {&a.z_min, &a.z_max, &a.weight}) *value = in.number();
  for (std::size_t left = in.count(nav::Area::kMaxCorners); left > 0; --left) {
    const double x = in.number();
    a.corners.emplace_back(x, in.number());
  }
  return a;
}

void put(Packer& out, const StoredMode& mode) {
  out.text(mode.mode).put(static_cast<std::uint16_t>(mode.bytes.size())).raw(mode.bytes);
}

StoredMode mode(Unpacker& in) {
  StoredMode m{};
  m.mode = in.text(kName);
  m.bytes.resize(in.count(Snapshot::kModeBytes));
  for (std::uint8_t& byte : m.bytes) byte = in.get<std::uint8_t>();
  return m;
}

StoredMode sanitized(StoredMode m) {
  if (!valid_name(m.mode)) m.mode = "hold";
  m.bytes.resize(std::min(m.bytes.size(), Snapshot::kModeBytes));
  return m;
}

void put(Packer& out, const StoredAnswers& from) {
  out.put(from.participant).text(from.station).put(from.station_id);
  out.put(from.newest).put(from.floor);
  for (const std::uint64_t newest : from.newest_of) out.put(newest);
  out.put(static_cast<std::uint16_t>(from.answers.size()));
  for (const StoredAnswer& a : from.answers)
    out.put(a.seq).put(static_cast<std::uint16_t>(a.reason)).text(a.text);
}

StoredAnswers answers(Unpacker& in) {
  StoredAnswers from{};
  from.participant = in.array<12>();
  from.station = in.text(kName);
  from.station_id = in.array<16>();
  from.newest = in.get<std::uint64_t>();
  from.floor = in.get<std::uint64_t>();
  for (std::uint64_t& newest : from.newest_of) newest = in.get<std::uint64_t>();
  for (std::size_t left = in.count(StoredAnswers::kAnswers); left > 0; --left) {
    StoredAnswer a{};
    a.seq = in.get<std::uint64_t>();
    a.reason = static_cast<Reason>(in.get<std::uint16_t>());
    a.text = in.text(StoredAnswer::kText);
    from.answers.push_back(std::move(a));
  }
  return from;
}

// An omitted answer counts as too old: its command is refused and not executed again.
StoredAnswers sanitized(StoredAnswers from) {
  if (!valid_name(from.station)) from.station.clear();
  const auto invalid = [&](const StoredAnswer& a) { return a.seq == 0 || a.seq > from.newest; };
  std::erase_if(from.answers, invalid);
  if (from.answers.size() > StoredAnswers::kAnswers) {
    from.answers.erase(from.answers.begin(), from.answers.end() - StoredAnswers::kAnswers);
    const auto before = [](const StoredAnswer& a, const StoredAnswer& b) { return a.seq < b.seq; };
    from.floor =
        std::max(from.floor, std::min_element(from.answers.begin(), from.answers.end(), before)->seq);
  }
  for (StoredAnswer& a : from.answers) a.text.resize(std::min(a.text.size(), StoredAnswer::kText));
  return from;
}

std::uint8_t sanitized_battery(std::uint8_t level) { return std::min<std::uint8_t>(level, 4); }

}  // namespace adit::agent::fields
