// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <utility>

#include "core/bt/registry.hpp"

namespace adit::bt {

inline constexpr std::size_t kAnyNumber = static_cast<std::size_t>(-1);

/// Manifest of a control node class that is constructed from a NodeConfig.
template <class T>
Manifest control(std::string id, Ports ports = {}, std::size_t min_children = 1,
                 std::size_t max_children = kAnyNumber) {
  return {
      std::move(id),
      NodeKind::control,
      std::move(ports),
      min_children,
      max_children,
      [](NodeConfig config) -> std::unique_ptr<TreeNode> { return std::make_unique<T>(std::move(config)); },
      true};
}
template <class T>
Manifest decorator(std::string id, Ports ports = {}) {
  auto manifest = control<T>(std::move(id), std::move(ports), 1, 1);
  manifest.kind = NodeKind::decorator;
  return manifest;
}
template <class T>
Manifest leaf(std::string id, NodeKind kind, Ports ports = {}) {
  auto manifest = control<T>(std::move(id), std::move(ports), 0, 0);
  manifest.kind = kind;
  return manifest;
}

// Each file of this folder has one function that registers its nodes.
void add_sequences(Registry& registry);
void add_reactive(Registry& registry);
void add_parallel(Registry& registry);
void add_branches(Registry& registry);
void add_switches(Registry& registry);
void add_try_catch(Registry& registry);
void add_decorators(Registry& registry);
void add_loops(Registry& registry);
void add_timed(Registry& registry);
void add_actions(Registry& registry);
void add_scripted(Registry& registry);

/// Creates a SubTree node, which stands for another tree; its child is the root of that tree.
std::unique_ptr<TreeNode> make_subtree(NodeConfig config);

}  // namespace adit::bt
