// SPDX-License-Identifier: Apache-2.0
#include "core/findings/mark_data.hpp"

#include <gtest/gtest.h>

namespace adit::findings {
namespace {

TEST(MarkData, NamesItsStationAndNothingElseDoes) {
  const Owner station{1, 2, 3, 4, 5};
  Finding mark{.key = {"op1", 7, station}, .kind = "person", .data = encode_mark()};
  EXPECT_TRUE(valid(mark));
  EXPECT_EQ(marked_by(mark), station);
  for (std::size_t i = 0; i < 5; ++i) {
    Finding other = mark;
    other.data[i] ^= 1;
    EXPECT_FALSE(marked_by(other)) << i;
  }
  mark.data.push_back(0);
  EXPECT_FALSE(marked_by(mark)) << "longer";
  mark.data.resize(4);
  EXPECT_FALSE(marked_by(mark)) << "truncated";
  mark.data.clear();
  EXPECT_FALSE(marked_by(mark));
  mark.data = encode_mark();
  mark.key.owner = {};
  EXPECT_FALSE(marked_by(mark)) << "of no station";
}

TEST(MarkData, ImportanceIsByKind) {
  EXPECT_EQ(usual_importance("person"), 9);
  EXPECT_EQ(usual_importance("gas"), 7);
  EXPECT_EQ(usual_importance("sinkhole"), 5);
  EXPECT_EQ(usual_importance(""), 5);
}

}  // namespace
}  // namespace adit::findings
