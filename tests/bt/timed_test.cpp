// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

// Dry ticks every 10 ms, from 0. Timers run between ticks, as the reference's timer thread does.

TEST(Delay, TicksItsChildOnceTheTimeIsOver) {
  Dry dry(R"(<Delay delay_msec="25"><A/></Delay>)", {{"A", "RSS"}});
  EXPECT_EQ(dry.ticks(5), (Trace{"R", "R", "R", "R A", "S A"}));
  EXPECT_EQ(dry.tick(), "R") << "and waits again";
}

TEST(Delay, NeverEndsInTheTickThatStartsIt) {
  Dry dry(R"(<Delay delay_msec="0"><A/></Delay>)", {{"A", "S"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R", "S A"}));
}

TEST(Delay, AHaltStartsTheWaitAnew) {
  Dry dry(R"(<Delay delay_msec="15"><A/></Delay>)", {{"A", "S"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R", "R"}));
  dry.halt();
  EXPECT_EQ(dry.ticks(3), (Trace{"R", "R", "S A"}));
}

TEST(Timeout, HaltsTheChildAndFails) {
  Dry dry(R"(<Timeout msec="15" name="t"><A name="a"/></Timeout>)", {{"a", "R"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R a", "R a", "F !a"}));
  EXPECT_EQ(dry.nodes(), "");
  EXPECT_EQ(dry.ticks(3), (Trace{"R a", "R a", "F !a"}));
}

TEST(Timeout, AChildThatCompletesInTimeCancelsIt) {
  Dry dry(R"(<Timeout msec="15"><A/></Timeout>)", {{"A", "RSRRF"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R A", "S A"}));
  EXPECT_EQ(dry.ticks(3), (Trace{"R A", "R A", "F !A"}));
}

TEST(Timeout, ZeroMeansNoLimit) {
  Dry dry(R"(<Timeout msec="0"><A/></Timeout>)", {{"A", "R"}});
  EXPECT_EQ(dry.ticks(20).back(), "R A");
}

TEST(Timeout, ChildrenBehindItGoOnWhenItFails) {
  Dry dry(R"(<Fallback><Timeout msec="10"><A/></Timeout><B/></Fallback>)", {{"A", "R"}, {"B", "S"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"R A", "S !A B"}));
}

TEST(Timeout, HaltsFromTheInsideOutInOrderOfDeadlines) {
  Dry dry(
      R"(<Parallel failure_count="2"><Timeout msec="18"><A/></Timeout><Timeout msec="12"><B/></Timeout></Parallel>)",
      {{"A", "R"}, {"B", "R"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R A B", "R A B", "F !B !A"}));
}

TEST(Sleep, RunsForItsTime) {
  Dry dry(R"(<Sequence><Sleep msec="15" name="s"/><A/></Sequence>)", {{"A", "S"}});
  EXPECT_EQ(dry.tick(), "R");
  EXPECT_EQ(dry.nodes(), "s=R");
  EXPECT_EQ(dry.ticks(2), (Trace{"R", "S A"}));
}

TEST(Sleep, ZeroSucceedsAtOnceAndAHaltStartsItAnew) {
  Dry none(R"(<Sleep msec="0"/>)");
  EXPECT_EQ(none.tick(), "S");
  Dry dry(R"(<Sleep msec="15"/>)");
  EXPECT_EQ(dry.ticks(2), (Trace{"R", "R"}));
  dry.halt();
  EXPECT_EQ(dry.ticks(3), (Trace{"R", "R", "S"}));
}

}  // namespace adit::bt::test
