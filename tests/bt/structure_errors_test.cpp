// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/errors.hpp"

namespace adit::bt::test {

TEST(StructureErrors, Documents) {
  expect_error("", "t.xml:1: the file is empty");
  expect_error("   \n  ", "t.xml:");
  expect_error("<root>\n<BehaviorTree ID=\"M\">\n</root>", "t.xml:2: an element is closed");
  expect_error("<tree/>", "t.xml:1: the outermost element is <tree>, expected <root>");
  expect_error("<root BTCPP_format=\"3\"/>", "t.xml:1: BTCPP_format is \"3\"", Reason::not_supported);
  expect_error("<root BTCPP_format=\"4\"/>", "t.xml:1: no <BehaviorTree>");
  expect_error("<root><Sequence/></root>", "t.xml:1: <Sequence> is not expected in <root>");
  expect_error("<root><TreeNodesModel/>\n<TreeNodesModel/></root>", "t.xml:2: only one <TreeNodesModel>");
  expect_error("<root><TreeNodesModel>\n<Action/></TreeNodesModel></root>",
               "t.xml:2: <Action> in <TreeNodesModel> needs the attribute [ID]", Reason::missing_key);
}

TEST(StructureErrors, NumbersOfChildren) {
  expect_body_error("", "t.xml:2: <BehaviorTree ID=\"M\"> must have exactly 1 child, it has 0");
  expect_body_error("<AlwaysSuccess/>\n<AlwaysSuccess/>", "must have exactly 1 child, it has 2");
  expect_body_error("<Sequence>\n<Inverter>\n<AlwaysSuccess/><AlwaysSuccess/></Inverter></Sequence>",
                    "t.xml:4: 'Inverter' must have exactly 1 child, it has 2");
  expect_body_error("<Inverter/>", "t.xml:3: 'Inverter' must have exactly 1 child, it has 0");
  expect_body_error("<Sequence/>", "t.xml:3: 'Sequence' must have at least 1 child, it has 0");
  expect_body_error("<IfThenElse><A/></IfThenElse>", "'IfThenElse' must have at least 2 children, it has 1");
  expect_body_error("<WhileDoElse><A/><A/><A/><A/></WhileDoElse>",
                    "'WhileDoElse' must have at most 3 children, it has 4");
  expect_body_error("<Switch2 variable=\"1\"><A/><A/></Switch2>",
                    "'Switch2' must have exactly 3 children, it has 2");
  expect_body_error("<TryCatch><A/></TryCatch>", "'TryCatch' must have at least 2 children");
  expect_body_error("<AlwaysSuccess><A/></AlwaysSuccess>",
                    "'AlwaysSuccess' must not have children, it has 1");
  expect_body_error("<SubTree ID=\"M2\"><A/></SubTree>", "<SubTree ID=\"M2\"> must not have children");
  expect_body_error("<Sequnce><A/></Sequnce>",
                    "t.xml:3: unknown node 'Sequnce' with children: only leaves may be unknown");
  expect_body_error(
      "<ReactiveSequence><AsyncSequence><A/></AsyncSequence><AsyncSequence><A/></AsyncSequence></"
      "ReactiveSequence>",
      "more than one AsyncSequence");
}

TEST(StructureErrors, Ids) {
  expect_body_error("<Action/>", "t.xml:3: <Action> needs the attribute [ID]", Reason::missing_key);
  expect_body_error("<SubTree/>", "t.xml:3: <SubTree> needs the attribute [ID]", Reason::missing_key);
  expect_body_error("<Sequence ID=\"x\"><A/></Sequence>", "the attribute [ID] is not allowed in <Sequence>");
  expect_body_error("<Control ID=\"Odd\"><A/></Control>", "unknown Control 'Odd'");
  expect_body_error("<Decorator ID=\"Odd\"><A/></Decorator>", "unknown Decorator 'Odd'");
  expect_body_error("<SubTree ID=\"Sequence\"/>", "which is a node");
  expect_body_error("<LoopInt queue=\"1;2\"><A/></LoopInt>", "'LoopInt' of BehaviorTree.CPP is not supported",
                    Reason::not_supported);
  expect_body_error("<Sequence name=\"a\"\nname=\"b\"><A/></Sequence>", "t.xml:", Reason::syntax);
  expect_error(
      "<root><BehaviorTree ID=\"A\"><X/></BehaviorTree>\n<BehaviorTree ID=\"A\"><X/></BehaviorTree></root>",
      "t.xml:2: tree 'A' is already defined in t.xml:1");
  expect_error("<root><BehaviorTree ID=\"A\"><X/></BehaviorTree>\n<BehaviorTree><X/></BehaviorTree></root>",
               "t.xml:2: <BehaviorTree> needs the attribute [ID]", Reason::missing_key);
  expect_error("<root><BehaviorTree ID=\"Inverter\"><X/></BehaviorTree></root>",
               "a tree cannot have the ID 'Inverter'");
}

TEST(StructureErrors, MainTree) {
  const std::string two =
      "<BehaviorTree ID=\"A\"><X/></BehaviorTree><BehaviorTree ID=\"B\"><X/></BehaviorTree></root>";
  expect_error("<root>" + two, "[main_tree_to_execute]", Reason::missing_key);
  expect_error("<root main_tree_to_execute=\"C\">" + two, "no tree with ID 'C', there are: A, B");
}

TEST(StructureErrors, SubTrees) {
  expect_body_error("<SubTree ID=\"Nowhere\"/>", "t.xml:3: no tree with ID 'Nowhere'");
  expect_body_error("<SubTree ID=\"M\"/>", "t.xml:3: tree 'M' contains itself: M > M");
  expect_error(
      "<root main_tree_to_execute=\"A\">\n<BehaviorTree ID=\"A\"><SubTree ID=\"B\"/></BehaviorTree>\n"
      "<BehaviorTree ID=\"B\"><SubTree ID=\"A\"/></BehaviorTree></root>",
      "t.xml:3: tree 'A' contains itself: A > B > A");
  expect_error(
      "<root main_tree_to_execute=\"A\"><BehaviorTree ID=\"A\">\n<Other/></BehaviorTree>"
      "<BehaviorTree ID=\"Other\"><X/></BehaviorTree></root>",
      "t.xml:2: 'Other' is a tree: write <SubTree ID=\"Other\"/>");
  expect_error(
      "<root main_tree_to_execute=\"A\"><TreeNodesModel><SubTree ID=\"B\"><input_port "
      "name=\"p\"/></SubTree></TreeNodesModel>"
      "<BehaviorTree ID=\"A\">\n<SubTree ID=\"B\"/></BehaviorTree><BehaviorTree "
      "ID=\"B\"><X/></BehaviorTree></root>",
      "t.xml:2: the model of SubTree 'B' has the port [p]", Reason::missing_key);
}

TEST(StructureErrors, SizesAreBounded) {
  std::string deep;
  for (int i = 0; i < 200; ++i) deep += "<Inverter>";
  expect_body_error(deep, "nested more than 100 deep");
  // Each tree holds the next one ten times: 10^6 nodes.
  std::string trees;
  for (int level = 0; level < 6; ++level) {
    trees += "<BehaviorTree ID=\"T" + std::to_string(level) + "\"><Sequence>";
    for (int i = 0; i < 10; ++i)
      trees += level == 5 ? "<X/>" : "<SubTree ID=\"T" + std::to_string(level + 1) + "\"/>";
    trees += "</Sequence></BehaviorTree>";
  }
  expect_error("<root main_tree_to_execute=\"T0\">" + trees + "</root>", "more than 20000 nodes",
               Reason::out_of_range);
  std::string chain;
  for (int level = 0; level < 300; ++level) {
    chain += "<BehaviorTree ID=\"C" + std::to_string(level) + "\"><Inverter><SubTree ID=\"C" +
             std::to_string(level + 1) + "\"/></Inverter></BehaviorTree>";
  }
  expect_error(
      "<root main_tree_to_execute=\"C0\">" + chain + "<BehaviorTree ID=\"C300\"><X/></BehaviorTree></root>",
      "more than 500 levels", Reason::out_of_range);
}

TEST(StructureErrors, UnknownLeavesNeedARegistryThatAcceptsThem) {
  const auto tree =
      load_tree_text(Registry(), "<root><BehaviorTree ID=\"M\">\n<Drive/></BehaviorTree></root>", "t.xml");
  ASSERT_FALSE(tree.ok());
  EXPECT_EQ(tree.error().text, "t.xml:2: unknown node 'Drive'");
}

}  // namespace adit::bt::test
