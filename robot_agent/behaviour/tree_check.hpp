// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/bt/tree.hpp"
#include "robot_agent/behaviour/mode_table.hpp"

namespace adit::agent {

/// Checks that a robot's behaviour tree agrees with the mode table.
///
/// A `Mode` evaluates its row itself and may be anywhere. Each `Run` of a mode needs `Requested` with that
/// mode and every continuous condition of its row, each `Pause` needs `Requested` and the conditions that end
/// the mode. A condition counts if it is evaluated in every tick that reaches the leaf: it precedes the leaf
/// in a ReactiveSequence, under ReactiveSequence, ReactiveFallback and SubTree only, and no `_skipIf`,
/// `_successIf` or `_while` passes over it. Conditions under a node that remembers (Sequence), inverts,
/// forces or runs its children in parallel do not count. A mode of the table that is not optional needs a
/// `Mode` or `Run`, `hold` a `Run`.
///
/// The check helps authors of trees. MotionGuard enforces the table whether a tree was checked or not.
/// Errors: tree_refused, with "file:line: what is missing".
Result<void> check_tree(const bt::Tree& tree, const ModeTable& table);

/// Loads the robot's tree from an XML file and checks it.
///
/// Errors: those of the loader (cannot_read, syntax, ...), and tree_refused; each with file and line.
Result<void> check_tree(const std::string& file, const ModeTable& table = ModeTable::shipped());

/// Whether the tree has a leaf of a robot's tree: Mode, Run, Pause, Requested or a condition of the mode
/// table.
bool is_robot_tree(const bt::Tree& tree, const ModeTable& table = ModeTable::shipped());

}  // namespace adit::agent
