// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/ddmin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace adit::sim {
namespace {

bool holds(const Indices& kept, std::size_t i) { return std::binary_search(kept.begin(), kept.end(), i); }

TEST(Ddmin, FindsTheOneThatMatters) {
  for (std::size_t guilty = 0; guilty < 20; ++guilty)
    EXPECT_EQ(ddmin(20, [&](const Indices& kept) { return holds(kept, guilty); }), Indices{guilty});
}

TEST(Ddmin, FindsSeveralFarApart) {
  const Indices guilty{1, 7, 18};
  const auto fails = [&](const Indices& kept) {
    return std::all_of(guilty.begin(), guilty.end(), [&](std::size_t g) { return holds(kept, g); });
  };
  EXPECT_EQ(ddmin(20, fails), guilty);
}

TEST(Ddmin, NothingIsLeftWhenNothingIsNeeded) {
  int asked = 0;
  EXPECT_TRUE(ddmin(20, [&](const Indices&) { return ++asked > 0; }).empty());
  EXPECT_EQ(asked, 1);
  EXPECT_TRUE(ddmin(0, [](const Indices&) { return false; }).empty());
}

TEST(Ddmin, AllAreLeftWhenAllAreNeeded) {
  EXPECT_EQ(ddmin(5, [](const Indices& kept) { return kept.size() == 5; }).size(), 5U);
}

TEST(Ddmin, NeverAsksTwice) {
  std::set<Indices> asked;
  ddmin(30, [&](const Indices& kept) {
    EXPECT_TRUE(asked.insert(kept).second);
    return holds(kept, 3) && (holds(kept, 20) || holds(kept, 21));
  });
  EXPECT_LT(asked.size(), 100U);
}

TEST(Fewer, FindsTheSmallestChoiceThatDdminMisses) {
  // 1-minimal: {0, 1, 2}; and 9 alone fails, too.
  const auto fails = [](const Indices& kept) {
    return holds(kept, 9) || (holds(kept, 0) && holds(kept, 1) && holds(kept, 2));
  };
  EXPECT_EQ(fewer(10, 3, 2, 100, fails), std::vector<Indices>{{9}});
  EXPECT_TRUE(fewer(10, 3, 2, 5, fails).empty()) << "no more than so many questions";
  EXPECT_TRUE(fewer(10, 1, 2, 100, fails).empty()) << "nothing smaller than one but nothing";
}

}  // namespace
}  // namespace adit::sim
