// SPDX-License-Identifier: Apache-2.0
#include "core/bt/draw.hpp"

#include "tests/bt/dry.hpp"

namespace adit::bt::test {

TEST(Draw, Text) {
  Dry dry(R"(<Sequence name="go"><A/><Repeat num_cycles="2"><SubTree ID="S" x="{y}"/></Repeat></Sequence>)",
          {}, R"(<BehaviorTree ID="S"><B _skipIf="1"/></BehaviorTree>)");
  EXPECT_EQ(draw_text(dry.tree),
            "Main\n"
            "└─ Sequence \"go\"\n"
            "   ├─ A\n"
            "   └─ Repeat  num_cycles=2\n"
            "      └─ SubTree S  x={y}\n"
            "         └─ B  _skipIf\n");
}

TEST(Draw, DotHasEveryNodeAndEdgeAndQuotes) {
  Dry dry(R"(<Sequence name="say &quot;hi&quot;"><A/><B/></Sequence>)");
  const auto dot = draw_dot(dry.tree);
  EXPECT_NE(dot.find("digraph \"Main\""), std::string::npos);
  EXPECT_NE(dot.find(R"(say \"hi\")"), std::string::npos) << dot;
  EXPECT_NE(dot.find("n0 -> n1;"), std::string::npos);
  EXPECT_NE(dot.find("n0 -> n2;"), std::string::npos);
}

}  // namespace adit::bt::test
