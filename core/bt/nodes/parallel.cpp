// SPDX-License-Identifier: Apache-2.0
// Parallel and ParallelAll: tick all children in every tick.
#include <algorithm>
#include <vector>

#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

/// Resolves a threshold. A negative one counts from the number of children: -1 means all.
std::size_t resolve(int threshold, std::size_t children) {
  if (threshold >= 0) return static_cast<std::size_t>(threshold);
  return static_cast<std::size_t>(std::max(static_cast<int>(children) + threshold + 1, 0));
}

class Parallel : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    const int wanted = port<int>("success_count");
    const std::size_t count = child_count();
    const std::size_t to_succeed = resolve(wanted, count);
    const std::size_t to_fail = resolve(port<int>("failure_count"), count);
    if (count < to_succeed) throw NodeError("fewer children than success_count: it can never succeed");
    if (count < to_fail) throw NodeError("fewer children than failure_count: it can never fail");

    done_.resize(count, false);
    set_status(NodeStatus::running);
    std::size_t skipped = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!done_[i]) {
        const NodeStatus answer = tick_child(child(i));
        if (answer == NodeStatus::skipped) ++skipped;
        if (completed(answer)) {
          done_[i] = true;
          ++(answer == NodeStatus::success ? successes_ : failures_);
        }
      }
      // Checked after each child; the later children are then not ticked.
      if (successes_ >= to_succeed || (wanted < 0 && successes_ + skipped >= to_succeed)) {
        return finish(NodeStatus::success);
      }
      if (count - failures_ < to_succeed || failures_ == to_fail) return finish(NodeStatus::failure);
    }
    return skipped == count ? NodeStatus::skipped : NodeStatus::running;
  }

  void halt() override {
    clear();
    TreeNode::halt();
  }

 private:
  NodeStatus finish(NodeStatus answer) {
    clear();
    reset_children();
    return answer;
  }
  void clear() {
    done_.assign(child_count(), false);
    successes_ = 0;
    failures_ = 0;
  }
  std::vector<bool> done_{};
  std::size_t successes_{0};
  std::size_t failures_{0};
};

/// Ticks all children until every one has completed.
class ParallelAll : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    const std::size_t count = child_count();
    const std::size_t to_fail = resolve(port<int>("max_failures"), count);
    if (count < to_fail) throw NodeError("fewer children than max_failures: it can never fail");
    done_.resize(count, false);
    set_status(NodeStatus::running);
    std::size_t skipped = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (done_[i]) continue;
      const NodeStatus answer = tick_child(child(i));
      if (answer == NodeStatus::skipped) ++skipped;
      if (answer == NodeStatus::failure) ++failures_;
      if (completed(answer)) done_[i] = true;
    }
    if (skipped == count) return NodeStatus::skipped;
    const auto finished = static_cast<std::size_t>(std::count(done_.begin(), done_.end(), true));
    if (skipped + finished < count) return NodeStatus::running;
    const bool failed = failures_ >= to_fail;
    reset_children();
    clear();
    return failed ? NodeStatus::failure : NodeStatus::success;
  }

  void halt() override {
    clear();
    TreeNode::halt();
  }

 private:
  void clear() {
    done_.assign(child_count(), false);
    failures_ = 0;
  }
  std::vector<bool> done_{};
  std::size_t failures_{0};
};

}  // namespace

void add_parallel(Registry& registry) {
  (void)registry.add(control<Parallel>("Parallel", {input("success_count", PortType::integer, "-1"),
                                                    input("failure_count", PortType::integer, "1")}));
  (void)registry.add(control<ParallelAll>("ParallelAll", {input("max_failures", PortType::integer, "1")}));
}

}  // namespace adit::bt
