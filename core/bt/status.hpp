// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace adit::bt {

/// Status of a node, with the meaning of BehaviorTree.CPP v4. A node stores idle, running, success or
/// failure; skipped is only a result for the parent.
enum class NodeStatus : std::uint8_t { idle, running, success, failure, skipped };

/// Returns "IDLE", "RUNNING", "SUCCESS", "FAILURE" or "SKIPPED".
std::string_view name(NodeStatus status);
/// Returns the status of that (upper-case) name.
std::optional<NodeStatus> status_from_name(std::string_view text);

inline bool completed(NodeStatus s) { return s == NodeStatus::success || s == NodeStatus::failure; }
inline bool active(NodeStatus s) { return s != NodeStatus::idle && s != NodeStatus::skipped; }

/// Exception inside the engine when a node cannot do its work. The node that threw fails and the text is
/// reported; it never leaves Tree.
struct NodeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace adit::bt
