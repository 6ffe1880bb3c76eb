// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

TEST(IfThenElse, RunsTheChosenBranchToItsEndWithoutAskingAgain) {
  Dry dry("<IfThenElse><C/><A/><B/></IfThenElse>", {{"C", "RSF"}, {"A", "RRS"}, {"B", "RS"}});
  EXPECT_EQ(dry.ticks(6), (Trace{"R C", "R C A", "R A", "S A", "R C B", "S B"}));
}

TEST(IfThenElse, WithoutElseAFalseConditionIsAFailure) {
  Dry dry(R"(<IfThenElse><C name="c"/><A/></IfThenElse>)", {{"c", "FS"}, {"A", "S"}});
  EXPECT_EQ(dry.tick(), "F c");
  // As in the reference the condition is not reset then: it keeps its answer and is not visited again.
  EXPECT_EQ(dry.nodes(), "c=F");
  EXPECT_EQ(dry.tick(), "F");
}

TEST(IfThenElse, HaltForgetsTheBranch) {
  Dry dry("<IfThenElse><C/><A/><B/></IfThenElse>", {{"C", "SF"}, {"A", "R"}, {"B", "S"}});
  EXPECT_EQ(dry.tick(), "R C A");
  EXPECT_EQ(dry.halt(), " !A");
  EXPECT_EQ(dry.tick(), "S C B");
}

TEST(IfThenElse, ASkippedConditionFailsAndIsReported) {
  Dry dry("<IfThenElse><C/><A/></IfThenElse>", {{"C", "K"}});
  EXPECT_EQ(dry.tick(), "F C");
  EXPECT_EQ(dry.errors.size(), 1u);
}

TEST(WhileDoElse, AConditionThatKeepsItsAnswerIsNotVisitedAgain) {
  // The condition is a stateful leaf: it succeeded and was not reset, so its answer is still valid.
  Dry dry("<WhileDoElse><C/><A/><B/></WhileDoElse>", {{"C", "SF"}, {"A", "RRS"}, {"B", "S"}});
  EXPECT_EQ(dry.ticks(4), (Trace{"R C A", "R A", "S A", "S C B"}));
}

TEST(WhileDoElse, HaltsTheOtherBranchWhenTheConditionTurnsOver) {
  // Inverter resets its child in every tick, so that the condition is asked again.
  Dry dry("<WhileDoElse><Inverter><C/></Inverter><A/><B/></WhileDoElse>",
          {{"C", "FSF"}, {"A", "R"}, {"B", "R"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R C A", "R C !A B", "R C !B A"}));
}

TEST(WhileDoElse, WithoutElseItHaltsTheBranchAndFails) {
  Dry dry("<WhileDoElse><Inverter><C/></Inverter><A/></WhileDoElse>", {{"C", "FS"}, {"A", "R"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R C A", "F C !A"}));
}

TEST(WhileDoElse, ARunningConditionLeavesTheBranchAsItIs) {
  Dry dry("<WhileDoElse><Inverter><C/></Inverter><A/><B/></WhileDoElse>", {{"C", "FRF"}, {"A", "RRS"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R C A", "R C", "R C A"}));
}

TEST(WhileDoElse, ASkippedConditionFailsAndIsReported) {
  Dry dry("<WhileDoElse><C/><A/></WhileDoElse>", {{"C", "K"}});
  EXPECT_EQ(dry.tick(), "F C");
  EXPECT_EQ(dry.errors.size(), 1u);
}

}  // namespace adit::bt::test
