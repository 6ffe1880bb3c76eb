// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/tree_check.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "robot_agent/behaviour/decider.hpp"

namespace adit::agent {
namespace {

using bt::Hook;
using bt::NodeKind;
using bt::TreeNode;

bool is_leaf(const TreeNode& node, std::string_view id) {
  return node.kind() != NodeKind::subtree && node.children().empty() && node.id() == id;
}

bool is_condition(const TreeNode& node, const ModeTable& table) {
  const auto& all = table.conditions();
  return std::any_of(all.begin(), all.end(), [&](const Condition& c) { return is_leaf(node, c.leaf); });
}

/// Whether the node is a leaf with a mode of the table.
bool has_mode(const TreeNode& node) {
  return is_leaf(node, "Mode") || is_leaf(node, "Run") || is_leaf(node, "Pause") ||
         is_leaf(node, "Requested");
}

std::string mode_of(const TreeNode& node) {
  const auto mode = node.config().ports.find("mode");
  return mode == node.config().ports.end() ? std::string{} : mode->second;
}

/// The name under which a leaf counts as evaluated: a condition's, or `Requested mode="NAME"`.
std::string requested(std::string_view mode) { return "Requested mode=\"" + std::string(mode) + "\""; }

std::optional<std::string> asked_by(const TreeNode& leaf, const ModeTable& table) {
  if (is_leaf(leaf, "Requested")) return requested(mode_of(leaf));
  if (is_condition(leaf, table)) return leaf.id();
  return std::nullopt;
}

/// Whether scripts let the node return a status without being ticked.
bool may_be_passed_over(const TreeNode& node) {
  const auto has = [&](Hook hook) { return node.config().hooks[static_cast<std::size_t>(hook)] != nullptr; };
  return has(Hook::success_if) || has(Hook::skip_if) || has(Hook::while_true);
}

bool is_reactive(const TreeNode& node) {
  return node.kind() == NodeKind::subtree || node.id() == "ReactiveSequence" ||
         node.id() == "ReactiveFallback";
}

/// Whether the condition was evaluated in this tick, and held, if the node succeeds. A node with such a
/// condition is never skipped.
bool guarantees(const TreeNode& node, const std::string& condition, const ModeTable& table) {
  if (may_be_passed_over(node)) return false;
  if (asked_by(node, table) == condition) return true;
  if (!is_reactive(node)) return false;
  const auto holds = [&](const auto& child) { return guarantees(*child, condition, table); };
  return node.id() == "ReactiveFallback" ? std::ranges::all_of(node.children(), holds)
                                         : std::ranges::any_of(node.children(), holds);
}

std::string place(const TreeNode& node) {
  return node.config().file + ":" + std::to_string(node.config().line);
}

class Checker {
 public:
  explicit Checker(const ModeTable& table) : table_(table) {}

  Result<void> run(const bt::Tree& tree) {
    visit(tree.root());
    if (error_.empty())
      for (const ModeRow& row : table_.rows())
        if (!row.optional && !runs_.contains(row.name))
          refuse(tree.root(), "the tree has no Run for mode " + std::string(row.name));
    if (error_.empty()) return {};
    return {Reason::tree_refused, error_};
  }

 private:
  void visit(const TreeNode& node) {
    if (!error_.empty()) return;
    path_.push_back(&node);
    if (has_mode(node)) check_leaf(node);
    for (const auto& child : node.children()) visit(*child);
    path_.pop_back();
  }

  void check_leaf(const TreeNode& leaf) {
    const std::string mode = mode_of(leaf);
    const ModeRow* row = table_.find(mode);
    if (!row) return refuse(leaf, leaf.id() + ": the mode table has no mode '" + mode + "'");
    const bool is_hold = row == &table_.hold(), runs = leaf.id() == "Run", evaluates = leaf.id() == "Mode";
    // As the fallback of all modes, hold runs whether it was requested or not.
    if (runs || (evaluates && !is_hold)) runs_.insert(row->name);
    if (is_hold || evaluates || leaf.id() == "Requested") return;
    if (!runs && row->on_failure != OnFailure::pauses)
      return refuse(leaf, std::string(row->name) + " cannot pause: it falls to hold");
    require(leaf, requested(row->name));
    for (const Condition& c : row->conditions)
      if (runs ? !c.entry_only() : c.scope == Scope::terminal) require(leaf, std::string(c.leaf));
  }

  /// Refuses the leaf that is visited unless the condition precedes it in every tick.
  void require(const TreeNode& leaf, const std::string& condition) {
    std::string why;  // Why a condition that precedes the leaf does not count, the nearest first.
    for (std::size_t i = path_.size() - 1; i-- > 0;)
      for (const auto& child : path_[i]->children()) {
        if (child.get() == path_[i + 1]) break;
        if (path_[i]->id() == "ReactiveSequence" && guarantees(*child, condition, table_)) return;
        std::vector<const TreeNode*> way{path_[i]};
        if (why.empty() && find(*child, condition, way)) why = ": " + blame(way);
      }
    refuse(leaf, leaf.id() + " mode=\"" + mode_of(leaf) + "\" lacks the condition " + condition +
                     (why.empty() ? " before it" : why));
  }

  bool find(const TreeNode& node, const std::string& condition, std::vector<const TreeNode*>& way) const {
    way.push_back(&node);
    if (asked_by(node, table_) == condition) return true;
    for (const auto& child : node.children())
      if (find(*child, condition, way)) return true;
    way.pop_back();
    return false;
  }

  static std::string blame(const std::vector<const TreeNode*>& way) {
    const std::string it =
        "the one in line " + std::to_string(way.back()->config().line) + " does not count, ";
    for (const TreeNode* node : way)
      if (may_be_passed_over(*node))
        return it + "_skipIf, _successIf or _while may pass over " + node->name();
    for (std::size_t i = way.size() - 1; i-- > 0;)
      if (!is_reactive(*way[i])) return it + "it is under " + way[i]->id() + "; use ReactiveSequence";
    return it + "ReactiveFallback does without it";
  }

  void refuse(const TreeNode& node, const std::string& what) {
    if (error_.empty()) error_ = place(node) + ": " + what;
  }

  const ModeTable& table_;
  std::vector<const TreeNode*> path_{};  ///< From the root to the node that is visited.
  std::set<std::string_view> runs_{};
  std::string error_{};
};

}  // namespace

Result<void> check_tree(const bt::Tree& tree, const ModeTable& table) { return Checker(table).run(tree); }

Result<void> check_tree(const std::string& file, const ModeTable& table) {
  const auto decider = Decider::load(file, table);
  return decider ? Result<void>{} : Result<void>{decider.error()};
}

bool is_robot_tree(const bt::Tree& tree, const ModeTable& table) {
  bool found = false;
  tree.for_each([&](const TreeNode& node, std::size_t) {
    found = found || has_mode(node) || is_condition(node, table);
  });
  return found;
}

}  // namespace adit::agent
