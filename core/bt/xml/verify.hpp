#pragma once
#include "core/bt/registry.hpp"
#include "core/bt/xml/forest.hpp"

namespace adit::bt::xml {

/// What an element stands for: the id of the node, and its manifest (nullptr: an unknown leaf that the
/// registry accepts, or a SubTree).
struct Kind {
  std::string id{};
  NodeKind kind{NodeKind::action};
  const Manifest* manifest{nullptr};
};
/// Throws LoadError when the element is no known node.
Kind kind_of(const Element& element, const Registry& registry);

/// Names that are never ports: ID, name, _autoremap, the hooks, and all else that starts with '_'.
bool is_port_name(std::string_view attribute);

/// Checks the shape of every tree: known nodes, numbers of children, ports that exist, ports that are
/// required, values that can be read, scripts that can be parsed. Throws LoadError.
void verify(const Forest& forest, const Registry& registry);

}  // namespace adit::bt::xml
