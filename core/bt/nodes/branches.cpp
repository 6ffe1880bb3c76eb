// SPDX-License-Identifier: Apache-2.0
// IfThenElse and WhileDoElse: a condition and one or two branches.
#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

/// Ticks the condition until it completes, then runs one branch to its end.
class IfThenElse : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    set_status(NodeStatus::running);
    if (branch_ == 0) {
      const NodeStatus condition = tick_child(child(0));
      if (condition == NodeStatus::running) return NodeStatus::running;
      if (condition == NodeStatus::skipped) throw NodeError("the condition of IfThenElse was skipped");
      if (condition == NodeStatus::success) {
        branch_ = 1;
      } else if (child_count() == 3) {
        branch_ = 2;
      } else {
        return NodeStatus::failure;  // As in BehaviorTree.CPP, the condition keeps its status.
      }
    }
    const NodeStatus answer = tick_child(child(branch_));
    if (answer == NodeStatus::running) return NodeStatus::running;
    reset_children();
    branch_ = 0;
    return answer;
  }

  void halt() override {
    branch_ = 0;
    TreeNode::halt();
  }

 private:
  std::size_t branch_{0};
};

/// Ticks the condition in every tick; when its result changes, the running branch is halted.
class WhileDoElse : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    set_status(NodeStatus::running);
    const NodeStatus condition = tick_child(child(0));
    if (condition == NodeStatus::running) return NodeStatus::running;
    if (condition == NodeStatus::skipped) throw NodeError("the condition of WhileDoElse was skipped");
    const bool has_else = child_count() == 3;
    NodeStatus answer = NodeStatus::failure;
    if (condition == NodeStatus::success) {
      if (has_else) reset_child(2);
      answer = tick_child(child(1));
    } else if (has_else) {
      reset_child(1);
      answer = tick_child(child(2));
    }
    if (answer == NodeStatus::running) return NodeStatus::running;
    reset_children();
    return answer;
  }
};

}  // namespace

void add_branches(Registry& registry) {
  (void)registry.add(control<IfThenElse>("IfThenElse", {}, 2, 3));
  (void)registry.add(control<WhileDoElse>("WhileDoElse", {}, 2, 3));
}

}  // namespace adit::bt
