// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

TEST(ReactiveSequence, AsksTheConditionsInEveryTick) {
  Dry dry("<ReactiveSequence><C/><A/></ReactiveSequence>", {{"C", "S"}, {"A", "RRS"}});
  EXPECT_EQ(dry.ticks(4), (Trace{"R C A", "R C A", "S C A", "S C A"}));
}

TEST(ReactiveSequence, AFailingConditionHaltsTheRunningChild) {
  Dry dry("<ReactiveSequence><C/><A/></ReactiveSequence>", {{"C", "SSFS"}, {"A", "R"}});
  EXPECT_EQ(dry.ticks(4), (Trace{"R C A", "R C A", "F C !A", "R C A"}));
}

TEST(ReactiveSequence, ARunningConditionHaltsTheChildBehindIt) {
  Dry dry("<ReactiveSequence><C/><A/></ReactiveSequence>", {{"C", "SRS"}, {"A", "R"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R C A", "R C !A", "R C A"}));
}

TEST(ReactiveSequence, TheOthersAreIdleWhileOneRuns) {
  Dry dry(R"(<ReactiveSequence name="r"><C name="c"/><A name="a"/></ReactiveSequence>)",
          {{"c", "S"}, {"a", "R"}});
  dry.tick();
  EXPECT_EQ(dry.nodes(), "r=R a=R");
}

TEST(ReactiveSequence, HaltsInTheOrderOfItsChildren) {
  Dry dry(
      "<ReactiveSequence><C/><Parallel success_count=\"2\" "
      "failure_count=\"2\"><A/><B/></Parallel></ReactiveSequence>",
      {{"C", "SF"}, {"A", "R"}, {"B", "R"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R C A B", "F C !A !B"}));
}

TEST(ReactiveSequence, SkippedChildrenAndAllSkipped) {
  Dry dry("<ReactiveSequence><A/><B/></ReactiveSequence>", {{"A", "K"}, {"B", "SK"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"S A B", "K A B"}));
}

TEST(ReactiveFallback, AHigherChildThatSucceedsHaltsTheRunningOne) {
  Dry dry("<ReactiveFallback><C/><A/></ReactiveFallback>", {{"C", "FFS"}, {"A", "R"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R C A", "R C A", "S C !A"}));
}

TEST(ReactiveFallback, FailsWhenAllFail) {
  Dry dry("<ReactiveFallback><C/><A/></ReactiveFallback>", {{"C", "F"}, {"A", "RF"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R C A", "F C A"}));
}

TEST(ReactiveFallback, ARunningChildHaltsTheRunningOneBehindIt) {
  Dry dry("<ReactiveFallback><A/><B/></ReactiveFallback>", {{"A", "FRF"}, {"B", "R"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R A B", "R A !B", "R A B"}));
}

TEST(ReactiveFallback, AllSkippedIsSkipped) {
  Dry dry("<ReactiveFallback><A/><B/></ReactiveFallback>", {{"A", "K"}, {"B", "KF"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"K A B", "F A B"}));
}

}  // namespace adit::bt::test
