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
  bool lost{};         ///< there was a state, and it cannot be used: hold, no holder, and everybody is told
  std::string text{};  ///< why it was lost
  std::uint64_t generation{};
};

/// Never guesses: anything but a whole state of this version is lost. `disk` null: a first start.
Restored restore_state(const std::shared_ptr<store::Disk>& disk);

/// The 128 bits of this robot, kept on its disk. `drawn` becomes them when there are none yet, or when they
/// cannot be read.
Id restore_identity(const std::shared_ptr<store::Disk>& disk, const Id& drawn);

/// "held by op1, locked; stopped by op2; goal 3 kept": what came back, for people.
std::string describe(const Snapshot& snapshot);

}  // namespace adit::agent
