// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

TEST(Parallel, ByDefaultWaitsForAllAndFailsAtTheFirstFailure) {
  Dry dry("<Parallel><A/><B/><C/></Parallel>", {{"A", "RS"}, {"B", "SS"}, {"C", "RRS"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R A B C", "R A C", "S C"}));
  Dry failing("<Parallel><A/><B/><C/></Parallel>", {{"A", "R"}, {"B", "RF"}, {"C", "R"}});
  EXPECT_EQ(failing.ticks(2), (Trace{"R A B C", "F A B !A !C"}));
}

TEST(Parallel, DecidesAfterEachChildSoThatLaterOnesAreNotTicked) {
  Dry dry(R"(<Parallel success_count="1"><A/><B/><C/></Parallel>)", {{"A", "RS"}, {"B", "R"}, {"C", "R"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R A B C", "S A !B !C"}));
}

TEST(Parallel, FailsWhenItCanNoLongerSucceed) {
  Dry dry(R"(<Parallel success_count="2" failure_count="3"><A/><B/><C/></Parallel>)",
          {{"A", "F"}, {"B", "F"}, {"C", "R"}});
  EXPECT_EQ(dry.ticks(1), (Trace{"F A B"}));
}

TEST(Parallel, NegativeCountsCountFromTheNumberOfChildren) {
  Dry dry(R"(<Parallel success_count="-2" failure_count="-1"><A/><B/><C/></Parallel>)",
          {{"A", "S"}, {"B", "R"}, {"C", "RS"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R A B C", "S B C !B"}));
}

TEST(Parallel, ACompletedChildKeepsItsStatusUntilTheEnd) {
  Dry dry(R"(<Parallel name="p"><A name="a"/><B name="b"/></Parallel>)", {{"a", "S"}, {"b", "RRS"}});
  dry.ticks(2);
  EXPECT_EQ(dry.nodes(), "p=R a=S b=R");
}

TEST(Parallel, SkippedChildrenCountAsDoneOnlyForNegativeCounts) {
  Dry all("<Parallel><A/><B/></Parallel>", {{"A", "K"}, {"B", "S"}});
  EXPECT_EQ(all.tick(), "S A B");
  Dry two(R"(<Parallel success_count="2"><A/><B/></Parallel>)", {{"A", "K"}, {"B", "S"}});
  EXPECT_EQ(two.tick(), "R A B");
  EXPECT_EQ(two.tick(), "R A");
}

TEST(Parallel, HaltForgetsWhatWasDone) {
  Dry dry("<Parallel><A/><B/></Parallel>", {{"A", "S"}, {"B", "R"}});
  EXPECT_EQ(dry.tick(), "R A B");
  EXPECT_EQ(dry.halt(), " !B");
  EXPECT_EQ(dry.tick(), "R A B");
}

TEST(Parallel, ThresholdsFromTheBlackboardThatAreTooLargeFailAndAreReported) {
  Dry dry(R"(<Sequence><Script code="n := 5"/><Parallel success_count="{n}"><A/></Parallel></Sequence>)",
          {{"A", "S"}});
  EXPECT_EQ(dry.tick(), "F");
  ASSERT_EQ(dry.errors.size(), 1u);
  EXPECT_NE(dry.errors[0].find("never succeed"), std::string::npos);
}

TEST(ParallelAll, WaitsForEveryChildAlsoAfterFailures) {
  Dry dry(R"(<ParallelAll max_failures="2"><A/><B/><C/></ParallelAll>)",
          {{"A", "F"}, {"B", "RRS"}, {"C", "S"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R A B C", "R B", "S B"}));
  Dry failing("<ParallelAll><A/><B/></ParallelAll>", {{"A", "F"}, {"B", "RS"}});
  EXPECT_EQ(failing.ticks(2), (Trace{"R A B", "F B"}));
}

}  // namespace adit::bt::test
