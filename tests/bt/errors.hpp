// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "core/bt/tree.hpp"

namespace adit::bt::test {

class Idler : public StatefulLeaf {
 public:
  NodeStatus on_start(Leaf&) override { return NodeStatus::success; }
  NodeStatus on_running(Leaf&) override { return NodeStatus::success; }
  void on_halted(Leaf&) override {}
};

inline Registry tolerant() {
  Registry registry;
  registry.accept_unknown_leaves([](const NodeConfig&) { return std::make_unique<Idler>(); });
  return registry;
}

/// Loading the text must fail with this in the error's text.
inline void expect_error(const std::string& text, const std::string& part, Reason reason = Reason::syntax) {
  const auto tree = load_tree_text(tolerant(), text, "t.xml");
  ASSERT_FALSE(tree.ok()) << "loaded: " << text;
  EXPECT_NE(tree.error().text.find(part), std::string::npos) << tree.error().text;
  EXPECT_EQ(tree.error().text.find('\n'), std::string::npos) << "one line: " << tree.error().text;
  EXPECT_EQ(tree.error().reason, reason) << tree.error().text;
}

/// The same for what stands in a tree, from line 3 on.
inline void expect_body_error(const std::string& body, const std::string& part,
                              Reason reason = Reason::syntax) {
  expect_error("<root BTCPP_format=\"4\">\n<BehaviorTree ID=\"M\">\n" + body + "\n</BehaviorTree></root>",
               part, reason);
}

}  // namespace adit::bt::test
