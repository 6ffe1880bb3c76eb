// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

TEST(TryCatch, RunsTheLastChildOnlyWhenAnotherFails) {
  Dry dry("<TryCatch><A/><B/><Z/></TryCatch>", {{"A", "S"}, {"B", "RSF"}, {"Z", "RS"}});
  EXPECT_EQ(dry.ticks(4), (Trace{"R A B", "S B", "R A B Z", "F Z"}));
}

TEST(TryCatch, CatchOnHaltTicksTheLastChildOnce) {
  Dry quiet("<TryCatch><A/><Z/></TryCatch>", {{"A", "R"}, {"Z", "S"}});
  quiet.tick();
  EXPECT_EQ(quiet.halt(), " !A");
  Dry dry(R"(<TryCatch catch_on_halt="true"><A/><Z/></TryCatch>)", {{"A", "R"}, {"Z", "R"}});
  dry.tick();
  EXPECT_EQ(dry.halt(), " !A Z !Z");
}

TEST(TryCatch, AllSkippedIsSkipped) {
  Dry dry("<TryCatch><A/><B/><Z/></TryCatch>", {{"A", "K"}, {"B", "K"}, {"Z", "S"}});
  EXPECT_EQ(dry.tick(), "K A B");
}

}  // namespace adit::bt::test
