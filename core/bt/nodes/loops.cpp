// SPDX-License-Identifier: Apache-2.0
// Repeat and RetryUntilSuccessful.
#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

/// Repeats the child while it returns `again`, at most as often as the port says (-1: without limit).
class Loop : public TreeNode {
 public:
  Loop(NodeConfig config, NodeStatus again, std::string port_name)
      : TreeNode(std::move(config)), again_(again), port_(std::move(port_name)) {}

 protected:
  NodeStatus tick() override {
    int limit = port<int>(port_);
    bool more = count_ < limit || limit == -1;
    set_status(NodeStatus::running);
    while (more) {
      const bool was_idle = child().status() == NodeStatus::idle;
      const NodeStatus answer = tick_child(child());
      if (answer == NodeStatus::running) return answer;
      reset_child();
      if (answer == NodeStatus::skipped) return answer;  // A skipped child does not count.
      if (answer != again_) {
        count_ = 0;
        return answer;
      }
      ++count_;
      // A retry reads its limit again, as the child may have changed it.
      if (again_ == NodeStatus::failure) limit = port<int>(port_);
      more = count_ < limit || limit == -1;
      // After a child that completed in one tick, the loop yields so that a reactive parent can interrupt.
      if (was_idle && more) return NodeStatus::running;
    }
    count_ = 0;
    return again_;
  }

  void halt() override {
    count_ = 0;
    TreeNode::halt();
  }

 private:
  NodeStatus again_;
  std::string port_;
  int count_{0};
};

struct Repeat : Loop {
  explicit Repeat(NodeConfig config) : Loop(std::move(config), NodeStatus::success, "num_cycles") {}
};
struct Retry : Loop {
  explicit Retry(NodeConfig config) : Loop(std::move(config), NodeStatus::failure, "num_attempts") {}
};

}  // namespace

void add_loops(Registry& registry) {
  (void)registry.add(decorator<Repeat>("Repeat", {required_input("num_cycles", PortType::integer)}));
  (void)registry.add(
      decorator<Retry>("RetryUntilSuccessful", {required_input("num_attempts", PortType::integer)}));
}

}  // namespace adit::bt
