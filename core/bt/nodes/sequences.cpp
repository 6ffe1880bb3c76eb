// SPDX-License-Identifier: Apache-2.0
// Sequence, AsyncSequence, Fallback, AsyncFallback, SequenceWithMemory: children run one after another.
#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

/// Runs the next child while children return `go_on`; the first other result that completes ends the series.
class Series : public TreeNode {
 public:
  Series(NodeConfig config, NodeStatus go_on, bool yields)
      : TreeNode(std::move(config)), go_on_(go_on), yields_(yields) {}

 protected:
  NodeStatus tick() override {
    if (!active(status())) skipped_ = 0;
    set_status(NodeStatus::running);
    while (index_ < child_count()) {
      TreeNode& current = child(index_);
      const bool was_idle = current.status() == NodeStatus::idle;
      const NodeStatus answer = tick_child(current);
      if (answer == NodeStatus::running) return NodeStatus::running;
      if (answer == NodeStatus::skipped) {
        ++index_;
        ++skipped_;
      } else if (answer == go_on_) {
        ++index_;
        // After a child that completed in one tick, the node yields so that a reactive parent can interrupt.
        if (yields_ && was_idle && index_ < child_count()) return NodeStatus::running;
      } else {
        stop();
        return answer;
      }
    }
    const bool all_skipped = skipped_ == child_count();
    reset_children();
    index_ = 0;
    skipped_ = 0;
    return all_skipped ? NodeStatus::skipped : go_on_;
  }

  void halt() override {
    forget();
    TreeNode::halt();
  }

  /// Called when a child ended the series.
  virtual void stop() {
    reset_children();
    index_ = 0;
  }
  virtual void forget() {
    index_ = 0;
    skipped_ = 0;
  }
  std::size_t index() const { return index_; }

 private:
  NodeStatus go_on_;
  bool yields_;
  std::size_t index_{0};
  std::size_t skipped_{0};
};

template <NodeStatus go_on, bool yields>
struct Plain : Series {
  explicit Plain(NodeConfig config) : Series(std::move(config), go_on, yields) {}
};

/// Resumes at the same child after a FAILURE or a halt: children that succeeded are not ticked again.
struct SequenceWithMemory : Series {
  explicit SequenceWithMemory(NodeConfig config) : Series(std::move(config), NodeStatus::success, true) {}
  void stop() override {
    for (std::size_t i = index(); i < child_count(); ++i) reset_child(i);
  }
  void forget() override {}
};

}  // namespace

void add_sequences(Registry& registry) {
  (void)registry.add(control<Plain<NodeStatus::success, false>>("Sequence"));
  (void)registry.add(control<Plain<NodeStatus::success, true>>("AsyncSequence"));
  (void)registry.add(control<Plain<NodeStatus::failure, false>>("Fallback"));
  (void)registry.add(control<Plain<NodeStatus::failure, true>>("AsyncFallback"));
  (void)registry.add(control<SequenceWithMemory>("SequenceWithMemory"));
}

}  // namespace adit::bt
