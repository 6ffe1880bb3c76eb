#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/bt/node.hpp"

namespace adit::bt {

/// What a leaf's code sees of its node while it runs.
class Leaf : public TreeNode {
 public:
  using TreeNode::TreeNode;

  /// Time of the tick, by the clock handed to Tree::tick.
  Time now() const { return context().now; }
  /// What the port holds, converted; Reason::bad_argument when it is missing or has another type.
  template <class T>
  Result<T> input(std::string_view port_name) const {
    try {
      return port<T>(port_name);
    } catch (const NodeError& error) {
      return Error{Reason::bad_argument, name() + ": " + error.what()};
    }
  }
  /// Writes to the blackboard entry that the port names; Reason::bad_argument when it names none.
  template <class T>
  Result<void> output(std::string_view port_name, T content) const {
    try {
      write_port(port_name, make_value(std::move(content)));
      return {};
    } catch (const NodeError& error) {
      return Error{Reason::bad_argument, name() + ": " + error.what()};
    }
  }

 protected:
  // Only leaves that remember something between ticks have something to stop.
  void halt() override { reset_status(); }
};

/// A leaf that answers at once. An action must not answer RUNNING; a condition may.
using LeafFunction = std::function<NodeStatus(Leaf&)>;

/// The code of a leaf that takes several ticks. One object per node, made with the tree.
class StatefulLeaf {
 public:
  virtual ~StatefulLeaf() = default;
  /// The first tick from idle.
  virtual NodeStatus on_start(Leaf& leaf) = 0;
  /// Every tick while RUNNING.
  virtual NodeStatus on_running(Leaf& leaf) = 0;
  /// Halted while RUNNING.
  virtual void on_halted(Leaf& leaf) = 0;
};
using StatefulFactory = std::function<std::unique_ptr<StatefulLeaf>(const NodeConfig&)>;

/// The node of a leaf function.
std::unique_ptr<TreeNode> make_function_leaf(NodeConfig config, LeafFunction function);
/// The node of a stateful leaf, with the rules of BehaviorTree.CPP's StatefulActionNode.
std::unique_ptr<TreeNode> make_stateful_leaf(NodeConfig config, std::unique_ptr<StatefulLeaf> code);

}  // namespace adit::bt
