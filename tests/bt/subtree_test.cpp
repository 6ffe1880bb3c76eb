// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

namespace {
std::string text_at(Dry& dry, const std::string& key) {
  return dry.tree.blackboard().get<std::string>(key).value();
}
bool has(Dry& dry, const std::string& key) { return dry.tree.blackboard().find(key) != nullptr; }
std::string sub(const std::string& body) { return R"(<BehaviorTree ID="Sub">)" + body + "</BehaviorTree>"; }
}  // namespace

TEST(SubTree, RunsTheOtherTreeAndIsHaltedWithIt) {
  Dry dry(R"(<ReactiveSequence><C/><SubTree ID="Sub" name="s"/></ReactiveSequence>)",
          {{"C", "SF"}, {"A", "R"}}, sub(R"(<Sequence name="inner"><A/></Sequence>)"));
  EXPECT_EQ(dry.tick(), "R C A");
  EXPECT_EQ(dry.nodes(), "s=R inner=R");
  EXPECT_EQ(dry.tick(), "F C !A");
}

TEST(SubTree, HasABlackboardOfItsOwn) {
  Dry dry(R"(<SubTree ID="Sub"/>)", {}, sub(R"(<SetBlackboard value="42" output_key="x"/>)"));
  EXPECT_EQ(dry.tick(), "S");
  EXPECT_FALSE(has(dry, "x"));
}

TEST(SubTree, RemappedPortsReadAndWriteTheParents) {
  Dry dry(
      R"(<Sequence><SetBlackboard value="7" output_key="outer_in"/><SubTree ID="Sub" in="{outer_in}" out="{outer_out}"/></Sequence>)",
      {}, sub(R"(<SetBlackboard value="{in}" output_key="out"/>)"));
  EXPECT_EQ(dry.tick(), "S");
  EXPECT_EQ(text_at(dry, "outer_out"), "7");
  EXPECT_FALSE(has(dry, "out"));
}

TEST(SubTree, EqualsSignRemapsToTheSameName) {
  Dry dry(R"(<SubTree ID="Sub" x="{=}"/>)", {}, sub(R"(<SetBlackboard value="1" output_key="x"/>)"));
  dry.tick();
  EXPECT_EQ(text_at(dry, "x"), "1");
}

TEST(SubTree, ATextBecomesAConstantInside) {
  Dry dry(R"(<SubTree ID="Sub" speed="2.5" out="{=}"/>)", {},
          sub(R"(<SetBlackboard value="{speed}" output_key="out"/>)"));
  dry.tick();
  EXPECT_EQ(text_at(dry, "out"), "2.5");
  EXPECT_FALSE(has(dry, "speed"));
}

TEST(SubTree, AutoremapSharesAllButPrivateNames) {
  Dry dry(
      R"(<SubTree ID="Sub" _autoremap="true" fixed="1"/>)", {},
      sub(R"(<Sequence><SetBlackboard value="a" output_key="x"/><SetBlackboard value="b" output_key="_y"/></Sequence>)"));
  EXPECT_EQ(dry.tick(), "S");
  EXPECT_EQ(text_at(dry, "x"), "a");
  EXPECT_FALSE(has(dry, "_y"));
  EXPECT_FALSE(has(dry, "fixed"));
}

TEST(SubTree, RemappingGoesThroughSeveralLevels) {
  Dry dry(R"(<SubTree ID="Mid" m="{top}"/>)", {},
          R"(<BehaviorTree ID="Mid"><SubTree ID="Sub" s="{m}"/></BehaviorTree>)" +
              sub(R"(<SetBlackboard value="deep" output_key="s"/>)"));
  dry.tick();
  EXPECT_EQ(text_at(dry, "top"), "deep");
}

TEST(SubTree, AtSignReachesTheOutermostBlackboard) {
  Dry dry(R"(<SubTree ID="Sub"/>)", {}, sub(R"(<Script code="@count := 3"/>)"));
  dry.tick();
  EXPECT_EQ(dry.tree.blackboard().get<int>("count").value(), 3);
}

TEST(SubTree, ModelGivesDefaultsAndDemandsPorts) {
  const std::string model =
      R"(<TreeNodesModel><SubTree ID="Sub"><input_port name="a" default="5"/><output_port name="b" default="{result}"/>
      </SubTree><Action ID="Other"/></TreeNodesModel>)";
  Dry dry(R"(<SubTree ID="Sub"/>)", {}, sub(R"(<SetBlackboard value="{a}" output_key="b"/>)") + model);
  dry.tick();
  EXPECT_EQ(text_at(dry, "result"), "5");
}

TEST(SubTree, TwoUsesOfATreeAreTwoInstances) {
  Dry dry(R"(<Sequence><SubTree ID="Sub" x="1" out="{p}"/><SubTree ID="Sub" x="2" out="{q}"/></Sequence>)",
          {}, sub(R"(<RunOnce><SetBlackboard value="{x}" output_key="out"/></RunOnce>)"));
  dry.tick();
  EXPECT_EQ(text_at(dry, "p") + text_at(dry, "q"), "12");
}

}  // namespace adit::bt::test
