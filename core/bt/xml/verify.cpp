// SPDX-License-Identifier: Apache-2.0
#include "core/bt/xml/verify.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>

#include "core/bt/nodes/builtin.hpp"

namespace adit::bt::xml {

namespace {

/// Nodes of BehaviorTree.CPP 4.10 that are not implemented here.
constexpr std::array<std::string_view, 9> kNotImplemented{
    "LoopInt",           "LoopBool",        "LoopDouble",     "LoopString", "WasEntryUpdated",
    "SkipUnlessUpdated", "WaitValueUpdate", "ManualSelector", "SubTreePlus"};

NodeKind kind_from_tag(std::string_view tag, bool& explicit_form) {
  explicit_form = true;
  for (const auto kind :
       {NodeKind::action, NodeKind::condition, NodeKind::control, NodeKind::decorator, NodeKind::subtree}) {
    if (tag == name(kind)) return kind;
  }
  explicit_form = false;
  return NodeKind::action;
}

std::string plural(std::size_t n) { return std::to_string(n) + (n == 1 ? " child" : " children"); }

class Verifier {
 public:
  Verifier(const Forest& forest, const Registry& registry) : forest_(forest), registry_(registry) {}

  void run() const {
    for (const auto& id : forest_.order) {
      const Element& tree = forest_.trees.at(id);
      if (registry_.find(id)) fail(tree, "a tree cannot have the ID '" + id + "': a node has it");
      if (tree.children.size() != 1) {
        fail(tree, "<BehaviorTree ID=\"" + id + "\"> must have exactly 1 child, it has " +
                       std::to_string(tree.children.size()));
      }
      check(tree.children.front());
    }
  }

 private:
  void check(const Element& element) const {
    const Kind kind = kind_of(element, registry_);
    check_children(element, kind);
    check_hooks(element);
    if (kind.kind == NodeKind::subtree) {
      if (const auto* remap = element.attribute("_autoremap");
          remap && !readable_as(*remap, PortType::boolean)) {
        fail(element, "[_autoremap] is '" + *remap + "', expected true or false", Reason::wrong_type);
      }
    } else if (!kind.manifest) {
      if (forest_.trees.contains(kind.id)) {
        fail(element, "'" + kind.id + "' is a tree: write <SubTree ID=\"" + kind.id + "\"/>");
      }
    } else {
      check_ports(element, kind);
    }
    for (const auto& child : element.children) check(child);
  }

  void check_children(const Element& element, const Kind& kind) const {
    const std::size_t count = element.children.size();
    const std::string who =
        kind.kind == NodeKind::subtree ? "<SubTree ID=\"" + kind.id + "\">" : "'" + kind.id + "'";
    const std::size_t min_children = kind.manifest ? kind.manifest->min_children : 0;
    const std::size_t max_children = kind.manifest ? kind.manifest->max_children : 0;
    const std::string has = ", it has " + std::to_string(count);
    if (max_children == 0 && count > 0 && !kind.manifest && kind.kind != NodeKind::subtree) {
      fail(element, "unknown node " + who + " with children: only leaves may be unknown");
    }
    if (max_children == 0 && count > 0) fail(element, who + " must not have children" + has);
    if (count >= min_children && count <= max_children) {
      if (kind.id == "ReactiveSequence") check_reactive(element);
      return;
    }
    if (min_children == max_children) fail(element, who + " must have exactly " + plural(min_children) + has);
    if (count < min_children) fail(element, who + " must have at least " + plural(min_children) + has);
    fail(element, who + " must have at most " + plural(max_children) + has);
  }

  void check_reactive(const Element& element) const {
    const auto async = std::count_if(element.children.begin(), element.children.end(),
                                     [](const Element& e) { return e.tag == "AsyncSequence"; });
    if (async > 1) fail(element, "'ReactiveSequence' must not have more than one AsyncSequence as child");
  }

  void check_hooks(const Element& element) const {
    for (const auto hook : kHookNames) {
      if (const auto* text = element.attribute(hook)) check_script(element, std::string(hook), *text);
    }
  }

  void check_script(const Element& element, const std::string& where, const std::string& text) const {
    const auto script = Script::parse(text);
    if (!script) fail(element, "[" + where + "] " + script.error().text);
  }

  void check_ports(const Element& element, const Kind& kind) const {
    const Ports& ports = kind.manifest->ports;
    for (const auto& attribute : element.attributes) {
      if (!is_port_name(attribute.name)) continue;
      const auto it =
          std::find_if(ports.begin(), ports.end(), [&](const Port& p) { return p.name == attribute.name; });
      if (it == ports.end()) {
        std::string known;
        for (const auto& port : ports)
          known += (known.empty() ? ", it has " : ", ") + ("[" + port.name + "]");
        fail(element, "'" + kind.id + "' has no port [" + attribute.name + "]" + known, Reason::unknown_key);
      }
      if (!blackboard_key(it->name, attribute.value) && !readable_as(attribute.value, it->type)) {
        fail(element,
             "port [" + it->name + "] is '" + attribute.value + "', expected " +
                 std::string(describe(it->type)),
             Reason::wrong_type);
      }
    }
    for (const auto& port : ports) {
      if (port.required && !element.attribute(port.name)) {
        fail(element, "'" + kind.id + "' needs the port [" + port.name + "]", Reason::missing_key);
      }
    }
    if (kind.id == "Script" || kind.id == "ScriptCondition") check_script_port(element, "code");
    if (kind.id == "Precondition") check_script_port(element, "if");
    if (kind.id == "Parallel") {
      check_threshold(element, "success_count");
      check_threshold(element, "failure_count");
    }
    if (kind.id == "ParallelAll") check_threshold(element, "max_failures");
  }

  void check_script_port(const Element& element, const std::string& port) const {
    const std::string& text = *element.attribute(port);
    if (!blackboard_key(port, text)) check_script(element, port, text);
  }

  void check_threshold(const Element& element, const std::string& port) const {
    const auto* text = element.attribute(port);
    if (!text || blackboard_key(port, *text)) return;
    if (std::atoll(text->c_str()) > static_cast<long long>(element.children.size())) {
      fail(element, "[" + port + "] is " + *text + ", more than the " + plural(element.children.size()),
           Reason::out_of_range);
    }
  }

  const Forest& forest_;
  const Registry& registry_;
};

}  // namespace

bool is_port_name(std::string_view attribute) {
  return attribute != "ID" && attribute != "name" && !attribute.empty() && attribute.front() != '_';
}

Kind kind_of(const Element& element, const Registry& registry) {
  bool explicit_form = false;
  Kind kind;
  kind.kind = kind_from_tag(element.tag, explicit_form);
  const auto* id = element.attribute("ID");
  if (explicit_form && (!id || id->empty())) {
    fail(element, "<" + element.tag + "> needs the attribute [ID]", Reason::missing_key);
  }
  if (!explicit_form && id) fail(element, "the attribute [ID] is not allowed in <" + element.tag + ">");
  kind.id = explicit_form ? *id : element.tag;
  if (kind.kind == NodeKind::subtree) {
    if (registry.find(kind.id)) fail(element, "[ID] of <SubTree> is '" + kind.id + "', which is a node");
    return kind;
  }
  kind.manifest = registry.find(kind.id);
  if (kind.manifest) {
    kind.kind = kind.manifest->kind;
    return kind;
  }
  if (std::find(kNotImplemented.begin(), kNotImplemented.end(), kind.id) != kNotImplemented.end()) {
    fail(element, "node '" + kind.id + "' of BehaviorTree.CPP is not supported", Reason::not_supported);
  }
  const bool is_leaf = kind.kind == NodeKind::action || kind.kind == NodeKind::condition;
  if (!is_leaf)
    fail(element,
         "unknown " + std::string(name(kind.kind)) + " '" + kind.id + "': only leaves may be unknown");
  if (!registry.unknown_leaves()) fail(element, "unknown node '" + kind.id + "'");
  return kind;
}

void verify(const Forest& forest, const Registry& registry) { Verifier(forest, registry).run(); }

}  // namespace adit::bt::xml
