// SPDX-License-Identifier: Apache-2.0
#include "core/bt/tree.hpp"

namespace adit::bt {

NodeStatus Tree::tick(Time now) {
  if (!root_) return NodeStatus::failure;
  context_->now = now;
  context_->timers.expire(now);
  const NodeStatus answer = root_->execute_tick();
  if (completed(answer)) root_->reset_status();
  return answer;
}

void Tree::halt() {
  if (!root_) return;
  root_->halt_node();
  // halt() reaches running nodes only; this also resets nodes that completed below an idle one.
  const std::function<void(TreeNode&)> settle = [&](TreeNode& node) {
    for (const auto& child : node.children_) {
      if (child->status_ == NodeStatus::running) child->halt_node();
      child->reset_status();
      settle(*child);
    }
  };
  settle(*root_);
}

void Tree::on_status(std::function<void(const TreeNode&, NodeStatus, NodeStatus)> listener) {
  if (context_) context_->on_status = std::move(listener);
}

void Tree::on_error(std::function<void(const TreeNode&, std::string_view)> listener) {
  if (context_) context_->on_error = std::move(listener);
}

void Tree::for_each(const std::function<void(const TreeNode&, std::size_t)>& visit) const {
  const std::function<void(const TreeNode&, std::size_t)> walk = [&](const TreeNode& node,
                                                                     std::size_t depth) {
    visit(node, depth);
    for (const auto& child : node.children()) walk(*child, depth + 1);
  };
  if (root_) walk(*root_, 0);
}

}  // namespace adit::bt
