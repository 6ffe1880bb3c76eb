#include "robot_agent/state/snapshot.hpp"

#include <algorithm>
#include <cmath>

#include "core/store/pack.hpp"

namespace adit::agent {
namespace {

using store::Packer;
using store::Unpacker;

constexpr std::size_t kName = 32;

void put(Packer& out, const Party& party) { out.text(party.name).put(party.id); }
void put(Packer& out, const std::optional<Binding::Kept>& speaker) {
  out.flag(speaker.has_value());
  if (!speaker) return;
  out.put(speaker->participant);
  for (const auto& other : {speaker->former, speaker->rival}) {
    out.flag(other.has_value());
    if (other) out.put(*other);
  }
}
std::optional<Binding::Kept> speaker(Unpacker& in) {
  if (!in.flag()) return std::nullopt;
  Binding::Kept kept{};
  kept.participant = in.array<12>();
  if (in.flag()) kept.former = in.array<12>();
  if (in.flag()) kept.rival = in.array<12>();
  return kept;
}

Party party(Unpacker& in) {
  Party p{};
  p.name = in.text(kName);
  p.id = in.array<16>();
  return p;
}

void put(Packer& out, const KeptAnswers& from) {
  out.put(from.participant).text(from.station).put(from.station_id);
  out.put(from.newest).put(from.floor);
  for (const std::uint64_t newest : from.newest_of) out.put(newest);
  const std::size_t count = std::min(from.answers.size(), Snapshot::kAnswers);
  out.put(static_cast<std::uint16_t>(count));
  for (std::size_t i = from.answers.size() - count; i < from.answers.size(); ++i) {
    const KeptAnswer& a = from.answers[i];
    out.put(a.seq).put(static_cast<std::uint16_t>(a.reason)).text(a.text.substr(0, Snapshot::kText));
  }
}
KeptAnswers answers(Unpacker& in) {
  KeptAnswers from{};
  from.participant = in.array<12>();
  from.station = in.text(kName);
  from.station_id = in.array<16>();
  from.newest = in.get<std::uint64_t>();
  from.floor = in.get<std::uint64_t>();
  for (std::uint64_t& newest : from.newest_of) newest = in.get<std::uint64_t>();
  for (std::size_t left = in.count(Snapshot::kAnswers); left > 0; --left) {
    KeptAnswer a{};
    a.seq = in.get<std::uint64_t>();
    a.reason = static_cast<Reason>(in.get<std::uint16_t>());
    a.text = in.text(Snapshot::kText);
    from.answers.push_back(std::move(a));
  }
  return from;
}

bool sane(const KeptAnswers& from) {
  return std::all_of(from.answers.begin(), from.answers.end(),
                     [&](const KeptAnswer& a) { return a.seq != 0 && a.seq <= from.newest; });
}

bool sane(const Snapshot& s) {
  if (s.authority.holder && !valid_name(s.authority.holder->name)) return false;
  if ((s.authority.locked || s.authority.speaker) && !s.authority.holder) return false;
  for (const Party& stopper : s.authority.stops)
    if (!valid_name(stopper.name)) return false;
  if (!std::all_of(s.answers.begin(), s.answers.end(), [](const KeptAnswers& a) { return sane(a); }))
    return false;
  return s.behaviour.goal.allFinite() && s.battery <= 3;
}

}  // namespace

store::Bytes encode(const Snapshot& s) {
  Packer out;
  out.put(s.authority.epoch.start).put(s.authority.epoch.counter).flag(s.authority.holder.has_value());
  if (s.authority.holder) put(out, *s.authority.holder);
  put(out, s.authority.speaker);
  out.flag(s.authority.locked);
  const std::size_t stops = std::min(s.authority.stops.size(), Snapshot::kStops);
  out.put(static_cast<std::uint16_t>(stops));
  for (std::size_t i = 0; i < stops; ++i) put(out, s.authority.stops[i]);

  const KeptBehaviour& b = s.behaviour;
  out.text(b.mode.substr(0, kName)).put(static_cast<std::uint16_t>(b.reason));
  out.flag(b.goal_known).flag(b.goal_reached).put(b.goal_id);
  for (const double value : {b.goal.x(), b.goal.y(), b.goal.z()}) out.put(value);
  out.flag(b.goal_on_floor);
  out.put(s.boot).put(s.battery);

  const std::size_t participants = std::min(s.answers.size(), Snapshot::kParticipants);
  out.put(static_cast<std::uint16_t>(participants));
  for (std::size_t i = 0; i < participants; ++i) put(out, s.answers[i]);
  return out.bytes();
}

std::optional<Snapshot> decode_snapshot(std::span<const std::uint8_t> bytes) {
  Unpacker in(bytes);
  Snapshot s{};
  s.authority.epoch.start = in.get<std::uint64_t>();
  s.authority.epoch.counter = in.get<std::uint32_t>();
  if (in.flag()) s.authority.holder = party(in);
  s.authority.speaker = speaker(in);
  s.authority.locked = in.flag();
  for (std::size_t left = in.count(Snapshot::kStops); left > 0; --left)
    s.authority.stops.push_back(party(in));

  KeptBehaviour& b = s.behaviour;
  b.mode = in.text(kName);
  b.reason = static_cast<Reason>(in.get<std::uint16_t>());
  b.goal_known = in.flag();
  b.goal_reached = in.flag();
  b.goal_id = in.get<std::uint32_t>();
  for (int axis = 0; axis < 3; ++axis) b.goal[axis] = in.number();
  b.goal_on_floor = in.flag();
  s.boot = in.get<std::uint64_t>();
  s.battery = in.get<std::uint8_t>();

  for (std::size_t left = in.count(Snapshot::kParticipants); left > 0; --left)
    s.answers.push_back(answers(in));
  if (!in.done() || !sane(s)) return std::nullopt;
  return s;
}

}  // namespace adit::agent
