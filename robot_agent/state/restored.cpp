// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/state/restored.hpp"

#include <algorithm>

#include "core/command/words.hpp"
#include "core/store/preserve.hpp"

namespace adit::agent {
namespace {

constexpr store::StateFormat kIdentityFormat{{'I', 'D', 'E', 'N'}, 1, 16};

std::optional<ReadSnapshot> read_any(const store::State& state) {
  switch (state.found) {
    case store::LoadStatus::good:
      return decode_snapshot(state.payload);
    case store::LoadStatus::torn:
    case store::LoadStatus::corrupt:
    case store::LoadStatus::foreign:
      return decode_snapshot(state.remains);
    case store::LoadStatus::nothing:
    case store::LoadStatus::older:
    case store::LoadStatus::newer:
    case store::LoadStatus::unreadable:
      break;
  }
  return std::nullopt;
}

Restored usable(ReadSnapshot read) {
  Restored r{};
  r.hold = !read.safe();
  if (!read.lost.empty()) r.text = "lost: " + command::joined(read.lost, "");
  if (!read.unknown.empty())
    r.text += (r.text.empty() ? "" : "; ") + ("of a newer version: " + command::joined(read.unknown, ""));
  r.damaged = !r.text.empty();
  r.snapshot = std::move(read.snapshot);
  return r;
}

}  // namespace

Result<void> Restored::place_at(const Pose2& T_map_odom, double height,
                                const std::shared_ptr<store::Disk>& disk) {
  if (!snapshot || !snapshot->place) return {};
  const StoredFrames& stored = *snapshot->place;
  snapshot->place = StoredFrames{.T_map_odom = T_map_odom,
                                 .odom_epoch = stored.odom_epoch + 1,
                                 .height = height,
                                 .map_epoch = stored.map_epoch};
  placed = true;
  return store::StateFile(disk, kStateFile, kSnapshotFormat).save(++generation, encode(*snapshot));
}

Restored restore_state(const std::shared_ptr<store::Disk>& disk) {
  if (!disk) return {};
  const store::State state = store::StateFile(disk, kStateFile, kSnapshotFormat).load();
  if (state.found == store::LoadStatus::nothing) {
    Restored r{};
    const auto marker = disk->read(kMarkerFile);
    r.lost = !marker || *marker;
    if (r.lost) r.text = "the disk could not keep it";
    return r;
  }
  auto read = read_any(state);
  if (!read) {
    Restored r{};
    r.lost = true;
    // The file is complete, but has no list of sections.
    const bool broken = state.found == store::LoadStatus::good;
    r.text =
        broken ? "corrupt: it makes no sense" : std::string(store::name(state.found)) + ": " + state.text;
    r.preserved = store::set_aside(*disk, kStateFile, broken ? "corrupt" : store::name(state.found));
    r.generation = state.generation;
    return r;
  }
  const bool newer = !read->unknown.empty();
  Restored r = usable(std::move(*read));
  r.generation = state.generation;
  if (state.found != store::LoadStatus::good) {
    r.damaged = true;
    r.text = std::string(store::name(state.found)) +
             (r.text.empty() ? ", every entry could be read" : "; " + r.text);
  }
  if (r.damaged) r.preserved = store::copy_aside(*disk, kStateFile, newer ? "newer" : "damaged");
  return r;
}

Restored restored_from(const Snapshot& snapshot) {
  Restored r{};
  r.snapshot = sanitized(snapshot);
  return r;
}

Id restore_identity(const std::shared_ptr<store::Disk>& disk, const Id& drawn) {
  if (!disk) return drawn;
  const store::StateFile file(disk, kIdentityFile, kIdentityFormat);
  const store::State state = file.load();
  if (state.found == store::LoadStatus::good && state.payload.size() == drawn.size()) {
    Id id{};
    std::copy(state.payload.begin(), state.payload.end(), id.begin());
    return id;
  }
  if (state.found != store::LoadStatus::nothing)
    (void)store::set_aside(*disk, kIdentityFile, store::name(state.found));
  (void)file.save(1, drawn);  // A disk failure is reported with the first state.
  return drawn;
}

std::string describe(const Snapshot& s) {
  std::string text = s.authority.holder ? "held by " + s.authority.holder->name : "held by nobody";
  if (s.authority.locked) text += ", locked";
  for (std::size_t i = 0; i < s.authority.stops.size(); ++i)
    text += (i == 0 ? "; stopped by " : ", ") + s.authority.stops[i].name;
  text += "; was in " + s.behaviour.mode;
  if (const auto areas = s.behaviour.areas.all(); !areas.empty())
    text += ", " + std::to_string(areas.size()) + (areas.size() == 1 ? " area" : " areas");
  if (s.behaviour.goal_known) text += ", goal " + std::to_string(s.behaviour.goal_id) + " kept";
  return text;
}

}  // namespace adit::agent
