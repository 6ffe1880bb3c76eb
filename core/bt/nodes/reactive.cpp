// SPDX-License-Identifier: Apache-2.0
// ReactiveSequence and ReactiveFallback: every tick starts from the first child.
#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

template <NodeStatus go_on>
class Reactive : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    bool all_skipped = true;
    set_status(NodeStatus::running);
    for (std::size_t i = 0; i < child_count(); ++i) {
      const NodeStatus answer = tick_child(child(i));
      all_skipped = all_skipped && answer == NodeStatus::skipped;
      if (answer == NodeStatus::running) {
        // All other children are halted: at most one child runs, and the others start from the beginning next
        // time.
        for (std::size_t other = 0; other < child_count(); ++other) {
          if (other != i) reset_child(other);
        }
        return NodeStatus::running;
      }
      if (answer == NodeStatus::skipped) {
        reset_child(i);
      } else if (answer != go_on) {
        reset_children();
        return answer;
      }
    }
    reset_children();
    return all_skipped ? NodeStatus::skipped : go_on;
  }
};

}  // namespace

void add_reactive(Registry& registry) {
  (void)registry.add(control<Reactive<NodeStatus::success>>("ReactiveSequence"));
  (void)registry.add(control<Reactive<NodeStatus::failure>>("ReactiveFallback"));
}

}  // namespace adit::bt
