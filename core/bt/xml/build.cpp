// SPDX-License-Identifier: Apache-2.0
#include "core/bt/xml/build.hpp"

#include <algorithm>

#include "core/bt/nodes/builtin.hpp"
#include "core/bt/xml/verify.hpp"

namespace adit::bt {

namespace {
constexpr std::size_t kMaxNodes = 20'000;
constexpr std::size_t kMaxDepth = 500;
}  // namespace

using xml::Element;
using xml::fail;

Tree TreeBuilder::build(const std::string& tree_id) {
  tree_ = Tree();
  tree_.context_ = std::make_unique<TickContext>();
  tree_.context_->enums = registry_.enums();
  tree_.id_ = tree_id;
  tree_.boards_.push_back(std::make_unique<Blackboard>());
  open_ = {tree_id};
  tree_.root_ = make(forest_.trees.at(tree_id).children.front(), *tree_.boards_.front(), "");
  return std::move(tree_);
}

std::unique_ptr<TreeNode> TreeBuilder::make(const Element& element, Blackboard& board,
                                            const std::string& prefix) {
  if (++count_ > kMaxNodes) fail(element, "the tree has more than 20000 nodes", Reason::out_of_range);
  if (++depth_ > kMaxDepth) fail(element, "the tree is more than 500 levels deep", Reason::out_of_range);
  const xml::Kind kind = xml::kind_of(element, registry_);
  NodeConfig config;
  config.id = kind.id;
  config.kind = kind.kind;
  const auto* name = element.attribute("name");
  config.named = name != nullptr;
  config.name = name ? *name : kind.id;
  config.path = prefix + config.name + (name ? "" : "::" + std::to_string(count_));
  config.file = *element.file;
  config.line = element.line;
  config.board = &board;
  config.context = tree_.context_.get();
  for (std::size_t i = 0; i < kHookNames.size(); ++i) {
    if (const auto* text = element.attribute(kHookNames[i])) {
      auto script = Script::parse(*text);
      if (!script) fail(element, script.error().text);
      config.hooks[i] = *script;
    }
  }
  fill_ports(config, element, kind.manifest);

  std::unique_ptr<TreeNode> node;
  const std::string path = config.path;
  if (kind.kind == NodeKind::subtree) {
    node = make_subtree(std::move(config));
    fill_subtree(*node, element, board, path + "/");
  } else {
    if (kind.manifest) {
      node = kind.manifest->make(std::move(config));
    } else {
      auto code = registry_.unknown_leaves()(config);
      node = make_stateful_leaf(std::move(config), std::move(code));
    }
    for (const auto& child : element.children) node->children_.push_back(make(child, board, prefix));
  }
  --depth_;
  return node;
}

void TreeBuilder::fill_ports(NodeConfig& config, const Element& element, const Manifest* manifest) const {
  for (const auto& attribute : element.attributes) {
    if (xml::is_port_name(attribute.name)) config.ports.emplace(attribute.name, attribute.value);
  }
  if (!manifest) return;
  for (const auto& port : manifest->ports) {
    const auto it = config.ports.find(port.name);
    if (it != config.ports.end()) {
      // Entries that ports name exist from the start, empty and typed, so that scripts can assign to them.
      if (const auto key = blackboard_key(port.name, it->second)) config.board->declare(*key, port.type);
    } else if (port.fallback) {
      config.ports.emplace(port.name, *port.fallback);
    }
  }
}

void TreeBuilder::fill_subtree(TreeNode& node, const Element& element, Blackboard& outer,
                               const std::string& prefix) {
  const std::string& id = node.id();
  const auto tree = forest_.trees.find(id);
  if (tree == forest_.trees.end()) fail(element, "no tree with ID '" + id + "'");
  if (std::find(open_.begin(), open_.end(), id) != open_.end()) {
    std::string way;
    for (const auto& open : open_) way += open + " > ";
    fail(element, "tree '" + id + "' contains itself: " + way + id);
  }
  tree_.boards_.push_back(std::make_unique<Blackboard>(&outer));
  Blackboard& inner = *tree_.boards_.back();
  connect(inner, element, id);
  open_.push_back(id);
  node.children_.push_back(make(tree->second.children.front(), inner, prefix));
  open_.pop_back();
}

void TreeBuilder::connect(Blackboard& inner, const Element& element, const std::string& id) const {
  const auto* remap = element.attribute("_autoremap");
  const bool autoremap = remap && to_boolean(BlackboardValue(*remap));
  std::vector<xml::Attribute> ports;
  for (const auto& attribute : element.attributes) {
    if (xml::is_port_name(attribute.name)) ports.push_back(attribute);
  }
  if (const auto model = forest_.models.find(id); model != forest_.models.end() && !autoremap) {
    for (const auto& port : model->second) {
      if (element.attribute(port.name)) continue;
      if (!port.fallback || port.fallback->empty()) {
        fail(element,
             "the model of SubTree '" + id + "' has the port [" + port.name + "], which is not given",
             Reason::missing_key);
      }
      ports.push_back({port.name, *port.fallback});
    }
  }
  for (const auto& port : ports) {
    if (port.value == "{=}") {
      inner.remap(port.name, port.name);
    } else if (const auto key = blackboard_key(port.name, port.value); key && port.value != "=") {
      inner.remap(port.name, *key);
    } else {
      // Before autoremapping, so that a constant stays inside.
      inner.set(port.name, BlackboardValue(port.value));
    }
  }
  inner.set_autoremap(autoremap);
}

}  // namespace adit::bt
