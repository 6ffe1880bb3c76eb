// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/bt/node.hpp"
#include "core/bt/registry.hpp"
#include "core/result/result.hpp"

namespace adit::bt {

/// A behaviour tree that runs. It has no thread, no clock and no lock: one strand ticks it and passes the
/// time. Its destructor does not notify the leaves; call halt() first if they must stop.
class Tree {
 public:
  Tree() = default;
  Tree(Tree&&) = default;
  Tree& operator=(Tree&&) = default;

  /// Runs one tick, as BehaviorTree.CPP's tickExactlyOnce: timers that are due, then the root. A root that
  /// completed is idle afterwards, and the next tick starts over. Never throws: a node that throws fails, and
  /// on_error is called. `now` must not go backwards.
  NodeStatus tick(Time now);
  /// Halts all running nodes; the tree is idle afterwards.
  void halt();

  /// Sets the listener for every status change of a node, during tick() and halt().
  void on_status(std::function<void(const TreeNode&, NodeStatus from, NodeStatus to)> listener);
  /// Sets the listener for every exception in a node, with its text.
  void on_error(std::function<void(const TreeNode&, std::string_view what)> listener);

  bool empty() const { return !root_; }
  /// ID of the loaded tree.
  const std::string& id() const { return id_; }
  /// The tree must not be empty().
  const TreeNode& root() const { return *root_; }
  /// The outermost blackboard. The tree must not be empty().
  Blackboard& blackboard() { return *boards_.front(); }
  /// Visits every node, parents before children, children in order, through SubTrees.
  void for_each(const std::function<void(const TreeNode&, std::size_t depth)>& visit) const;

 private:
  friend class TreeBuilder;
  std::unique_ptr<TickContext> context_{};
  std::vector<std::unique_ptr<Blackboard>> boards_{};
  std::unique_ptr<TreeNode> root_{};
  std::string id_{};
};

/// Loads a tree from an XML file in BehaviorTree.CPP v4's format, with its includes. `tree_id`: the tree to
/// run, else the file's main_tree_to_execute, else its only tree. The error's text is "file:line: what".
Result<Tree> load_tree_file(const Registry& registry, const std::string& path,
                            const std::string& tree_id = "");
/// Loads a tree from a text; `source` is the name shown in errors, and includes are relative to its folder.
Result<Tree> load_tree_text(const Registry& registry, std::string_view text,
                            const std::string& source = "<text>", const std::string& tree_id = "");
/// Checks a file and builds each of its trees; returns the IDs of the trees.
Result<std::vector<std::string>> check_tree_file(const Registry& registry, const std::string& path);

}  // namespace adit::bt
