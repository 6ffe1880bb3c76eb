// SPDX-License-Identifier: Apache-2.0
// TryCatch: a sequence whose last child cleans up when another one fails.
#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

class TryCatch : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    if (!active(status())) {
      skipped_ = 0;
      catching_ = false;
    }
    set_status(NodeStatus::running);
    while (!catching_ && index_ + 1 < child_count()) {
      const NodeStatus answer = tick_child(child(index_));
      if (answer == NodeStatus::running) return answer;
      if (answer == NodeStatus::failure) {
        reset_children();
        catching_ = true;
      } else {
        if (answer == NodeStatus::skipped) ++skipped_;
        ++index_;
      }
    }
    if (catching_) {
      if (tick_child(child(child_count() - 1)) == NodeStatus::running) return NodeStatus::running;
      reset_children();
      clear();
      return NodeStatus::failure;
    }
    const bool all_skipped = skipped_ + 1 == child_count();
    reset_children();
    clear();
    return all_skipped ? NodeStatus::skipped : NodeStatus::success;
  }

  void halt() override {
    if (!catching_ && active(status()) && port<bool>("catch_on_halt")) {
      const std::size_t last = child_count() - 1;
      for (std::size_t i = 0; i < last; ++i) reset_child(i);
      tick_child(child(last));
    }
    clear();
    TreeNode::halt();
  }

 private:
  void clear() {
    index_ = 0;
    skipped_ = 0;
    catching_ = false;
  }
  std::size_t index_{0};
  std::size_t skipped_{0};
  bool catching_{false};
};

}  // namespace

void add_try_catch(Registry& registry) {
  (void)registry.add(control<TryCatch>("TryCatch", {input("catch_on_halt", PortType::boolean, "false")}, 2));
}

}  // namespace adit::bt
