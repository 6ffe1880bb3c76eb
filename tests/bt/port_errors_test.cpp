// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/errors.hpp"

namespace adit::bt::test {

TEST(PortErrors, RequiredPorts) {
  expect_body_error("<Repeat><A/></Repeat>", "t.xml:3: 'Repeat' needs the port [num_cycles]",
                    Reason::missing_key);
  expect_body_error("<RetryUntilSuccessful><A/></RetryUntilSuccessful>", "[num_attempts]",
                    Reason::missing_key);
  expect_body_error("<Delay><A/></Delay>", "[delay_msec]", Reason::missing_key);
  expect_body_error("<Timeout><A/></Timeout>", "[msec]", Reason::missing_key);
  expect_body_error("<Sleep/>", "[msec]", Reason::missing_key);
  expect_body_error("<SetBlackboard value=\"1\"/>", "[output_key]", Reason::missing_key);
  expect_body_error("<SetBlackboard output_key=\"k\"/>", "[value]", Reason::missing_key);
  expect_body_error("<Script/>", "[code]", Reason::missing_key);
}

TEST(PortErrors, UnknownPorts) {
  expect_body_error("<Sequence\nspeed=\"1\"><A/></Sequence>", "t.xml:3: 'Sequence' has no port [speed]",
                    Reason::unknown_key);
  expect_body_error("<Timeout ms=\"1\"><A/></Timeout>", "'Timeout' has no port [ms], it has [msec]",
                    Reason::unknown_key);
  expect_body_error("<Switch2 case_3=\"1\"><A/><A/><A/></Switch2>", "has no port [case_3]",
                    Reason::unknown_key);
}

TEST(PortErrors, Values) {
  expect_body_error("<Repeat num_cycles=\"three\"><A/></Repeat>",
                    "port [num_cycles] is 'three', expected an integer", Reason::wrong_type);
  expect_body_error("<Timeout msec=\"-1\"><A/></Timeout>",
                    "port [msec] is '-1', expected an integer of at least 0", Reason::wrong_type);
  expect_body_error("<Timeout msec=\"99999999999\"><A/></Timeout>", "[msec]", Reason::wrong_type);
  expect_body_error("<RunOnce then_skip=\"perhaps\"><A/></RunOnce>", "expected true or false",
                    Reason::wrong_type);
  expect_body_error("<Precondition if=\"true\" else=\"NO\"><A/></Precondition>", "expected SUCCESS",
                    Reason::wrong_type);
  expect_body_error("<Parallel success_count=\"3\"><A/><A/></Parallel>",
                    "[success_count] is 3, more than the 2 children", Reason::out_of_range);
  expect_body_error("<Parallel failure_count=\"2\"><A/></Parallel>",
                    "[failure_count] is 2, more than the 1 child", Reason::out_of_range);
  expect_body_error("<SubTree ID=\"X\" _autoremap=\"maybe\"/>", "[_autoremap]", Reason::wrong_type);
}

TEST(PortErrors, Scripts) {
  expect_body_error("<A _skipIf=\"a ==\"/>", "t.xml:3: [_skipIf] script: expected a value at character 5");
  expect_body_error("<Script code=\"a := (1\"/>", "[code] script: expected ')'");
  expect_body_error("<Precondition if=\"\"><A/></Precondition>", "[if] script: the script is empty");
}

TEST(PortErrors, BlackboardPortsAreReadWhenTicked) {
  const auto tree = load_tree_text(
      tolerant(),
      R"(<root><BehaviorTree ID="M"><Repeat num_cycles="{n}"><A/></Repeat></BehaviorTree></root>)");
  EXPECT_TRUE(tree.ok());
}

TEST(PortErrors, RegisteredLeavesAreChecked) {
  Registry registry;
  ASSERT_TRUE(registry.add_action("Drive", [](Leaf&) { return NodeStatus::success; },
                                  {required_input("speed", PortType::real)}));
  const auto load = [&](const std::string& leaf) {
    const auto tree = load_tree_text(
        registry, "<root><BehaviorTree ID=\"M\">\n" + leaf + "</BehaviorTree></root>", "t.xml");
    return tree.ok() ? std::string("ok") : tree.error().text;
  };
  EXPECT_EQ(load(R"(<Drive speed="1.5"/>)"), "ok");
  EXPECT_EQ(load(R"(<Action ID="Drive" name="d" speed="{s}"/>)"), "ok");
  EXPECT_EQ(load("<Drive/>"), "t.xml:2: 'Drive' needs the port [speed]");
  EXPECT_EQ(load(R"(<Drive speed="fast"/>)"), "t.xml:2: port [speed] is 'fast', expected a number");
  EXPECT_EQ(load(R"(<Drive speed="1" turn="2"/>)"), "t.xml:2: 'Drive' has no port [turn], it has [speed]");
}

TEST(Forms, ExplicitAndCompactAreTheSame) {
  for (const char* body : {"<Control ID=\"Sequence\"><Action ID=\"A\"/><Decorator ID=\"Inverter\"><Condition "
                           "ID=\"B\"/></Decorator></Control>",
                           "<Sequence><A/><Inverter><B/></Inverter></Sequence>"}) {
    auto tree = load_tree_text(
        tolerant(), "<root><!-- c --><BehaviorTree ID=\"M\">" + std::string(body) + "</BehaviorTree></root>");
    ASSERT_TRUE(tree.ok()) << tree.error().text;
    EXPECT_EQ(tree->tick(Time{}), NodeStatus::failure);
  }
}

}  // namespace adit::bt::test
