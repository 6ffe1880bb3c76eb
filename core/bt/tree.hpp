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

/// A behaviour tree that runs. It has no thread, no clock and no lock: one strand ticks it and hands it the
/// time. Leaves are not told of its destruction; halt() first if they must stop.
class Tree {
 public:
  Tree() = default;
  Tree(Tree&&) = default;
  Tree& operator=(Tree&&) = default;

  /// One tick, as BehaviorTree.CPP's tickExactlyOnce: timers that are due, then the root. When the root
  /// completed it is idle afterwards and the next tick starts over. Never throws: a node that throws fails,
  /// and on_error hears of it. `now` must not go backwards.
  NodeStatus tick(Time now);
  /// Halts whatever is running; the tree is idle afterwards.
  void halt();

  /// Hears of every change of a node's status, during tick() and halt().
  void on_status(std::function<void(const TreeNode&, NodeStatus from, NodeStatus to)> listener);
  /// Hears of every exception in a node, with its text.
  void on_error(std::function<void(const TreeNode&, std::string_view what)> listener);

  bool empty() const { return !root_; }
  /// The ID of the tree that was loaded.
  const std::string& id() const { return id_; }
  /// Must not be empty().
  const TreeNode& root() const { return *root_; }
  /// The outermost blackboard. Must not be empty().
  Blackboard& blackboard() { return *boards_.front(); }
  /// Every node, parents before children, children in order, through SubTrees.
  void for_each(const std::function<void(const TreeNode&, std::size_t depth)>& visit) const;

 private:
  friend class TreeBuilder;
  std::unique_ptr<TickContext> context_{};
  std::vector<std::unique_ptr<Blackboard>> boards_{};
  std::unique_ptr<TreeNode> root_{};
  std::string id_{};
};

/// Loads a tree from an XML file in BehaviorTree.CPP v4's format, with its includes. `tree_id`: which tree to
/// run, else the file's main_tree_to_execute, else its only tree. The error's text is "file:line: what".
Result<Tree> load_tree_file(const Registry& registry, const std::string& path,
                            const std::string& tree_id = "");
/// The same from a text; `source` is the name that errors give, and includes are relative to its folder.
Result<Tree> load_tree_text(const Registry& registry, std::string_view text,
                            const std::string& source = "<text>", const std::string& tree_id = "");
/// Checks a file and builds each of its trees; the trees' IDs.
Result<std::vector<std::string>> check_tree_file(const Registry& registry, const std::string& path);

}  // namespace adit::bt
