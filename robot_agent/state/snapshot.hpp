// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/store/state_file.hpp"
#include "nav/areas/area_set.hpp"
#include "robot_agent/command/stored_authority.hpp"
#include "robot_agent/motion/stored_frames.hpp"

namespace adit::agent {

/// State that a mode's module stores, beside the goal of `waypoint`.
struct StoredMode {
  std::string mode{};
  store::Bytes bytes{};  ///< At most Snapshot::kModeBytes; only that module reads them.
  bool operator==(const StoredMode&) const = default;
};

/// State of the behaviour: what was requested, not what the tree decided.
struct StoredBehaviour {
  std::string mode{"hold"};
  Reason reason{Reason::none};  ///< Why the robot fell to hold.
  bool goal_known{}, goal_reached{};
  std::uint32_t goal_id{};
  Eigen::Vector3d goal{Eigen::Vector3d::Zero()};  ///< Map frame, m.
  bool goal_on_floor{};                           ///< The goal has no z of its own.
  std::vector<StoredMode> modes{};                ///< At most Snapshot::kModes, each mode once.

  nav::AreaSet areas{};  ///< Map frame.

  /// The bytes that a mode's module stored; null: none.
  const store::Bytes* of(std::string_view module) const;
  bool operator==(const StoredBehaviour&) const = default;
};

/// The last known safe state (rule 7), from which an agent restarts.
struct Snapshot {
  static constexpr std::size_t kStops = 16, kModes = 8, kModeBytes = 512;

  StoredAuthority authority{};
  StoredBehaviour behaviour{};
  std::uint64_t boot{};  ///< Boot id of the computer when the state was written; 0: unknown.
  /// Threshold of the charge that was passed last: 0 none, 1 warning, 2 low, 3 last; 4: last, and the return
  /// to the start is still pending.
  std::uint8_t battery{};
  std::optional<StoredFrames> place{};  ///< Unset: it could not be read.
  std::vector<StoredAnswers> answers{};
  /// Compares all but the answers and the odometry, i.e. the state that must survive a restart.
  bool same_state(const Snapshot& other) const {
    return authority == other.authority && behaviour == other.behaviour && boot == other.boot &&
           battery == other.battery && place.has_value() == other.place.has_value() &&
           (!place || place->same_frame(*other.place));
  }
  bool operator==(const Snapshot&) const = default;
};

/// The payload is a list of sections (core/store/sections.hpp), see snapshot.cpp.
inline constexpr store::StateFormat kSnapshotFormat{{'R', 'O', 'B', 'O'}, 3, 24 * 1024};

/// The result of decoding a state file.
struct ReadSnapshot {
  Snapshot snapshot{};  ///< Lost entries have their default values.
  /// Readable names of entries that could not be read: "stops", "an answer".
  std::vector<std::string> lost{};
  std::vector<std::string> unknown{};  ///< Skipped sections of a newer version of this program.
  bool authority_lost{};               ///< Holder, lock and epoch are unknown.
  bool areas_lost{};                   ///< It is not known where the robot may drive.
  bool stops_lost{};  ///< The stopping stations are unknown: `snapshot` has a stop of "others".
  bool safe() const { return !authority_lost && !stops_lost && !areas_lost; }
};

/// Returns the snapshot in the form in which it is written and read: bounded, and without invalid values. A
/// stop whose name is not valid becomes one of "others"; an answer that is not valid is left out.
Snapshot sanitized(Snapshot snapshot);

/// Encodes the sanitized snapshot, at most 24 kB: decoding gives it back without loss.
store::Bytes encode(const Snapshot& snapshot);

/// Decodes the sections that are intact. Returns nothing if the directory of sections cannot be read.
std::optional<ReadSnapshot> decode_snapshot(std::span<const std::uint8_t> bytes);

}  // namespace adit::agent
