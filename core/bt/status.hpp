#pragma once
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace adit::bt {

/// What a node is doing, with the meaning of BehaviorTree.CPP v4. A node keeps idle, running, success or
/// failure; skipped is only ever an answer to the parent.
enum class NodeStatus : std::uint8_t { idle, running, success, failure, skipped };

/// "IDLE", "RUNNING", "SUCCESS", "FAILURE", "SKIPPED".
std::string_view name(NodeStatus status);
/// The status of that (upper-case) name.
std::optional<NodeStatus> status_from_name(std::string_view text);

inline bool completed(NodeStatus s) { return s == NodeStatus::success || s == NodeStatus::failure; }
inline bool active(NodeStatus s) { return s != NodeStatus::idle && s != NodeStatus::skipped; }

/// Thrown inside the engine when a node cannot do its work. The node that threw fails and the text is
/// reported; it never leaves Tree.
struct NodeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace adit::bt
