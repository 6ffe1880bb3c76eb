// SPDX-License-Identifier: Apache-2.0
// Script, ScriptCondition, Precondition.
#include "core/bt/nodes/builtin.hpp"

namespace adit::bt {

namespace {

/// The script of a port; it is parsed again only when its text changes.
class ScriptPort {
 public:
  const Script& of(const std::string& text) {
    if (!script_ || text != text_) {
      auto parsed = Script::parse(text);
      if (!parsed) throw NodeError(parsed.error().text);
      script_ = *parsed;
      text_ = text;
    }
    return *script_;
  }

 private:
  std::string text_{};
  std::shared_ptr<const Script> script_{};
};

class ScriptNode : public Leaf {
 public:
  using Leaf::Leaf;

 protected:
  NodeStatus tick() override {
    script_.of(port<std::string>("code")).run(board(), context().enums);
    return NodeStatus::success;
  }

 private:
  ScriptPort script_{};
};

class ScriptCondition : public Leaf {
 public:
  using Leaf::Leaf;

 protected:
  NodeStatus tick() override {
    const BlackboardValue answer = script_.of(port<std::string>("code")).run(board(), context().enums);
    return to_condition(answer) ? NodeStatus::success : NodeStatus::failure;
  }

 private:
  ScriptPort script_{};
};

/// Ticks the child if the script is true at the start; once the child runs, it continues to its end.
class Precondition : public TreeNode {
 public:
  using TreeNode::TreeNode;

 protected:
  NodeStatus tick() override {
    const NodeStatus otherwise = port<NodeStatus>("else");
    const Script& script = script_.of(port<std::string>("if"));
    if (!running_) running_ = to_condition(script.run(board(), context().enums));
    if (!running_) return otherwise;
    const NodeStatus answer = tick_child(child());
    if (completed(answer)) {
      reset_child();
      running_ = false;
    }
    return answer;
  }

 private:
  ScriptPort script_{};
  bool running_{false};  // As in BehaviorTree.CPP, a halt does not clear it.
};

}  // namespace

void add_scripted(Registry& registry) {
  (void)registry.add(leaf<ScriptNode>("Script", NodeKind::action, {required_input("code", PortType::text)}));
  (void)registry.add(leaf<ScriptCondition>("ScriptCondition", NodeKind::condition,
                                           {required_input("code", PortType::text)}));
  (void)registry.add(decorator<Precondition>(
      "Precondition", {required_input("if", PortType::text), input("else", PortType::status, "FAILURE")}));
}

}  // namespace adit::bt
