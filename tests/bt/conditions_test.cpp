// SPDX-License-Identifier: Apache-2.0
// Pre- and postconditions: _failureIf, _successIf, _skipIf, _while, _onSuccess, _onFailure, _onHalted, _post.
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

namespace {
int number(Dry& dry, const std::string& key) { return dry.tree.blackboard().get<int>(key).value(); }
}  // namespace

TEST(Preconditions, DecideWithoutTickingTheNode) {
  Dry fail(R"(<Fallback><A _failureIf="1 == 1"/><B/></Fallback>)", {{"A", "S"}, {"B", "S"}});
  EXPECT_EQ(fail.tick(), "S B");
  Dry succeed(R"(<A _successIf="true"/>)", {{"A", "F"}});
  EXPECT_EQ(succeed.tick(), "S");
  Dry skip(R"(<Sequence><A _skipIf="true"/><B/></Sequence>)", {{"A", "F"}, {"B", "S"}});
  EXPECT_EQ(skip.tick(), "S B");
}

TEST(Preconditions, AreCheckedInTheirFixedOrder) {
  Dry dry(R"(<A _skipIf="true" _successIf="true" _failureIf="true"/>)", {{"A", "S"}});
  EXPECT_EQ(dry.tick(), "F");
}

TEST(Preconditions, AreCheckedOnlyWhenTheNodeStarts) {
  Dry dry(R"(<Sequence><Script code="stop := false"/><A _skipIf="stop" _failureIf="stop"/></Sequence>)",
          {{"A", "RRS"}});
  EXPECT_EQ(dry.tick(), "R A");
  ASSERT_TRUE(dry.tree.blackboard().put("stop", true));
  EXPECT_EQ(dry.ticks(2), (Trace{"R A", "S A"}));
}

TEST(Preconditions, WhileHaltsTheRunningNodeAndSkipsIt) {
  Dry dry(R"(<Sequence><Script code="go := true"/><A _while="go"/><B/></Sequence>)",
          {{"A", "R"}, {"B", "S"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R A", "R A"}));
  ASSERT_TRUE(dry.tree.blackboard().put("go", false));
  EXPECT_EQ(dry.tick(), "S !A B");
}

TEST(Preconditions, AScriptThatFailsIsAFailureOfTheNode) {
  Dry dry(R"(<Fallback><A _skipIf="unknown"/><B/></Fallback>)", {{"A", "S"}, {"B", "S"}});
  EXPECT_EQ(dry.tick(), "S B");
  EXPECT_EQ(dry.errors.size(), 1u);
}

TEST(Postconditions, RunAfterTheNodeCompleted) {
  Dry dry(R"(<Sequence><Script code="s := 0; f := 0; p := 0"/>
            <Fallback _onSuccess="s += 10" _post="p += 100"><A _onFailure="f += 1" _onSuccess="s += 1" _post="p += 1"/><B/></Fallback></Sequence>)",
          {{"A", "RFS"}, {"B", "S"}});
  EXPECT_EQ(dry.tick(), "R A");
  EXPECT_EQ(number(dry, "p"), 0);
  EXPECT_EQ(dry.tick(), "S A B");
  EXPECT_EQ(number(dry, "s"), 10);
  EXPECT_EQ(number(dry, "f"), 1);
  EXPECT_EQ(number(dry, "p"), 101);
}

TEST(Postconditions, OnHaltedRunsWhenTheNodeIsHaltedAndNotWhenSkipped) {
  Dry dry(
      R"(<Sequence><Script code="h := 0; p := 0"/><ReactiveSequence><C/><A _onHalted="h += 1"/><B _skipIf="true" _post="p += 1"/></ReactiveSequence></Sequence>)",
      {{"C", "SF"}, {"A", "R"}});
  dry.tick();
  EXPECT_EQ(number(dry, "h"), 0);
  EXPECT_EQ(dry.tick(), "F C !A");
  EXPECT_EQ(number(dry, "h"), 1);
  EXPECT_EQ(number(dry, "p"), 0);
}

TEST(Precondition, TicksItsChildToTheEndOnceItHeld) {
  Dry dry(
      R"(<Sequence><Script code="ok := true"/><Precondition if="ok" else="SKIPPED"><A/></Precondition></Sequence>)",
      {{"A", "RRS"}});
  EXPECT_EQ(dry.tick(), "R A");
  ASSERT_TRUE(dry.tree.blackboard().put("ok", false));
  EXPECT_EQ(dry.ticks(2), (Trace{"R A", "S A"}));
}

TEST(Precondition, AnswersElseWhenItDoesNotHold) {
  Dry dry(R"(<Fallback><Precondition if="1 == 2"><A/></Precondition><B/></Fallback>)",
          {{"A", "S"}, {"B", "S"}});
  EXPECT_EQ(dry.tick(), "S B");
  Dry running(R"(<Precondition if="1 == 2" else="RUNNING"><A/></Precondition>)", {{"A", "S"}});
  EXPECT_EQ(running.ticks(2), (Trace{"R", "R"}));
}

TEST(Skipped, ASkippedControlNodeKeepsItsStatusUntilItsParentResetsIt) {
  Dry dry(R"(<Sequence name="root"><A name="a"/></Sequence>)", {{"a", "K"}});
  EXPECT_EQ(dry.tick(), "K a");
  EXPECT_EQ(dry.nodes(), "root=R");  // skipping leaves the RUNNING that tick() had set, as in the reference
}

}  // namespace adit::bt::test
