// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

namespace {

Tree load(const Registry& registry, const std::string& body) {
  auto tree = load_tree_text(
      registry, R"(<root BTCPP_format="4"><BehaviorTree ID="T">)" + body + "</BehaviorTree></root>");
  EXPECT_TRUE(tree.ok()) << tree.error().text;
  return std::move(*tree);
}

class Walk : public StatefulLeaf {
 public:
  explicit Walk(std::string& log) : log_(log) {}
  NodeStatus on_start(Leaf& leaf) override {
    log_ += "start";
    left_ = leaf.input<int>("steps").value();
    return NodeStatus::running;
  }
  NodeStatus on_running(Leaf& leaf) override {
    log_ += ".";
    if (--left_ > 0) return NodeStatus::running;
    return leaf.output("done_at", seconds(leaf.now().time_since_epoch())).ok() ? NodeStatus::success
                                                                               : NodeStatus::failure;
  }
  void on_halted(Leaf&) override { log_ += "halt"; }

 private:
  std::string& log_;
  int left_{0};
};

}  // namespace

TEST(Leaves, FunctionsReadAndWriteTypedPorts) {
  Registry registry;
  ASSERT_TRUE(registry.add_action("Add",
                                  [](Leaf& leaf) {
                                    const auto a = leaf.input<double>("a");
                                    const auto b = leaf.input<double>("b");
                                    if (!a || !b) return NodeStatus::failure;
                                    return leaf.output("sum", *a + *b).ok() ? NodeStatus::success
                                                                            : NodeStatus::failure;
                                  },
                                  {required_input("a", PortType::real), input("b", PortType::real, "10"),
                                   output("sum", PortType::real)}));
  Tree tree =
      load(registry, R"(<Sequence><Add a="1.5" sum="{x}"/><Add a="{x}" b="{x}" sum="{y}"/></Sequence>)");
  EXPECT_EQ(tree.tick(Time{}), NodeStatus::success);
  EXPECT_EQ(tree.blackboard().get<double>("y").value(), 23.0);
}

TEST(Leaves, MissingAndWrongPortsAreErrorsForTheLeafToHandle) {
  Registry registry;
  std::vector<std::string> texts;
  ASSERT_TRUE(registry.add_condition("Probe",
                                     [&](Leaf& leaf) {
                                       texts.push_back(leaf.input<int>("missing").error().text);
                                       texts.push_back(leaf.input<int>("empty").error().text);
                                       texts.push_back(leaf.output("literal", 1).error().text);
                                       return NodeStatus::success;
                                     },
                                     {input("missing"), input("empty"), output("literal")}));
  Tree tree = load(registry, R"(<Probe empty="{nothing}" literal="text"/>)");
  tree.tick(Time{});
  ASSERT_EQ(texts.size(), 3u);
  EXPECT_NE(texts[0].find("[missing]"), std::string::npos);
  EXPECT_NE(texts[1].find("'nothing'"), std::string::npos);
  EXPECT_NE(texts[2].find("{key}"), std::string::npos);
}

TEST(Leaves, StatefulLeavesStartRunHaltAndSeeTheTicksTime) {
  Registry registry;
  std::string log;
  ASSERT_TRUE(registry.add_stateful("Walk", [&](const NodeConfig&) { return std::make_unique<Walk>(log); },
                                    {required_input("steps", PortType::natural), output("done_at")}));
  Tree tree = load(registry, R"(<Walk steps="2" done_at="{t}"/>)");
  tree.tick(Time{1s});
  tree.tick(Time{2s});
  tree.halt();
  for (int i = 3; i < 6; ++i) tree.tick(Time{std::chrono::seconds(i)});
  EXPECT_EQ(log, "start.haltstart..");
  EXPECT_EQ(tree.blackboard().get<double>("t").value(), 5.0);
}

TEST(Leaves, AnActionThatAnswersRunningIsAMistakeAConditionMay) {
  Registry registry;
  ASSERT_TRUE(registry.add_action("Act", [](Leaf&) { return NodeStatus::running; }));
  ASSERT_TRUE(registry.add_condition("Ask", [](Leaf&) { return NodeStatus::running; }));
  EXPECT_EQ(load(registry, "<Act/>").tick(Time{}), NodeStatus::failure);
  EXPECT_EQ(load(registry, "<Ask/>").tick(Time{}), NodeStatus::running);
}

TEST(Leaves, AnIdIsTakenOnlyOnce) {
  Registry registry;
  EXPECT_TRUE(registry.add_action("X", [](Leaf&) { return NodeStatus::success; }));
  EXPECT_EQ(registry.add_condition("X", [](Leaf&) { return NodeStatus::success; }).reason(), Reason::in_use);
  EXPECT_EQ(registry.add_action("Sequence", [](Leaf&) { return NodeStatus::success; }).reason(),
            Reason::in_use);
}

TEST(Leaves, EnumsHaveTheirNamesInScriptsAndSwitches) {
  Registry registry;
  registry.add_enum("DRIVING", 2);
  Tree tree = load(registry, R"(<Sequence><Script code="mode := 2"/><ScriptCondition code="mode == DRIVING"/>
      <Switch2 variable="{mode}" case_1="HOLDING" case_2="DRIVING"><AlwaysFailure/><AlwaysSuccess/><AlwaysFailure/></Switch2></Sequence>)");
  EXPECT_EQ(tree.tick(Time{}), NodeStatus::success);
}

TEST(Observers, HearEveryChangeOfStatusInOrder) {
  Dry dry(R"(<Sequence name="s"><A name="a"/><B name="b"/></Sequence>)", {{"a", "S"}, {"b", "RS"}});
  std::string heard;
  dry.tree.on_status([&](const TreeNode& node, NodeStatus from, NodeStatus to) {
    heard += " " + node.name() + letter(from) + letter(to);
  });
  dry.tick();
  EXPECT_EQ(heard, " s-R a-S b-R");
  heard.clear();
  dry.tick();
  EXPECT_EQ(heard, " bRS aS- bS- sRS sS-");
}

TEST(Tree, AnEmptyOneFailsAndAMovedOneGoesOn) {
  EXPECT_EQ(Tree().tick(Time{}), NodeStatus::failure);
  Dry dry("<Sequence><A/><B/></Sequence>", {{"A", "S"}, {"B", "RS"}});
  dry.tick();
  Tree moved = std::move(dry.tree);
  dry.tree = std::move(moved);
  EXPECT_EQ(dry.tick(), "S B");
}

}  // namespace adit::bt::test
