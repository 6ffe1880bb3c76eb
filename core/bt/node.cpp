// SPDX-License-Identifier: Apache-2.0
#include "core/bt/node.hpp"

namespace adit::bt {

std::string_view name(NodeKind kind) {
  switch (kind) {
    case NodeKind::action:
      return "Action";
    case NodeKind::condition:
      return "Condition";
    case NodeKind::control:
      return "Control";
    case NodeKind::decorator:
      return "Decorator";
    case NodeKind::subtree:
      return "SubTree";
  }
  return "Action";
}

std::optional<std::string> blackboard_key(std::string_view port, std::string_view text) {
  if (text == "{=}" || text == "=") return std::string(port);
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  if (text.size() < 3 || !text.starts_with('{') || !text.ends_with('}')) return std::nullopt;
  return std::string(text.substr(1, text.size() - 2));
}

NodeStatus TreeNode::execute_tick() {
  NodeStatus next = status_;
  try {
    const auto forced = check_preconditions();
    next = forced ? *forced : tick();
    if (next == NodeStatus::idle) throw NodeError("answered IDLE to a tick");
    if (next == NodeStatus::success) run_hook(Hook::on_success);
    if (next == NodeStatus::failure) run_hook(Hook::on_failure);
    if (completed(next)) run_hook(Hook::post);
  } catch (const std::exception& error) {
    next = fail(error.what());
  } catch (...) {
    next = fail("an exception of unknown type");
  }
  // A skipped node keeps its status; only its parent sees that it was skipped.
  if (next != NodeStatus::skipped) set_status(next);
  const bool wraps = kind() == NodeKind::decorator || kind() == NodeKind::subtree;
  if (wraps && completed(child().status_)) child().reset_status();
  return next;
}

NodeStatus TreeNode::fail(std::string_view what) {
  report(what);
  try {
    // A leaf that threw has stopped by itself; a node with children must not leave them running.
    if (!children_.empty()) halt();
  } catch (const std::exception& error) {
    report(error.what());
  }
  return NodeStatus::failure;
}

std::optional<NodeStatus> TreeNode::check_preconditions() {
  for (const Hook which : {Hook::failure_if, Hook::success_if, Hook::skip_if, Hook::while_true}) {
    const Script* script = hook(which);
    if (!script) continue;
    if (status_ == NodeStatus::idle) {
      const bool holds = to_condition(script->run(board(), context().enums));
      if (which == Hook::while_true) {
        if (!holds) return NodeStatus::skipped;
      } else if (holds) {
        if (which == Hook::failure_if) return NodeStatus::failure;
        if (which == Hook::success_if) return NodeStatus::success;
        return NodeStatus::skipped;
      }
    } else if (status_ == NodeStatus::running && which == Hook::while_true) {
      if (!to_condition(script->run(board(), context().enums))) {
        halt_node();
        return NodeStatus::skipped;
      }
    }
  }
  return std::nullopt;
}

void TreeNode::run_hook(Hook which) {
  if (const Script* script = hook(which)) script->run(board(), context().enums);
}

void TreeNode::halt_node() {
  try {
    halt();
    run_hook(Hook::on_halted);
  } catch (const std::exception& error) {
    report(std::string("while halted: ") + error.what());
  } catch (...) {
    report("while halted: an exception of unknown type");
  }
  reset_status();
}

void TreeNode::halt() {
  reset_children();
  reset_status();
}

void TreeNode::reset_child(std::size_t index) {
  TreeNode& node = child(index);
  if (node.status_ == NodeStatus::running) node.halt_node();
  node.reset_status();
}

void TreeNode::reset_children() {
  for (std::size_t i = 0; i < children_.size(); ++i) reset_child(i);
}

void TreeNode::reset_status() { set_status(NodeStatus::idle); }

void TreeNode::set_status(NodeStatus status) {
  const NodeStatus before = status_;
  status_ = status;
  if (before != status && context().on_status) context().on_status(*this, before, status);
}

BlackboardValue TreeNode::port_value(std::string_view port) const {
  const auto it = config_.ports.find(port);
  if (it == config_.ports.end()) throw NodeError("port [" + std::string(port) + "] is not given");
  const auto key = blackboard_key(port, it->second);
  if (!key) return BlackboardValue(it->second);
  const auto* entry = board().find(*key);
  if (!entry || is_empty(entry->value)) {
    throw NodeError("port [" + std::string(port) + "]: blackboard entry '" + *key + "' was never written");
  }
  return entry->value;
}

void TreeNode::write_port(std::string_view port, BlackboardValue value) const {
  const auto it = config_.ports.find(port);
  if (it == config_.ports.end()) throw NodeError("port [" + std::string(port) + "] is not given");
  const auto key = blackboard_key(port, it->second);
  if (!key) throw NodeError("port [" + std::string(port) + "] names no blackboard entry: write \"{key}\"");
  board().set(*key, std::move(value));
}

void TreeNode::report(std::string_view what) const {
  if (context().on_error) context().on_error(*this, what);
}

}  // namespace adit::bt
