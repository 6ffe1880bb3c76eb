// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/bt/registry.hpp"
#include "core/bt/xml/forest.hpp"

namespace adit::bt::xml {

/// The kind of an element: the id of the node, and its manifest (nullptr: an unknown leaf that the registry
/// accepts, or a SubTree).
struct Kind {
  std::string id{};
  NodeKind kind{NodeKind::action};
  const Manifest* manifest{nullptr};
};
/// Returns the kind of an element. Throws LoadError when it is no known node.
Kind kind_of(const Element& element, const Registry& registry);

/// Whether the attribute can be a port. ID, name, _autoremap, the hooks, and all other names that start with
/// '_' are never ports.
bool is_port_name(std::string_view attribute);

/// Checks the structure of every tree: known nodes, numbers of children, ports that exist, required ports,
/// values that can be parsed, scripts that can be parsed. Throws LoadError.
void verify(const Forest& forest, const Registry& registry);

}  // namespace adit::bt::xml
