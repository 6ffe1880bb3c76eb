// SPDX-License-Identifier: Apache-2.0
// Delay, Timeout and Sleep: they use the time passed to each tick.
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

/// Returns RUNNING for the given time, then ticks its child.
class Delay : public Timed {
 public:
  using Timed::Timed;

 protected:
  NodeStatus tick() override {
    const auto wait = std::chrono::milliseconds(port<std::uint32_t>("delay_msec"));
    if (!started_) {
      started_ = true;
      over_ = false;
      set_status(NodeStatus::running);
      timer_ = context().timers.add(context().now + wait, [this] { over_ = true; });
    }
    if (!over_) return NodeStatus::running;
    const NodeStatus answer = tick_child(child());
    if (completed(answer)) {
      started_ = false;
      reset_child();
    }
    return answer;
  }

 private:
  bool over_{false};
};

/// Halts the child at the end of the given time; the next tick returns FAILURE. 0: no limit.
class Timeout : public Timed {
 public:
  using Timed::Timed;

 protected:
  NodeStatus tick() override {
    const auto limit = std::chrono::milliseconds(port<std::uint32_t>("msec"));
    if (!started_) {
      started_ = true;
      expired_ = false;
      set_status(NodeStatus::running);
      if (limit.count() > 0) timer_ = context().timers.add(context().now + limit, [this] { expire(); });
    }
    if (expired_) {
      started_ = false;
      return NodeStatus::failure;
    }
    const NodeStatus answer = tick_child(child());
    if (completed(answer)) {
      started_ = false;
      context().timers.cancel(timer_);
      reset_child();
    }
    return answer;
  }

 private:
  void expire() {
    if (child().status() != NodeStatus::running) return;
    expired_ = true;
    reset_child();
  }
  bool expired_{false};
};

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
