// SPDX-License-Identifier: Apache-2.0
#include "core/bt/leaf.hpp"

namespace adit::bt {

namespace {

class FunctionNode : public Leaf {
 public:
  FunctionNode(NodeConfig config, LeafFunction function)
      : Leaf(std::move(config)), function_(std::move(function)) {}

 protected:
  NodeStatus tick() override {
    const NodeStatus answer = function_(*this);
    if (answer == NodeStatus::running && kind() == NodeKind::action) {
      throw NodeError("a synchronous action must not answer RUNNING");
    }
    return answer;
  }

 private:
  LeafFunction function_;
};

class StatefulNode : public Leaf {
 public:
  StatefulNode(NodeConfig config, std::unique_ptr<StatefulLeaf> code)
      : Leaf(std::move(config)), code_(std::move(code)) {}

 protected:
  NodeStatus tick() override {
    switch (status()) {
      case NodeStatus::idle:
        return code_->on_start(*this);
      case NodeStatus::running:
        return code_->on_running(*this);
      default:
        // The leaf has completed and its parent has not reset it: its status remains, and its code does not
        // run again.
        return status();
    }
  }
  void halt() override {
    if (status() == NodeStatus::running) code_->on_halted(*this);
    reset_status();
  }

 private:
  std::unique_ptr<StatefulLeaf> code_;
};

}  // namespace

std::unique_ptr<TreeNode> make_function_leaf(NodeConfig config, LeafFunction function) {
  return std::make_unique<FunctionNode>(std::move(config), std::move(function));
}

std::unique_ptr<TreeNode> make_stateful_leaf(NodeConfig config, std::unique_ptr<StatefulLeaf> code) {
  return std::make_unique<StatefulNode>(std::move(config), std::move(code));
}

}  // namespace adit::bt
