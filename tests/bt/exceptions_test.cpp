// SPDX-License-Identifier: Apache-2.0
// An exception in a leaf is a FAILURE of that leaf, reported, never the end of the process.
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

namespace {

class Thrower : public StatefulLeaf {
 public:
  explicit Thrower(std::string where) : where_(std::move(where)) {}
  NodeStatus on_start(Leaf&) override {
    if (where_ == "start") throw std::runtime_error("boom at start");
    return NodeStatus::running;
  }
  NodeStatus on_running(Leaf&) override {
    if (where_ == "running") throw 42;
    return NodeStatus::running;
  }
  void on_halted(Leaf&) override {
    if (where_ == "halt") throw std::runtime_error("boom at halt");
  }

 private:
  std::string where_;
};

struct Fixture {
  explicit Fixture(const std::string& body) {
    Registry registry;
    (void)registry.add_action("Throw", [](Leaf&) -> NodeStatus { throw std::logic_error("boom"); });
    (void)registry.add_action("Nothing", [](Leaf&) { return NodeStatus::idle; });
    (void)registry.add_stateful(
        "Stateful", [](const NodeConfig& config) { return std::make_unique<Thrower>(config.name); });
    auto loaded = load_tree_text(
        registry, R"(<root BTCPP_format="4"><BehaviorTree ID="T">)" + body + "</BehaviorTree></root>");
    EXPECT_TRUE(loaded.ok()) << loaded.error().text;
    tree = std::move(*loaded);
    tree.on_error([this](const TreeNode& node, std::string_view what) {
      heard.push_back(node.id() + ": " + std::string(what));
    });
  }
  Tree tree{};
  std::vector<std::string> heard{};
};

}  // namespace

TEST(Exceptions, InAFunctionAreAFailureOfTheLeaf) {
  Fixture f("<Fallback><Throw/><AlwaysSuccess/></Fallback>");
  EXPECT_EQ(f.tree.tick(Time{}), NodeStatus::success);
  EXPECT_EQ(f.heard, (std::vector<std::string>{"Throw: boom"}));
}

TEST(Exceptions, OfAnyTypeInEveryCallbackAreCaught) {
  Fixture start(R"(<Stateful name="start"/>)");
  EXPECT_EQ(start.tree.tick(Time{}), NodeStatus::failure);
  Fixture running(R"(<Stateful name="running"/>)");
  EXPECT_EQ(running.tree.tick(Time{}), NodeStatus::running);
  EXPECT_EQ(running.tree.tick(Time{}), NodeStatus::failure);
  EXPECT_EQ(running.heard, (std::vector<std::string>{"Stateful: an exception of unknown type"}));
  Fixture halt(R"(<Stateful name="halt"/>)");
  EXPECT_EQ(halt.tree.tick(Time{}), NodeStatus::running);
  halt.tree.halt();
  EXPECT_EQ(halt.heard, (std::vector<std::string>{"Stateful: while halted: boom at halt"}));
  EXPECT_EQ(halt.tree.root().status(), NodeStatus::idle);
}

TEST(Exceptions, InOneBranchLeaveTheOthersRunning) {
  Fixture f(R"(<Parallel failure_count="2" success_count="1"><Throw/><Stateful name="ok"/></Parallel>)");
  EXPECT_EQ(f.tree.tick(Time{}), NodeStatus::running);
  EXPECT_EQ(f.tree.tick(Time{}), NodeStatus::running);
  EXPECT_EQ(f.heard.size(), 1u);
}

TEST(Exceptions, AnIdleAnswerIsOneToo) {
  Fixture f("<Nothing/>");
  EXPECT_EQ(f.tree.tick(Time{}), NodeStatus::failure);
  EXPECT_EQ(f.heard.size(), 1u);
}

TEST(Exceptions, WhileHaltingDoNotKeepTheSiblingsFromBeingHalted) {
  Fixture f(
      R"(<Parallel success_count="3" failure_count="3"><Stateful name="halt"/><Stateful name="other"/><Stateful name="third"/></Parallel>)");
  f.tree.tick(Time{});
  f.tree.halt();
  f.tree.for_each(
      [](const TreeNode& node, std::size_t) { EXPECT_EQ(node.status(), NodeStatus::idle) << node.name(); });
}

TEST(Exceptions, AControlNodeThatFailsByItselfHaltsItsChildren) {
  Dry dry(
      R"(<Sequence><Script code="n := 2"/><Parallel success_count="{n}" failure_count="2"><A/><B/></Parallel></Sequence>)",
      {{"A", "R"}, {"B", "R"}});
  EXPECT_EQ(dry.tick(), "R A B");
  ASSERT_TRUE(dry.tree.blackboard().put("n", 9));
  EXPECT_EQ(dry.tick(), "F !A !B");
  EXPECT_EQ(dry.errors.size(), 1u);
}

}  // namespace adit::bt::test
