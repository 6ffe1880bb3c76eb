// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/bt/registry.hpp"
#include "core/bt/tree.hpp"
#include "core/bt/xml/forest.hpp"

namespace adit::bt {

/// Creates the nodes and blackboards of one tree of a verified forest.
class TreeBuilder {
 public:
  TreeBuilder(const xml::Forest& forest, const Registry& registry) : forest_(forest), registry_(registry) {}
  /// Builds the tree. Throws xml::LoadError: a SubTree that does not exist or contains itself, a port of a
  /// SubTree's model that is not given, or a tree of more than 20 000 nodes or 500 levels.
  Tree build(const std::string& tree_id);

 private:
  std::unique_ptr<TreeNode> make(const xml::Element& element, Blackboard& board, const std::string& prefix);
  void fill_subtree(TreeNode& node, const xml::Element& element, Blackboard& outer,
                    const std::string& prefix);
  void connect(Blackboard& inner, const xml::Element& element, const std::string& id) const;
  void fill_ports(NodeConfig& config, const xml::Element& element, const Manifest* manifest) const;

  const xml::Forest& forest_;
  const Registry& registry_;
  Tree tree_{};
  std::vector<std::string> open_{};  ///< Trees that are being built, outermost first.
  std::size_t count_{0};
  std::size_t depth_{0};
};

}  // namespace adit::bt
