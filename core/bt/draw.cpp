// SPDX-License-Identifier: Apache-2.0
#include "core/bt/draw.hpp"

#include <map>

namespace adit::bt {

namespace {

std::string label(const TreeNode& node) {
  std::string text = node.kind() == NodeKind::subtree ? "SubTree " + node.id() : node.id();
  if (node.named() && node.name() != node.id()) text += " \"" + node.name() + "\"";
  return text;
}

std::string attributes(const TreeNode& node) {
  std::string text;
  for (const auto& [port, value] : node.config().ports) text += "  " + port + "=" + value;
  for (std::size_t i = 0; i < kHookNames.size(); ++i) {
    if (node.config().hooks[i]) text += "  " + std::string(kHookNames[i]);
  }
  return text;
}

void draw_below(const TreeNode& node, const std::string& prefix, std::string& out) {
  const auto& children = node.children();
  for (std::size_t i = 0; i < children.size(); ++i) {
    const bool last = i + 1 == children.size();
    out += prefix + (last ? "└─ " : "├─ ") + label(*children[i]) + attributes(*children[i]) + "\n";
    draw_below(*children[i], prefix + (last ? "   " : "│  "), out);
  }
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + "\"";
}

std::string shape(NodeKind kind) {
  switch (kind) {
    case NodeKind::control:
      return "box";
    case NodeKind::decorator:
      return "hexagon";
    case NodeKind::subtree:
      return "folder";
    case NodeKind::condition:
      return "ellipse";
    case NodeKind::action:
      return "box, style=rounded";
  }
  return "box";
}

}  // namespace

std::string draw_text(const Tree& tree) {
  std::string out = tree.id() + "\n";
  if (tree.empty()) return out;
  out += "└─ " + label(tree.root()) + attributes(tree.root()) + "\n";
  draw_below(tree.root(), "   ", out);
  return out;
}

std::string draw_dot(const Tree& tree) {
  std::string nodes, edges;
  std::map<const TreeNode*, std::string> ids;
  tree.for_each([&](const TreeNode& node, std::size_t) {
    const std::string id = "n" + std::to_string(ids.size());
    ids[&node] = id;
    nodes += "  " + id + " [label=" + quoted(label(node)) + ", shape=" + shape(node.kind()) + "];\n";
  });
  tree.for_each([&](const TreeNode& node, std::size_t) {
    for (const auto& child : node.children()) edges += "  " + ids[&node] + " -> " + ids[child.get()] + ";\n";
  });
  return "digraph " + quoted(tree.id()) + " {\n  ordering=out;\n  node [fontname=\"sans-serif\"];\n" + nodes +
         edges + "}\n";
}

}  // namespace adit::bt
