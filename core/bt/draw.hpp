#pragma once
#include <string>

#include "core/bt/tree.hpp"

namespace adit::bt {

/// The tree as indented text, one line a node: kind, name and ports.
std::string draw_text(const Tree& tree);
/// The tree for Graphviz: `tree draw FILE --dot | dot -Tpng -o tree.png`.
std::string draw_dot(const Tree& tree);

}  // namespace adit::bt
