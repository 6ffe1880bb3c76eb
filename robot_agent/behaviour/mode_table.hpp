// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/result/reason.hpp"
#include "core/time/time.hpp"
#include "robot_agent/behaviour/facts.hpp"

namespace adit::agent {

struct ModeContext;
class ModeModule;

/// The time at which a condition is evaluated, and the effect of its failure.
enum class Scope {
  on_entry,    ///< Evaluated only when the mode is entered; its failure refuses the mode.
  continuous,  ///< Evaluated on entry and while the mode lasts; then the row's `on_failure` is done.
  terminal,    ///< As `continuous`, but its failure ends the mode whatever the row's `on_failure` is.
};

/// A condition of a mode.
struct Condition {
  std::string_view leaf{};        ///< Name of its leaf in the behaviour tree; identifies the condition.
  Reason reason{};                ///< Reported to the operator when the condition fails.
  bool (*holds)(const Facts&){};  ///< Whether the condition is met.
  Scope scope{};

  bool entry_only() const { return scope == Scope::on_entry; }
  /// The reason when it fails: a robot that is not localised says why.
  Reason failure(const Facts& facts) const {
    return reason == Reason::no_localisation ? facts.unlocalised : reason;
  }
};

/// The conditions of the shipped modes, for rows of further ones.
namespace conditions {
extern const Condition kNotStopped, kDriverAlive, kLocalised, kTerrainFresh, kMapFresh, kStickFresh,
    kStickCentred, kStickPresent, kGoalKnown, kGoalFree, kProgramFresh;
}

/// The party that requests a mode.
enum class Commander : std::uint8_t {
  holder,  ///< The operator who holds the robot.
  agent,   ///< The robot's own safeguards.
};
/// The parties that may request a mode.
struct CommandedBy {
  bool holder{};
  bool agent{};
  constexpr bool allows(Commander who) const { return who == Commander::holder ? holder : agent; }
};

/// The input that a mode's module receives while the mode lasts.
enum class Accepts {
  nothing,
  stick,    ///< The holder's stick: a manual mode.
  goal,     ///< The places of `goto`.
  program,  ///< Velocities of a program on the robot.
};
/// What happens to the mode's goal when another mode is requested. On stop and restart the goal is always
/// stored.
enum class GoalOnLeaving { none, cleared };
/// What the failure of a continuous condition does.
enum class OnFailure { falls_to_hold, pauses };
/// What a change of holder does.
enum class OnHandover { continues, falls_to_hold };

/// A row of the mode table: all that code outside a mode's module knows of the mode.
struct ModeRow {
  std::string_view name{};
  CommandedBy commanded_by{};
  Accepts accepts{};
  GoalOnLeaving goal{};
  OnFailure on_failure{};  ///< `pauses`: it also resumes after a restart.
  OnHandover on_handover{};
  /// In the order in which they are reported to operators.
  std::vector<Condition> conditions{};
  /// Makes the mode's module, or none if the robot lacks what the mode needs: the mode is then not installed.
  /// Null: nothing moves the robot in this mode.
  std::unique_ptr<ModeModule> (*make)(const ModeContext&){};
  Duration output_lifetime{};  ///< Period for which the module's last output is valid (rule 6).
  bool optional{};             ///< A tree may omit the mode; it is then not installed.

  bool manual() const { return accepts == Accepts::stick; }
  bool moves() const { return make != nullptr; }
  /// Whether the mode continues without an operator.
  bool autonomous() const { return moves() && !manual(); }
  /// The first condition that fails and whose failure ends the mode while it lasts; null: it continues.
  const Condition* ended_by(const Facts& facts) const;
  /// The first continuous condition that fails: a mode that did not end pauses; null: none fails.
  const Condition* paused_by(const Facts& facts) const;
};

/// The modes of a robot: `hold`, the fallback of all modes, and others. Guard, behaviour tree, command
/// interface and BehaviourState read it. Decisions point into it: the table must outlive its users.
class ModeTable {
 public:
  /// The first row must be `hold`; names must be unique.
  explicit ModeTable(std::vector<ModeRow> rows);
  ModeTable(const ModeTable&) = delete;
  ModeTable& operator=(const ModeTable&) = delete;

  /// The modes of this version: hold, manual, smart_joystick, waypoint, explore, external, convoy_follow,
  /// get_out.
  static const ModeTable& shipped();

  const std::vector<ModeRow>& rows() const { return rows_; }
  const ModeRow& hold() const { return rows_.front(); }
  /// The row with that name; null if the table has none.
  const ModeRow* find(std::string_view name) const;
  /// The first row whose mode accepts that input; null if there is none.
  const ModeRow* find_by_input(Accepts input) const;
  /// The conditions of all rows, each once.
  const std::vector<Condition>& conditions() const { return conditions_; }

 private:
  std::vector<ModeRow> rows_;
  std::vector<Condition> conditions_{};
};

/// Why the mode cannot be entered now; `none` if it can.
Reason entry_refusal(const ModeRow& row, const Facts& facts);

}  // namespace adit::agent
