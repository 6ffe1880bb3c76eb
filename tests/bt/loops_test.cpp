// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

TEST(Repeat, YieldsAfterEachChildThatSucceedsAtOnce) {
  Dry dry(R"(<Repeat num_cycles="3"><A/></Repeat>)", {{"A", "S"}});
  EXPECT_EQ(dry.ticks(4), (Trace{"R A", "R A", "S A", "R A"}));
}

TEST(Repeat, GoesOnInTheSameTickAfterAChildThatWasRunning) {
  Dry dry(R"(<Repeat num_cycles="2"><A/></Repeat>)", {{"A", "RSRS"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R A", "R A A", "S A"}));
}

TEST(Repeat, AFailureEndsItAndResetsTheCount) {
  Dry dry(R"(<Repeat num_cycles="2"><A/></Repeat>)", {{"A", "SFSS"}});
  EXPECT_EQ(dry.ticks(4), (Trace{"R A", "F A", "R A", "S A"}));
}

TEST(Repeat, ZeroCyclesSucceedWithoutTickingAndMinusOneNeverEnds) {
  Dry none(R"(<Repeat num_cycles="0"><A/></Repeat>)", {{"A", "S"}});
  EXPECT_EQ(none.tick(), "S");
  Dry endless(R"(<Repeat num_cycles="-1"><A/></Repeat>)", {{"A", "S"}});
  EXPECT_EQ(endless.ticks(50).back(), "R A");
}

TEST(Repeat, ASkippedChildSkipsItAndTheCountStays) {
  Dry dry(R"(<Repeat num_cycles="2"><A/></Repeat>)", {{"A", "SKS"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R A", "K A", "S A"}));
}

TEST(Repeat, AHaltResetsTheCount) {
  Dry dry(R"(<Repeat num_cycles="2"><A/></Repeat>)", {{"A", "SRSS"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R A", "R A"}));
  EXPECT_EQ(dry.halt(), " !A");
  EXPECT_EQ(dry.ticks(2), (Trace{"R A", "S A"}));
}

TEST(RetryUntilSuccessful, RetriesTheGivenNumberOfTimesAndYieldsBetween) {
  Dry dry(R"(<RetryUntilSuccessful num_attempts="3"><A/></RetryUntilSuccessful>)", {{"A", "F"}});
  EXPECT_EQ(dry.ticks(4), (Trace{"R A", "R A", "F A", "R A"}));
  Dry good(R"(<RetryUntilSuccessful num_attempts="3"><A/></RetryUntilSuccessful>)", {{"A", "FS"}});
  EXPECT_EQ(good.ticks(2), (Trace{"R A", "S A"}));
}

TEST(RetryUntilSuccessful, AReactiveParentCanInterruptBetweenAttempts) {
  Dry dry(
      R"(<ReactiveSequence><C/><RetryUntilSuccessful num_attempts="5"><A/></RetryUntilSuccessful></ReactiveSequence>)",
      {{"C", "SF"}, {"A", "F"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R C A", "F C"}));
}

TEST(RetryUntilSuccessful, ReadsItsLimitAgainAfterEachAttempt) {
  Dry dry(
      R"(<Sequence><Script code="n := 5"/><RetryUntilSuccessful num_attempts="{n}"><Sequence><A/><Script code="n = 1"/>
          <AlwaysFailure/></Sequence></RetryUntilSuccessful></Sequence>)",
      {{"A", "S"}});
  EXPECT_EQ(dry.tick(), "F A");
}

}  // namespace adit::bt::test
