// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/state/snapshot.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "core/store/sections.hpp"
#include "robot_agent/command/stop_latches.hpp"
#include "robot_agent/state/snapshot_fields.hpp"

namespace adit::agent {
namespace {

using store::Packer;
using store::Section;
using store::Unpacker;

/// One kind of section. A further entry of the state is a further row: its tag, two functions, and a line in
/// sanitized().
struct Row {
  store::SectionTag tag;
  std::uint16_t version;  ///< Rises when the layout of the payload changes; only this layout is read.
  const char* name;       ///< As operators read it in `state_damaged`.
  bool always;            ///< Every state has this section: if it is missing, it was lost.
  /// Calls `add` with each payload; most rows have one.
  void (*write)(const Snapshot& snapshot, const std::function<void(const Packer&)>& add);
  /// Reads one payload into the snapshot. Returns false and leaves the snapshot unchanged if the payload is
  /// invalid.
  bool (*read)(Unpacker& in, Snapshot& snapshot);
};

/// Reads a value. Returns nothing if bytes are missing or left over, or if encode() would write the value
/// differently.
template <class T>
std::optional<T> checked(const Unpacker& in, T value) {
  if (!in.done() || fields::sanitized(value) != value) return std::nullopt;
  return value;
}

template <class T>
void add_one(const std::function<void(const Packer&)>& add, const T& value) {
  Packer out;
  fields::put(out, value);
  add(out);
}

bool read_authority(Unpacker& in, Snapshot& s) {
  auto value = checked(in, fields::authority(in));
  if (!value) return false;
  value->stops = std::move(s.authority.stops);
  s.authority = std::move(*value);
  return true;
}

bool read_stops(Unpacker& in, Snapshot& s) {
  auto value = checked(in, fields::stops(in));
  if (!value) return false;
  s.authority.stops = std::move(*value);
  return true;
}

bool read_behaviour(Unpacker& in, Snapshot& s) {
  auto value = checked(in, fields::behaviour(in));
  if (!value) return false;
  value->modes = std::move(s.behaviour.modes);
  value->areas = s.behaviour.areas;
  s.behaviour = std::move(*value);
  return true;
}

bool read_place(Unpacker& in, Snapshot& s) {
  s.place = checked(in, fields::place(in));
  return s.place.has_value();
}

bool read_sigma(Unpacker& in, Snapshot& s) {
  StoredFrames place = s.place.value_or(StoredFrames{});
  if (!fields::read_sigma(in, place)) return false;
  if (s.place) s.place = place;  // Of a place that was lost it says nothing.
  return true;
}

bool read_area(Unpacker& in, Snapshot& s) {
  const nav::Area read = fields::area(in);
  if (!in.done()) return false;
  const auto valid = nav::checked(read);
  return valid && *valid == read && !s.behaviour.areas.find(read.name) && s.behaviour.areas.add(read);
}

bool read_mode(Unpacker& in, Snapshot& s) {
  auto value = checked(in, fields::mode(in));
  if (!value || s.behaviour.modes.size() >= Snapshot::kModes || s.behaviour.of(value->mode)) return false;
  s.behaviour.modes.push_back(std::move(*value));
  return true;
}

bool read_answers(Unpacker& in, Snapshot& s) {
  auto value = checked(in, fields::answers(in));
  if (!value || s.answers.size() >= StoredAnswers::kParticipants) return false;
  s.answers.push_back(std::move(*value));
  return true;
}

void write_host(const Snapshot& s, const std::function<void(const Packer&)>& add) {
  add(Packer{}.put(s.boot).put(s.battery));
}

bool read_host(Unpacker& in, Snapshot& s) {
  const auto boot = in.get<std::uint64_t>();
  const auto battery = in.get<std::uint8_t>();
  if (!in.done() || fields::sanitized_battery(battery) != battery) return false;
  s.boot = boot;
  s.battery = battery;
  return true;
}

constexpr store::SectionTag kAuthority{'A', 'U', 'T', 'H'}, kStops{'S', 'T', 'O', 'P'},
    kAreas{'A', 'R', 'E', 'A'};

/// In order of importance: if the file is full, the last sections are omitted.
const std::array kRows{
    Row{kAuthority, 1, "authority", true,
        [](const Snapshot& s, const auto& add) { add_one(add, s.authority); }, read_authority},
    Row{kStops, 1, "stops", true, [](const Snapshot& s, const auto& add) { add_one(add, s.authority.stops); },
        read_stops},
    Row{kAreas, 1, "an area", false,
        [](const Snapshot& s, const auto& add) {
          for (const nav::Area& area : s.behaviour.areas.all()) add_one(add, area);
        },
        read_area},
    Row{{'B', 'E', 'H', 'V'},
        1,
        "mode and goal",
        true,
        [](const Snapshot& s, const auto& add) { add_one(add, s.behaviour); },
        read_behaviour},
    Row{{'H', 'O', 'S', 'T'}, 2, "boot and battery", true, write_host, read_host},
    Row{{'P', 'L', 'A', 'C'},
        5,
        "place",
        false,
        [](const Snapshot& s, const auto& add) {
          if (s.place) add_one(add, *s.place);
        },
        read_place},
    Row{{'S', 'I', 'G', 'M'},
        1,
        "accuracy of the place",
        false,
        [](const Snapshot& s, const auto& add) {
          if (!s.place || !s.place->pose_sigma) return;
          Packer out;
          fields::put_sigma(out, *s.place);
          add(out);
        },
        read_sigma},
    Row{{'M', 'O', 'D', 'E'},
        1,
        "state of a mode",
        false,
        [](const Snapshot& s, const auto& add) {
          for (const StoredMode& mode : s.behaviour.modes) add_one(add, mode);
        },
        read_mode},
    Row{{'A', 'N', 'S', 'W'},
        1,
        "answers to a station",
        false,
        [](const Snapshot& s, const auto& add) {
          for (const StoredAnswers& from : s.answers) add_one(add, from);
        },
        read_answers},
};

const Row* find_row(const store::SectionTag& tag) {
  const auto found = std::find_if(kRows.begin(), kRows.end(), [&](const Row& row) { return row.tag == tag; });
  return found == kRows.end() ? nullptr : &*found;
}

/// Sets safe values for the entries that were lost.
void assume_safe(ReadSnapshot& read) {
  if (read.stops_lost) read.snapshot.authority.stops = {{StopLatches::kOthers, Id{}}};
}

void lose(ReadSnapshot& read, const Row& row) {
  read.lost.emplace_back(row.name);
  read.authority_lost = read.authority_lost || row.tag == kAuthority;
  read.stops_lost = read.stops_lost || row.tag == kStops;
  read.areas_lost = read.areas_lost || row.tag == kAreas;
}

}  // namespace

const store::Bytes* StoredBehaviour::of(std::string_view module) const {
  const auto found =
      std::find_if(modes.begin(), modes.end(), [&](const StoredMode& m) { return m.mode == module; });
  return found == modes.end() ? nullptr : &found->bytes;
}

Snapshot sanitized(Snapshot s) {
  auto stops = fields::sanitized(std::move(s.authority.stops));
  s.authority = fields::sanitized(std::move(s.authority));
  s.authority.stops = std::move(stops);
  s.behaviour = fields::sanitized(std::move(s.behaviour));
  s.battery = fields::sanitized_battery(s.battery);
  if (s.place) s.place = fields::sanitized(*s.place);
  if (s.answers.size() > StoredAnswers::kParticipants) s.answers.resize(StoredAnswers::kParticipants);
  for (StoredAnswers& from : s.answers) from = fields::sanitized(std::move(from));
  return s;
}

store::Bytes encode(const Snapshot& snapshot) {
  const Snapshot clean = sanitized(snapshot);
  std::vector<Section> sections;
  store::Bytes packed;
  for (const Row& row : kRows)
    row.write(clean, [&](const Packer& payload) {
      sections.push_back({row.tag, row.version, payload.bytes()});
      auto larger = sections.size() <= store::kMaxSections ? store::pack_sections(sections) : store::Bytes{};
      if (!larger.empty() && larger.size() <= kSnapshotFormat.max_bytes)
        packed = std::move(larger);
      else
        sections.pop_back();
    });
  return packed;
}

std::optional<ReadSnapshot> decode_snapshot(std::span<const std::uint8_t> bytes) {
  const store::SectionList list = store::unpack_sections(bytes);
  if (!list.readable) return std::nullopt;
  ReadSnapshot read{};
  std::vector<store::SectionTag> seen;
  for (const Section& section : list.damaged) {
    if (const Row* row = find_row(section.tag))
      lose(read, *row);
    else
      read.lost.push_back("section " + store::tag_text(section.tag));
    seen.push_back(section.tag);
  }
  for (const Section& section : list.good) {
    const Row* row = find_row(section.tag);
    seen.push_back(section.tag);
    if (!row || section.version > row->version) {
      read.unknown.push_back("section " + store::tag_text(section.tag));
      if (row) lose(read, *row);
      continue;
    }
    Unpacker in(section.payload);
    if (section.version < row->version || !row->read(in, read.snapshot)) lose(read, *row);
  }
  for (const Row& row : kRows)
    if (row.always && std::find(seen.begin(), seen.end(), row.tag) == seen.end()) lose(read, row);
  assume_safe(read);
  return read;
}

}  // namespace adit::agent
