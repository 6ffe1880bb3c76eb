// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "core/bt/tree.hpp"

namespace adit::bt::test {

/// 'R', 'S', 'F', 'K' (skipped), '-' (idle).
inline char letter(NodeStatus s) {
  switch (s) {
    case NodeStatus::running:
      return 'R';
    case NodeStatus::success:
      return 'S';
    case NodeStatus::failure:
      return 'F';
    case NodeStatus::skipped:
      return 'K';
    case NodeStatus::idle:
      return '-';
  }
  return '?';
}
inline NodeStatus status_of(char c) {
  return c == 'R'   ? NodeStatus::running
         : c == 'S' ? NodeStatus::success
         : c == 'F' ? NodeStatus::failure
                    : NodeStatus::skipped;
}

/// A tree whose unknown leaves play scripts: {{"A", "RS"}} makes A answer RUNNING, then SUCCESS for ever.
/// A leaf without a script succeeds and is not traced.
class Dry {
 public:
  /// `body`: what stands in <BehaviorTree ID="Main">; `more`: what follows it in <root>.
  explicit Dry(const std::string& body, std::map<std::string, std::string> scripts = {},
               const std::string& more = "")
      : scripts_(std::move(scripts)) {
    Registry registry;
    registry.accept_unknown_leaves(
        [this](const NodeConfig& config) { return std::make_unique<Player>(*this, config.name); });
    auto loaded =
        load_tree_text(registry,
                       R"(<root BTCPP_format="4" main_tree_to_execute="Main"><BehaviorTree ID="Main">)" +
                           body + "</BehaviorTree>" + more + "</root>",
                       "test.xml");
    if (!loaded) {
      ADD_FAILURE() << loaded.error().text;
      return;
    }
    tree = std::move(*loaded);
    tree.on_error([this](const TreeNode& node, std::string_view what) {
      errors.push_back(node.name() + ": " + std::string(what));
    });
  }
  Dry(const Dry&) = delete;
  Dry& operator=(const Dry&) = delete;

  /// One tick, 10 ms after the last: "R A B !C" = RUNNING, A and B ticked, C halted.
  std::string tick() {
    trace_.clear();
    const NodeStatus answer = tree.tick(now);
    now += std::chrono::milliseconds(10);
    return std::string(1, letter(answer)) + trace_;
  }
  std::vector<std::string> ticks(int n) {
    std::vector<std::string> out;
    for (int i = 0; i < n; ++i) out.push_back(tick());
    return out;
  }
  std::string halt() {
    trace_.clear();
    tree.halt();
    return trace_;
  }
  /// Status of every node with a name attribute that is not idle: "root=R A=R".
  std::string nodes() const {
    std::string out;
    tree.for_each([&](const TreeNode& node, std::size_t) {
      if (!node.named() || node.status() == NodeStatus::idle) return;
      out += (out.empty() ? "" : " ") + node.name() + "=" + letter(node.status());
    });
    return out;
  }

  Tree tree{};
  Time now{};
  std::vector<std::string> errors{};

 private:
  class Player : public StatefulLeaf {
   public:
    Player(Dry& dry, std::string leaf) : dry_(dry), leaf_(std::move(leaf)) {}
    NodeStatus on_start(Leaf&) override { return visit(); }
    NodeStatus on_running(Leaf&) override { return visit(); }
    void on_halted(Leaf&) override {
      if (dry_.scripts_.contains(leaf_)) dry_.trace_ += " !" + leaf_;
    }

   private:
    NodeStatus visit() {
      const auto it = dry_.scripts_.find(leaf_);
      if (it == dry_.scripts_.end()) return NodeStatus::success;
      dry_.trace_ += " " + leaf_;
      const char answer = it->second.front();
      if (it->second.size() > 1) it->second.erase(0, 1);
      return status_of(answer);
    }
    Dry& dry_;
    std::string leaf_;
  };

  std::map<std::string, std::string> scripts_;
  std::string trace_{};
};

using Trace = std::vector<std::string>;

}  // namespace adit::bt::test
