// SPDX-License-Identifier: Apache-2.0
// The nodes with a timer: Delay, Timeout and Sleep. Their clock is the time that is passed to each tick.
#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

/// A decorator with a timer that runs from its first tick until it completes or is halted.
class Timed : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  void halt() override {
    started_ = false;
    context().timers.cancel(timer_);
    TreeNode::halt();
  }

  bool started_{false};
  Timers::Id timer_{0};
};

/// Returns RUNNING for the given time after its first tick, then ticks its child and returns its status.
class Delay : public Timed {
 public:
  using Timed::Timed;

 protected:
  NodeStatus tick() override {
    const auto wait = std::chrono::milliseconds(port<std::uint32_t>("delay_msec"));
    if (!started_) {
      started_ = true;
      delay_elapsed_ = false;
      set_status(NodeStatus::running);  // Observers see RUNNING before the child is ticked.
      timer_ = context().timers.add(context().now + wait, [this] { delay_elapsed_ = true; });
    }
    if (!delay_elapsed_) return NodeStatus::running;
    const NodeStatus child_status = tick_child(child());
    if (completed(child_status)) {
      started_ = false;
      reset_child();
    }
    return child_status;
  }

 private:
  bool delay_elapsed_{false};
};

/// Ticks its child and returns its status. If the child is still running at the end of the given time, it is
/// halted, and the next tick returns FAILURE. A time of 0 means that there is no limit.
class Timeout : public Timed {
 public:
  using Timed::Timed;

 protected:
  NodeStatus tick() override {
    const auto limit = std::chrono::milliseconds(port<std::uint32_t>("msec"));
    if (!started_) {
      started_ = true;
      expired_ = false;
      set_status(NodeStatus::running);  // Observers see RUNNING before the child is ticked.
      if (limit.count() > 0) timer_ = context().timers.add(context().now + limit, [this] { expire(); });
    }
    if (expired_) {
      started_ = false;
      return NodeStatus::failure;
    }
    const NodeStatus child_status = tick_child(child());
    if (completed(child_status)) {
      started_ = false;
      context().timers.cancel(timer_);
      reset_child();
    }
    return child_status;
  }

 private:
  void expire() {
    if (child().status() != NodeStatus::running) return;
    expired_ = true;
    reset_child();
  }
  bool expired_{false};
};

/// Returns RUNNING for the given time after its first tick, then SUCCESS.
class Sleep : public Leaf {
 public:
  using Leaf::Leaf;

 protected:
  NodeStatus tick() override {
    if (status() == NodeStatus::running) return waiting_ ? NodeStatus::running : NodeStatus::success;
    if (status() != NodeStatus::idle) return status();
    const auto wait = std::chrono::milliseconds(port<std::uint32_t>("msec"));
    if (wait.count() == 0) return NodeStatus::success;
    waiting_ = true;
    timer_ = context().timers.add(context().now + wait, [this] { waiting_ = false; });
    return NodeStatus::running;
  }

  void halt() override {
    context().timers.cancel(timer_);
    reset_status();
  }

 private:
  bool waiting_{false};
  Timers::Id timer_{0};
};

}  // namespace

void add_timed(Registry& registry) {
  (void)registry.add(decorator<Delay>("Delay", {required_input("delay_msec", PortType::natural)}));
  (void)registry.add(decorator<Timeout>("Timeout", {required_input("msec", PortType::natural)}));
  (void)registry.add(leaf<Sleep>("Sleep", NodeKind::action, {required_input("msec", PortType::natural)}));
}

}  // namespace adit::bt
