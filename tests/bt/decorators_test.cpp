// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

TEST(Inverter, TurnsTheAnswerRoundAndPassesTheRestOn) {
  Dry dry("<Inverter><A/></Inverter>", {{"A", "RSFK"}});
  EXPECT_EQ(dry.ticks(4), (Trace{"R A", "F A", "S A", "K A"}));
}

TEST(ForceSuccess, ChangesOnlyTheEnd) {
  Dry dry("<ForceSuccess><A/></ForceSuccess>", {{"A", "RFSK"}});
  EXPECT_EQ(dry.ticks(4), (Trace{"R A", "S A", "S A", "K A"}));
}

TEST(ForceFailure, ChangesOnlyTheEnd) {
  Dry dry("<ForceFailure><A/></ForceFailure>", {{"A", "RSF"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"R A", "F A", "F A"}));
}

TEST(KeepRunningUntilFailure, StartsTheChildAgainUntilItFails) {
  Dry dry(R"(<KeepRunningUntilFailure name="k"><A name="a"/></KeepRunningUntilFailure>)", {{"a", "SRSKF"}});
  EXPECT_EQ(dry.tick(), "R a");
  EXPECT_EQ(dry.nodes(), "k=R");  // the child was reset
  EXPECT_EQ(dry.ticks(4), (Trace{"R a", "R a", "R a", "F a"}));
}

TEST(RunOnce, SkipsAfterItsOneTime) {
  Dry dry("<Sequence><RunOnce><A/></RunOnce><B/></Sequence>", {{"A", "RS"}, {"B", "S"}});
  EXPECT_EQ(dry.ticks(4), (Trace{"R A", "S A B", "S B", "S B"}));
}

TEST(RunOnce, OrGivesTheSameAnswerForEver) {
  Dry dry(R"(<Inverter><RunOnce then_skip="false"><A/></RunOnce></Inverter>)", {{"A", "FS"}});
  EXPECT_EQ(dry.ticks(3), (Trace{"S A", "S", "S"}));
}

TEST(RunOnce, AHaltBeforeTheEndDoesNotCount) {
  Dry dry("<RunOnce><A/></RunOnce>", {{"A", "RRS"}});
  EXPECT_EQ(dry.tick(), "R A");
  EXPECT_EQ(dry.halt(), " !A");
  EXPECT_EQ(dry.ticks(3), (Trace{"R A", "S A", "K"}));
}

TEST(Decorators, AHaltGoesThroughToTheLeaf) {
  Dry dry(
      "<Inverter><ForceSuccess><KeepRunningUntilFailure><A/></KeepRunningUntilFailure></ForceSuccess></"
      "Inverter>",
      {{"A", "R"}});
  EXPECT_EQ(dry.tick(), "R A");
  EXPECT_EQ(dry.halt(), " !A");
}

}  // namespace adit::bt::test
