// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/bt/xml/document.hpp"

namespace adit::bt::xml {

/// A port of a <SubTree> in <TreeNodesModel>.
struct ModelPort {
  std::string name{};
  std::optional<std::string> fallback{};  ///< None: every use must give the port.
};

/// All trees of a file and of the files that it includes, not checked yet.
struct Forest {
  std::map<std::string, Element> trees{};                  ///< <BehaviorTree> elements by ID
  std::vector<std::string> order{};                        ///< Tree IDs in reading order.
  std::map<std::string, std::vector<ModelPort>> models{};  ///< By SubTree ID.
  std::optional<std::string> main{};  ///< The attribute main_tree_to_execute of the first file.
  Element root{};                     ///< The <root> of the first file, without children.
};

/// Reads the document and its includes (relative to `folder`). Throws LoadError: wrong format version,
/// missing or duplicate IDs, includes that cannot be read or include themselves.
Forest collect(Element root, const std::string& folder);

/// Returns the ID of the tree to run: `wanted` if given, else main_tree_to_execute, else the only tree.
std::string main_tree(const Forest& forest, const std::string& wanted);

}  // namespace adit::bt::xml
