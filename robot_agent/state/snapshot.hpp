#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/store/state_file.hpp"
#include "robot_agent/command/kept.hpp"
#include "robot_agent/motion/kept_place.hpp"

namespace adit::agent {

/// What the module of a mode stores, beside the goal of `waypoint`.
struct KeptMode {
  std::string mode{};
  store::Bytes bytes{};  ///< At most Snapshot::kModeBytes; only that module reads them.
  bool operator==(const KeptMode&) const = default;
};

/// Of the behaviour: what was asked for, not what the tree made of it.
struct KeptBehaviour {
  std::string mode{"hold"};
  Reason reason{Reason::none};  ///< why it fell to hold
  bool goal_known{}, goal_reached{};
  std::uint32_t goal_id{};
  Eigen::Vector3d goal{Eigen::Vector3d::Zero()};  ///< map frame, m
  bool goal_on_floor{};                           ///< it was given no height
  std::vector<KeptMode> modes{};                  ///< At most Snapshot::kModes, each mode once.

  /// The bytes that a mode's module stored; null: none.
  const store::Bytes* of(std::string_view module) const;
  bool operator==(const KeptBehaviour&) const = default;
};

/// The last known safe state (rule 7): what an agent comes back with.
struct Snapshot {
  static constexpr std::size_t kStops = 16, kModes = 8, kModeBytes = 512;

  KeptAuthority authority{};
  KeptBehaviour behaviour{};
  std::uint64_t boot{};  ///< of the computer when it was written; 0: not known
  /// Threshold of the charge that was passed last: 0 none, 1 warning, 2 low, 3 last; 4: last, and the return
  /// to the start that it asked for was not accepted yet.
  std::uint8_t battery{};
  std::optional<KeptPlace> place{};  ///< Empty: it could not be read.
  std::vector<KeptAnswers> answers{};
  /// Without the answers and the odometry: what tells whether something changed that must survive.
  bool same_state(const Snapshot& other) const {
    return authority == other.authority && behaviour == other.behaviour && boot == other.boot &&
           battery == other.battery && place.has_value() == other.place.has_value() &&
           (!place || place->same_frame(*other.place));
  }
  bool operator==(const Snapshot&) const = default;
};

/// Version 3: sections (core/store/sections.hpp), see snapshot.cpp. Version 2 is still read.
inline constexpr store::StateFormat kSnapshotFormat{{'R', 'O', 'B', 'O'}, 3, 16 * 1024};

/// What the bytes of a state file gave.
struct ReadSnapshot {
  Snapshot snapshot{};                 ///< What was lost in it has its default value.
  std::vector<std::string> lost{};     ///< Entries that could not be read, for people: "stops", "an answer"
  std::vector<std::string> unknown{};  ///< Sections of a newer version of this program, skipped
  bool authority_lost{};               ///< Holder, lock and epoch are not known.
  bool stops_lost{};  ///< Who stopped the robot is not known: `snapshot` holds a stop of "others".
  bool safe() const { return !authority_lost && !stops_lost; }
};

/// The snapshot as it is written and read: bounded, and nothing in it that no robot could have meant. A stop
/// whose name is not valid becomes one of "others"; an answer that is not valid is left out.
Snapshot sanitized(Snapshot snapshot);

/// Encodes the sanitized snapshot, at most 16 kB: decoding gives it back without loss.
store::Bytes encode(const Snapshot& snapshot);

/// Decodes the sections that are intact. Nothing when not even their directory can be read.
std::optional<ReadSnapshot> decode_snapshot(std::span<const std::uint8_t> bytes);

/// Decodes the payload of version 2, which has no sections: what is behind the first error is lost.
std::optional<ReadSnapshot> decode_snapshot_v2(std::span<const std::uint8_t> bytes);

}  // namespace adit::agent
