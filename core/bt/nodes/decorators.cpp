// SPDX-License-Identifier: Apache-2.0
// Inverter, ForceSuccess, ForceFailure, KeepRunningUntilFailure, RunOnce, SubTree.
#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

class Inverter : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    set_status(NodeStatus::running);
    const NodeStatus answer = tick_child(child());
    if (!completed(answer)) return answer;
    reset_child();
    return answer == NodeStatus::success ? NodeStatus::failure : NodeStatus::success;
  }
};

template <NodeStatus forced>
class Force : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    set_status(NodeStatus::running);
    const NodeStatus answer = tick_child(child());
    if (!completed(answer)) return answer;
    reset_child();
    return forced;
  }
};

class KeepRunningUntilFailure : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    set_status(NodeStatus::running);
    const NodeStatus answer = tick_child(child());
    if (completed(answer)) reset_child();
    return answer == NodeStatus::failure ? NodeStatus::failure : NodeStatus::running;
  }
};

/// Ticks the child until it has completed once; even a halt does not start it again.
class RunOnce : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    const bool skip = port<bool>("then_skip");
    if (answer_) return skip ? NodeStatus::skipped : *answer_;
    set_status(NodeStatus::running);
    const NodeStatus answer = tick_child(child());
    if (completed(answer)) {
      answer_ = answer;
      reset_child();
    }
    return answer;
  }

 private:
  std::optional<NodeStatus> answer_{};
};

class SubTree : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    if (status() == NodeStatus::idle) set_status(NodeStatus::running);
    const NodeStatus answer = tick_child(child());
    if (completed(answer)) reset_child();
    return answer;
  }
};

}  // namespace

void add_decorators(Registry& registry) {
  (void)registry.add(decorator<Inverter>("Inverter"));
  (void)registry.add(decorator<Force<NodeStatus::success>>("ForceSuccess"));
  (void)registry.add(decorator<Force<NodeStatus::failure>>("ForceFailure"));
  (void)registry.add(decorator<KeepRunningUntilFailure>("KeepRunningUntilFailure"));
  (void)registry.add(decorator<RunOnce>("RunOnce", {input("then_skip", PortType::boolean, "true")}));
}

std::unique_ptr<TreeNode> make_subtree(NodeConfig config) {
  return std::make_unique<SubTree>(std::move(config));
}

}  // namespace adit::bt
