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

/// The conditions of the shipped modes, for rows of further ones.
namespace conditions {
extern const Condition kNotStopped, kDriverAlive, kLocalised, kTerrainFresh, kStickFresh, kStickCentred,
    kStickKept, kGoalKnown, kGoalFree, kProgramFresh;
}

/// Who asks for a mode.
enum class Commander : std::uint8_t {
  holder,  ///< The operator who holds the robot.
  agent,   ///< The robot's own safeguards.
};
/// The commanders that may ask for a mode.
struct CommandedBy {
  bool holder{};
  bool agent{};
  constexpr bool allows(Commander who) const { return who == Commander::holder ? holder : agent; }
};

/// What a mode's module is given while the mode lasts.
enum class Accepts {
  nothing,
  stick,    ///< The holder's stick: a manual mode.
  goal,     ///< The places of `goto`.
  program,  ///< Velocities of a program on the robot.
};
/// What becomes of the mode's goal when another mode is requested. On stop and restart it is always stored.
enum class GoalOnLeaving { none, cleared };
/// What the failure of a lasting condition does.
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
  /// In the order in which an operator is told of them.
  std::vector<Condition> conditions{};
  /// Makes the mode's module; null: nothing moves the robot in this mode.
  std::unique_ptr<ModeModule> (*make)(const ModeContext&){};
  Duration source_age{};  ///< What the module wrote counts for so long (rule 6).
  bool optional{};        ///< A tree may do without it: it is then not installed.

  bool manual() const { return accepts == Accepts::stick; }
  bool moves() const { return make != nullptr; }
  /// Goes on without its operator.
  bool autonomous() const { return moves() && !manual(); }
};

/// The modes of a robot: `hold`, the fallback of all modes, and others. Guard, behaviour tree, command
/// interface and BehaviourState read it. Decisions point into it: it must outlive who uses it.
class ModeTable {
 public:
  /// The first row must be `hold`; names must be unique.
  explicit ModeTable(std::vector<ModeRow> rows);
  ModeTable(const ModeTable&) = delete;
  ModeTable& operator=(const ModeTable&) = delete;

  /// The modes of this version: hold, manual, smart_joystick, waypoint, external.
  static const ModeTable& shipped();

  const std::vector<ModeRow>& rows() const { return rows_; }
  const ModeRow& hold() const { return rows_.front(); }
  /// The row of that name, null when this robot has no module for it.
  const ModeRow* find(std::string_view name) const;
  /// The first row that accepts it, null when there is none.
  const ModeRow* accepting(Accepts what) const;
  /// Every distinct condition.
  const std::vector<Condition>& conditions() const { return conditions_; }

 private:
  std::vector<ModeRow> rows_;
  std::vector<Condition> conditions_{};
};

/// A mode of the design that no shipped module provides.
bool known_but_not_installed(std::string_view name);
/// Why the mode cannot be entered now; none when it can.
Reason entry_refusal(const ModeRow& row, const Facts& facts);

}  // namespace adit::agent
