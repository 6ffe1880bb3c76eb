// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/bt/node.hpp"

namespace adit::bt {

/// A leaf node, as its code sees it while it runs.
class Leaf : public TreeNode {
 public:
  using TreeNode::TreeNode;

  /// Time of the tick, by the clock passed to Tree::tick.
  Time now() const { return context().now; }
  /// Reads the value of a port, converted to T. Error bad_argument when it is missing or has another type.
  template <class T>
  Result<T> input(std::string_view port_name) const {
    try {
      return port<T>(port_name);
    } catch (const NodeError& error) {
      return Error{Reason::bad_argument, name() + ": " + error.what()};
    }
  }
  /// Writes to the blackboard entry that the port names. Error bad_argument when it names none.
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
  // Function leaves have no state between ticks; only stateful leaves must stop something.
  void halt() override { reset_status(); }
};

/// Function of a leaf that completes in one tick. An action must not return RUNNING; a condition may.
using LeafFunction = std::function<NodeStatus(Leaf&)>;

/// Code of a leaf that takes several ticks. Each node has its own object, created with the tree.
class StatefulLeaf {
 public:
  virtual ~StatefulLeaf() = default;
  /// Called in the first tick from idle.
  virtual NodeStatus on_start(Leaf& leaf) = 0;
  /// Called in every tick while RUNNING.
  virtual NodeStatus on_running(Leaf& leaf) = 0;
  /// Called when the leaf is halted while RUNNING.
  virtual void on_halted(Leaf& leaf) = 0;
};
using StatefulFactory = std::function<std::unique_ptr<StatefulLeaf>(const NodeConfig&)>;

/// Creates the node of a leaf function.
std::unique_ptr<TreeNode> make_function_leaf(NodeConfig config, LeafFunction function);
/// Creates the node of a stateful leaf, with the rules of BehaviorTree.CPP's StatefulActionNode.
std::unique_ptr<TreeNode> make_stateful_leaf(NodeConfig config, std::unique_ptr<StatefulLeaf> code);

}  // namespace adit::bt
