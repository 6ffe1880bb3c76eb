// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/ddmin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace adit::sim {
namespace {

bool holds(const Indices& remaining, std::size_t i) {
  return std::binary_search(remaining.begin(), remaining.end(), i);
}

TEST(Ddmin, FindsTheOneThatMatters) {
  for (std::size_t guilty = 0; guilty < 20; ++guilty)
    EXPECT_EQ(ddmin(20, [&](const Indices& remaining) { return holds(remaining, guilty); }), Indices{guilty});
}

TEST(Ddmin, FindsSeveralFarApart) {
  const Indices guilty{1, 7, 18};
  const auto fails = [&](const Indices& remaining) {
    return std::all_of(guilty.begin(), guilty.end(), [&](std::size_t g) { return holds(remaining, g); });
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
  EXPECT_EQ(ddmin(5, [](const Indices& remaining) { return remaining.size() == 5; }).size(), 5U);
}

TEST(Ddmin, NeverAsksTwice) {
  std::set<Indices> asked;
  ddmin(30, [&](const Indices& remaining) {
    EXPECT_TRUE(asked.insert(remaining).second);
    return holds(remaining, 3) && (holds(remaining, 20) || holds(remaining, 21));
  });
  EXPECT_LT(asked.size(), 100U);
}

TEST(Fewer, FindsTheSmallestChoiceThatDdminMisses) {
  // 1-minimal: {0, 1, 2}; and 9 alone fails, too.
  const auto fails = [](const Indices& remaining) {
    return holds(remaining, 9) || (holds(remaining, 0) && holds(remaining, 1) && holds(remaining, 2));
  };
  EXPECT_EQ(fewer(10, 3, 2, 100, fails), std::vector<Indices>{{9}});
  EXPECT_TRUE(fewer(10, 3, 2, 5, fails).empty()) << "no more than so many questions";
  EXPECT_TRUE(fewer(10, 1, 2, 100, fails).empty()) << "nothing smaller than one but nothing";
}

}  // namespace
}  // namespace adit::sim
