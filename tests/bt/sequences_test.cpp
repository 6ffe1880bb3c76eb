// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

TEST(Sequence, ResumesAtTheRunningChildAndStartsOverAfterSuccess) {
  Dry dry("<Sequence><A/><B/><C/></Sequence>", {{"A", "S"}, {"B", "RRS"}, {"C", "S"}});
  EXPECT_EQ(dry.ticks(5), (Trace{"R A B", "R B", "S B C", "S A B C", "S A B C"}));
}

TEST(Sequence, FailureEndsItAndTheNextTickStartsOver) {
  Dry dry("<Sequence><A/><B/><C/></Sequence>", {{"A", "S"}, {"B", "RF"}, {"C", "S"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R A B", "F B", "F A B"}));
}

TEST(Sequence, NodesAreIdleOnceItCompleted) {
  Dry dry(R"(<Sequence name="root"><A name="a"/><B name="b"/></Sequence>)", {{"b", "RS"}});
  dry.tick();
  EXPECT_EQ(dry.nodes(), "root=R a=S b=R");
  dry.tick();
  EXPECT_EQ(dry.nodes(), "");
}

TEST(Sequence, SkippedChildrenAreStepsOverAndAllSkippedIsSkipped) {
  Dry dry("<Sequence><A/><B/></Sequence>", {{"A", "KK"}, {"B", "SK"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"S A B", "K A B"}));
}

TEST(Sequence, HaltStopsTheRunningChildAndForgetsThePlace) {
  Dry dry("<Sequence><A/><B/></Sequence>", {{"A", "S"}, {"B", "R"}});
  EXPECT_EQ(dry.tick(), "R A B");
  EXPECT_EQ(dry.halt(), " !B");
  EXPECT_EQ(dry.nodes(), "");
  EXPECT_EQ(dry.tick(), "R A B");
}

TEST(AsyncSequence, YieldsAfterEachChildThatSucceedsAtOnce) {
  Dry dry("<AsyncSequence><A/><B/><C/></AsyncSequence>", {{"A", "S"}, {"B", "RS"}, {"C", "S"}});
  // B was running before it succeeded: no yield between B and C.
  EXPECT_EQ(dry.ticks(3), (Trace{"R A", "R B", "S B C"}));
}

TEST(Fallback, ResumesAtTheRunningChildAndSuccessEndsIt) {
  Dry dry("<Fallback><A/><B/><C/></Fallback>", {{"A", "F"}, {"B", "RFS"}, {"C", "F"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R A B", "F B C", "S A B"}));
}

TEST(Fallback, AllSkippedIsSkipped) {
  Dry dry("<Fallback><A/><B/></Fallback>", {{"A", "K"}, {"B", "FK"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"F A B", "K A B"}));
}

TEST(AsyncFallback, YieldsAfterEachChildThatFailsAtOnce) {
  Dry dry("<AsyncFallback><A/><B/></AsyncFallback>", {{"A", "F"}, {"B", "F"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R A", "F B"}));
}

TEST(SequenceWithMemory, KeepsItsPlaceAfterAFailure) {
  Dry dry("<SequenceWithMemory><A/><B/><C/></SequenceWithMemory>", {{"A", "RS"}, {"B", "FRS"}, {"C", "S"}});
  // Tick 2: A had been running, so B follows in the same tick and fails; A is not asked again.
  EXPECT_EQ(dry.ticks(5), (Trace{"R A", "F A B", "R B", "S B C", "R A"}));
}

TEST(SequenceWithMemory, YieldsAfterAChildThatSucceedsAtOnce) {
  Dry dry("<SequenceWithMemory><A/><B/></SequenceWithMemory>", {{"A", "S"}, {"B", "S"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R A", "S B", "R A"}));
}

TEST(SequenceWithMemory, KeepsItsPlaceWhenHalted) {
  Dry dry("<SequenceWithMemory><A/><B/></SequenceWithMemory>", {{"A", "S"}, {"B", "R"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R A", "R B"}));
  EXPECT_EQ(dry.halt(), " !B");
  EXPECT_EQ(dry.tick(), "R B");
}

}  // namespace adit::bt::test
