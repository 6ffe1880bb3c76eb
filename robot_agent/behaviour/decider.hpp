// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "core/bt/tree.hpp"
#include "robot_agent/behaviour/decision.hpp"

namespace adit::agent {

/// Runs the robot's behaviour tree (config/trees/robot.xml). Its leaf `Mode mode=""` evaluates a row of the
/// mode table and decides for that mode. Leaves for trees that do this themselves: the conditions of the
/// table by name, `Requested mode=""`, and the two kinds of decision, `Run mode=""` and `Pause mode=""`.
///
/// Its decisions are requests: MotionGuard enforces the mode table in front of the mux.
class Decider {
 public:
  /// Loads a tree and checks it against the mode table. Errors: those of the loader and of check_tree(), with
  /// file and line.
  static Result<std::unique_ptr<Decider>> load(const std::string& tree_file,
                                               const ModeTable& table = ModeTable::shipped());
  static Result<std::unique_ptr<Decider>> load_text(const std::string& xml,
                                                    const ModeTable& table = ModeTable::shipped());
  /// Loads a tree without the check, for tests of what the guard enforces. Errors: those of the loader.
  static Result<std::unique_ptr<Decider>> load_unchecked(const std::string& tree_file,
                                                         const ModeTable& table = ModeTable::shipped());
  /// Makes a decider that always chooses `hold`, because the tree was refused with `why`.
  static std::unique_ptr<Decider> refused(const Error& why, const ModeTable& table = ModeTable::shipped());
  Decider(const Decider&) = delete;
  Decider& operator=(const Decider&) = delete;

  /// Ticks the tree once. A tree that decides nothing, or fails, chooses `hold`.
  Decision decide(std::string_view requested, const Facts& facts, Time now);
  /// Whether the tree has a Mode or Run for that mode.
  bool installed(const ModeRow& row) const { return modes_.contains(row.name); }
  const ModeTable& table() const { return table_; }
  /// Why the tree was refused; empty: it runs.
  const std::string& refusal() const { return refusal_; }
  /// The text of an exception that a leaf threw in the last tick; empty: none.
  const std::string& error() const { return error_; }

 private:
  explicit Decider(const ModeTable& table) : table_(table) {}
  Result<bt::Registry> registry();
  static Result<std::unique_ptr<Decider>> make(
      const ModeTable& table, const std::function<Result<bt::Tree>(const bt::Registry&)>& load);
  static Result<std::unique_ptr<Decider>> checked(Result<std::unique_ptr<Decider>> decider);
  // Leaves with a mode; true: success.
  bool is_requested(const ModeRow& row) { return row.name == requested_; }
  bool run(const ModeRow& row) { return choose(row, true); }
  bool pause(const ModeRow& row) { return choose(row, false); }
  bool run_or_pause(const ModeRow& row);
  bool choose(const ModeRow& row, bool runs);
  void note_failure(const Condition& failed);

  const ModeTable& table_;
  bt::Tree tree_{};
  std::set<std::string, std::less<>> modes_{};  ///< Names of the modes that the tree runs.
  std::string_view requested_{};
  Facts facts_{};
  Decision decision_{};
  std::string error_{}, refusal_{};
};

}  // namespace adit::agent
