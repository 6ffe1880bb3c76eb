#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "core/result/reason.hpp"

namespace adit::agent {

/// What the conditions of the modes look at.
struct Facts {
  bool stopped{};
  bool driver_alive{};   ///< odometry within the last 0.5 s
  bool localised{};      ///< start pose known and odometry heard
  bool terrain_fresh{};  ///< lidar points within the last 0.5 s
  bool stick_fresh{};    ///< a sample within the last 0.3 s
  bool stick_kept{};     ///< a sample, or the entry into the mode, within the last 1 s
  bool stick_centred{};
  bool goal_known{};
  bool goal_free{};      ///< no obstacle that is known covers it
  bool program_fresh{};  ///< the program that steers from outside spoke within the last 0.5 s
};

/// When a condition is asked.
enum class Scope {
  entry,    ///< Only when the mode is entered.
  lasting,  ///< On entry and while the mode lasts; the row's `on_failure` says what its failure does.
  ending,   ///< The same, and its failure ends every mode, even one that pauses.
};

/// A condition: the leaf of that name in the behaviour tree, and what the operator reads when it fails.
struct Condition {
  std::string_view leaf{};
  Reason reason{};
  bool (*holds)(const Facts&){};
  Scope scope{};

  bool entry_only() const { return scope == Scope::entry; }
};

/// Who asks for a mode.
enum class Commander : std::uint8_t {
  holder = 1,  ///< The operator who holds the robot.
  agent = 2,   ///< The robot's own safeguards.
};
/// The commanders that may ask for a mode.
struct CommandedBy {
  bool holder{};
  bool agent{};
  constexpr bool allows(Commander who) const { return who == Commander::holder ? holder : agent; }
};

/// What a mode takes: from its holder, or from a program on the robot.
enum class Accepts { nothing, stick, goal, program };
/// What becomes of the goal when the mode is left for another.
enum class GoalOnLeaving { none, cleared };
/// What the failure of a lasting condition does.
enum class OnFailure { falls_to_hold, pauses };
/// What a change of holder does.
enum class OnHandover { continues, falls_to_hold };

struct ModeRow {
  std::string_view name{};
  CommandedBy commanded_by{};
  Accepts accepts{};
  GoalOnLeaving goal{};  ///< On stop and restart a goal is always stored.
  OnFailure on_failure{};
  OnHandover on_handover{};
  std::span<const Condition> conditions{};

  bool optional{};  ///< a tree may do without it: then it is not installed

  bool manual() const { return accepts == Accepts::stick; }
  /// Goes on without its operator.
  bool autonomous() const { return accepts == Accepts::goal || accepts == Accepts::program; }
};

/// The mode table: the tree's leaves, the command interface, BehaviourState and, through it, every
/// console read it. Reading order is the order in which conditions are told.
std::span<const ModeRow> mode_table();
/// The row of that name, null when this robot has no module for it.
const ModeRow* find_mode(std::string_view name);
/// A mode of the design for which no module is installed.
bool known_but_not_installed(std::string_view name);
/// Why the mode cannot be entered now; none when it can.
Reason entry_refusal(const ModeRow& row, const Facts& facts);
/// Every distinct condition of the table.
std::span<const Condition> all_conditions();

}  // namespace adit::agent
