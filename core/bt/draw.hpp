// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "core/bt/tree.hpp"

namespace adit::bt {

/// Draws the tree as indented text, one line per node: kind, name and ports.
std::string draw_text(const Tree& tree);
/// Draws the tree for Graphviz: `tree draw FILE --dot | dot -Tpng -o tree.png`.
std::string draw_dot(const Tree& tree);

}  // namespace adit::bt
