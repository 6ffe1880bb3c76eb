// SPDX-License-Identifier: Apache-2.0
#include "tests/bt/dry.hpp"

namespace adit::bt::test {

namespace {
constexpr const char* kSwitch =
    R"(<Switch3 variable="{v}" case_1="1" case_2="two" case_3="3.5"><A/><B/><C/><D/></Switch3>)";
}

TEST(Switch, PicksByTextIntegerOrNumberElseTheLastChild) {
  Dry dry(kSwitch, {{"A", "S"}, {"B", "S"}, {"C", "S"}, {"D", "S"}});
  EXPECT_EQ(dry.tick(), "S D");  // no variable yet
  ASSERT_TRUE(dry.tree.blackboard().put("v", 1));
  EXPECT_EQ(dry.tick(), "S A");
  ASSERT_TRUE(dry.tree.blackboard().put("v", std::string("two")));
  EXPECT_EQ(dry.tick(), "S B");
  ASSERT_TRUE(dry.tree.blackboard().put("v", 3.5));
  EXPECT_EQ(dry.tick(), "S C");
}

TEST(Switch, HaltsTheRunningChildWhenTheVariableChanges) {
  Dry dry(kSwitch, {{"A", "R"}, {"B", "RS"}, {"D", "S"}});
  ASSERT_TRUE(dry.tree.blackboard().put("v", std::string("1")));
  EXPECT_EQ(dry.tick(), "R A");
  ASSERT_TRUE(dry.tree.blackboard().put("v", std::string("two")));
  EXPECT_EQ(dry.tick(), "R !A B");
  EXPECT_EQ(dry.tick(), "S B");
}

TEST(Switch, ASkippedChildSkipsIt) {
  Dry dry(kSwitch, {{"D", "KS"}});
  EXPECT_EQ(dry.ticks(2), (Trace{"K D", "S D"}));
}

TEST(Switch, EveryVariantTakesItsNumberOfCases) {
  for (int cases = 2; cases <= 6; ++cases) {
    std::string attributes, children;
    for (int i = 1; i <= cases; ++i) {
      attributes += " case_" + std::to_string(i) + "=\"k" + std::to_string(i) + "\"";
      children += "<L" + std::to_string(i) + "/>";
    }
    const std::string last = "L" + std::to_string(cases);
    const std::string tag = "Switch" + std::to_string(cases);
    Dry dry("<" + tag + " variable=\"k" + std::to_string(cases) + "\"" + attributes + ">" + children +
                "<D/></" + tag + ">",
            {{last, "S"}, {"D", "F"}});
    EXPECT_EQ(dry.tick(), "S " + last);
  }
}

}  // namespace adit::bt::test
