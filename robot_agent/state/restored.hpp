#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/store/disk.hpp"
#include "robot_agent/state/snapshot.hpp"

namespace adit::agent {

inline constexpr const char* kStateFile = "state";
/// Written with the first state: tells a state that was lost from a first start.
inline constexpr const char* kMarkerFile = "has-state";
inline constexpr const char* kIdentityFile = "identity";

/// What an agent found on its disk.
struct Restored {
  std::optional<Snapshot> snapshot{};
  bool lost{};              ///< There was a state, and nothing of it can be used: hold, no holder.
  bool damaged{};           ///< A part of the state, or its file, is not what was written.
  bool hold{};              ///< Holder or stops are not known: nothing goes on by itself.
  std::string text{};       ///< What was lost and why, for operators; empty when nothing was
  std::string preserved{};  ///< The name under which the file that was not understood is stored; empty: none
  std::uint64_t generation{};
};

/// Reads the state; never guesses. A file that this version cannot use is given another name, one that it can
/// use in part is copied: `state.newer`, `state.damaged` and so on. `disk` null: a first start.
Restored restore_state(const std::shared_ptr<store::Disk>& disk);

/// The same for a state that this process holds in memory.
Restored restored_from(const Snapshot& snapshot);

/// The 128 bits of this robot, kept on its disk. `drawn` becomes them when there are none yet, or when they
/// cannot be read.
Id restore_identity(const std::shared_ptr<store::Disk>& disk, const Id& drawn);

/// "held by op1, locked; stopped by op2; goal 3 kept": what came back, for people.
std::string describe(const Snapshot& snapshot);

}  // namespace adit::agent
