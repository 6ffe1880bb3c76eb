// SPDX-License-Identifier: Apache-2.0
// AlwaysSuccess, AlwaysFailure, SetBlackboard, UnsetBlackboard.
#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

template <NodeStatus answer>
class Always : public Leaf {
 public:
  using Leaf::Leaf;

 protected:
  NodeStatus tick() override { return answer; }
};

/// Writes a text, or a copy of another entry, to the entry whose name is the value of the port `output_key`.
class SetBlackboard : public Leaf {
 public:
  using Leaf::Leaf;

 protected:
  NodeStatus tick() override {
    // As in BehaviorTree.CPP, output_key="{k}" writes to the entry whose name is in entry k.
    const std::string key = port<std::string>("output_key");
    const std::string& text = config().ports.find("value")->second;
    const auto source = blackboard_key("value", text);
    BlackboardValue value(text);
    if (source) {
      const auto* entry = board().find(*source);
      if (!entry) throw NodeError("port [value]: no blackboard entry '" + *source + "'");
      if (is_empty(entry->value)) return NodeStatus::failure;
      value = entry->value;
    }
    if (auto* entry = board().find(key); entry && is_number(entry->value) && is_text(value)) {
      value = BlackboardValue(to_real(value));
      copy_into(value, entry->value);
    } else {
      board().set(key, std::move(value));
    }
    return NodeStatus::success;
  }
};

class UnsetBlackboard : public Leaf {
 public:
  using Leaf::Leaf;

 protected:
  NodeStatus tick() override {
    board().unset(port<std::string>("key"));
    return NodeStatus::success;
  }
};

}  // namespace

void add_actions(Registry& registry) {
  (void)registry.add(leaf<Always<NodeStatus::success>>("AlwaysSuccess", NodeKind::action));
  (void)registry.add(leaf<Always<NodeStatus::failure>>("AlwaysFailure", NodeKind::action));
  Port output_key = inout("output_key");
  output_key.required = true;
  (void)registry.add(
      leaf<SetBlackboard>("SetBlackboard", NodeKind::action, {required_input("value"), output_key}));
  (void)registry.add(
      leaf<UnsetBlackboard>("UnsetBlackboard", NodeKind::action, {required_input("key", PortType::text)}));
}

}  // namespace adit::bt
