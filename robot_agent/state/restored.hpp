// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/store/disk.hpp"
#include "robot_agent/state/snapshot.hpp"

namespace adit::agent {

inline constexpr const char* kStateFile = "state";
/// Name of the file written with the first state; it distinguishes a lost state from a first start.
inline constexpr const char* kMarkerFile = "has-state";
inline constexpr const char* kIdentityFile = "identity";

/// The result of reading the agent's state from its disk.
struct Restored {
  std::optional<Snapshot> snapshot{};
  bool lost{};              ///< There was a state, and nothing of it can be used: hold, no holder.
  bool damaged{};           ///< A part of the state, or its file, differs from what was written.
  bool hold{};              ///< Holder or stops are unknown: no mode resumes by itself.
  std::string text{};       ///< What was lost and why, for operators; empty: nothing was lost.
  std::string preserved{};  ///< The new name of a file that could not be read; empty: none.
  std::uint64_t generation{};
  bool placed{};  ///< The stored place was replaced by place_at().

  /// Replaces the stored place by that of an odometry frame that nothing is known of yet: no mode resumes in
  /// it. The state is on `disk` when this returns, so that no later start uses the former place. Does nothing
  /// if no place is stored. Errors: those of the disk, which then has the former state.
  ///
  /// @param T_map_odom  Pose of the frame's origin in the map, m and rad.
  /// @param height      Height of that origin, map frame, m.
  Result<void> place_at(const Pose2& T_map_odom, double height, const std::shared_ptr<store::Disk>& disk);
};

/// Reads the state; never guesses. A file that this version cannot use is renamed, and one that it can use in
/// part is copied: `state.newer`, `state.damaged` and so on. `disk` null: a first start.
Restored restore_state(const std::shared_ptr<store::Disk>& disk);

/// Makes the same result from a state in memory.
Restored restored_from(const Snapshot& snapshot);

/// Reads this robot's id from its disk. Stores and returns `drawn` if there is none yet, or if it cannot be
/// read.
Id restore_identity(const std::shared_ptr<store::Disk>& disk, const Id& drawn);

/// "held by op1, locked; stopped by op2; goal 3 kept": a readable summary of the restored state.
std::string describe(const Snapshot& snapshot);

}  // namespace adit::agent
