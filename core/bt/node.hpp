// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/bt/blackboard.hpp"
#include "core/bt/ports.hpp"
#include "core/bt/script/script.hpp"
#include "core/bt/status.hpp"
#include "core/bt/timers.hpp"

namespace adit::bt {

class TreeNode;

/// State that the nodes of one tree share.
struct TickContext {
  Time now{};  ///< Time of the current tick.
  Timers timers{};
  Enums enums{};
  std::function<void(const TreeNode&, NodeStatus from, NodeStatus to)> on_status{};
  std::function<void(const TreeNode&, std::string_view what)> on_error{};
};

enum class NodeKind : std::uint8_t { action, condition, control, decorator, subtree };
/// Returns "Action", "Condition", "Control", "Decorator" or "SubTree".
std::string_view name(NodeKind kind);

/// The attributes that hold scripts, in the order in which preconditions are checked.
enum class Hook : std::uint8_t {
  failure_if,
  success_if,
  skip_if,
  while_true,
  on_success,
  on_failure,
  on_halted,
  post
};
inline constexpr std::array<std::string_view, 8> kHookNames{"_failureIf", "_successIf", "_skipIf",   "_while",
                                                            "_onSuccess", "_onFailure", "_onHalted", "_post"};

/// Parameters from which a node is created.
struct NodeConfig {
  std::string id{};    ///< Kind of node, e.g. "Sequence"; for a SubTree, the tree that it runs.
  std::string name{};  ///< The name attribute, else the id.
  bool named{false};   ///< There is a name attribute.
  NodeKind kind{NodeKind::action};
  std::string path{};  ///< For example "main/seq/leaf": unique within the tree.
  std::string file{};
  int line{0};
  std::map<std::string, std::string, std::less<>> ports{};  ///< Text of each port, default values included.
  std::array<std::shared_ptr<const Script>, kHookNames.size()> hooks{};
  Blackboard* board{nullptr};
  TickContext* context{nullptr};
};

/// One node of a running tree. Only its tree ticks it; other code may only read it.
class TreeNode {
 public:
  explicit TreeNode(NodeConfig config) : config_(std::move(config)) {}
  virtual ~TreeNode() = default;
  TreeNode(const TreeNode&) = delete;
  TreeNode& operator=(const TreeNode&) = delete;

  const std::string& id() const { return config_.id; }
  const std::string& name() const { return config_.name; }
  bool named() const { return config_.named; }
  NodeKind kind() const { return config_.kind; }
  const NodeConfig& config() const { return config_; }
  NodeStatus status() const { return status_; }
  const std::vector<std::unique_ptr<TreeNode>>& children() const { return children_; }

 protected:
  friend class Tree;
  friend class TreeBuilder;

  /// Checks the preconditions, calls tick(), runs the postconditions and sets the new status. Any exception
  /// becomes FAILURE and is reported.
  NodeStatus execute_tick();
  /// Calls halt() and runs the _onHalted script; exceptions are reported.
  void halt_node();
  void reset_status();
  void set_status(NodeStatus status);

  virtual NodeStatus tick() = 0;
  /// Stops what is running and leaves the node idle. Control nodes and decorators halt their children.
  virtual void halt();

  TreeNode& child(std::size_t index = 0) { return *children_[index]; }
  std::size_t child_count() const { return children_.size(); }
  static NodeStatus tick_child(TreeNode& child) { return child.execute_tick(); }
  /// Halts the child if it is running, and leaves it idle in any case.
  void reset_child(std::size_t index = 0);
  void reset_children();

  /// Reads the value of a port. Throws NodeError when the port is not given or its entry is missing or empty.
  BlackboardValue port_value(std::string_view port) const;
  template <class T>
  T port(std::string_view port_name) const;
  /// Writes to the entry that the port names. Throws NodeError.
  void write_port(std::string_view port, BlackboardValue value) const;

  Blackboard& board() const { return *config_.board; }
  TickContext& context() const { return *config_.context; }
  void report(std::string_view what) const;

 private:
  std::optional<NodeStatus> check_preconditions();
  void run_hook(Hook hook);
  /// Reports an exception and cleans up; returns FAILURE.
  NodeStatus fail(std::string_view what);
  const Script* hook(Hook which) const { return config_.hooks[static_cast<std::size_t>(which)].get(); }

  NodeConfig config_;
  NodeStatus status_{NodeStatus::idle};
  std::vector<std::unique_ptr<TreeNode>> children_{};
};

template <class T>
T TreeNode::port(std::string_view port_name) const {
  const BlackboardValue value = port_value(port_name);
  try {
    return value_as<T>(value);
  } catch (const NodeError& error) {
    throw NodeError("port [" + std::string(port_name) + "]: " + error.what());
  }
}

}  // namespace adit::bt
