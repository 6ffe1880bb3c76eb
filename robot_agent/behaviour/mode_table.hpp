#pragma once
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

/// A condition: the leaf of that name in the behaviour tree, and what the operator reads when it fails.
struct Condition {
  std::string_view leaf{};
  Reason reason{};
  bool (*holds)(const Facts&){};
  bool entry_only{};  ///< asked when the mode is entered, not while it lasts
};

/// What a mode takes: from its holder, or from a program on the robot.
enum class Accepts { nothing, stick, goal, program };
/// What becomes of the goal when the mode is left for another.
enum class GoalOnLeaving { none, cleared };
/// When a condition fails while the mode lasts, or the holder changes.
enum class OnFailure { falls_to_hold, pauses };

struct ModeRow {
  std::string_view name{};
  std::string_view commanded_by{};  ///< who may ask for it
  Accepts accepts{};
  GoalOnLeaving goal{};    ///< on stop and restart a goal is always kept
  OnFailure on_failure{};  ///< `pauses`: autonomous, goes on under the next holder
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
