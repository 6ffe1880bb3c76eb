// SPDX-License-Identifier: Apache-2.0
// Live tests that run at the same time do not hear each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/live/process.hpp"

namespace adit::live {
namespace {

TEST(LiveDomains, NobodyGetsThoseOfAnother) {
  std::vector<std::unique_ptr<Domains>> taken;
  std::vector<unsigned> first;
  for (int i = 0; i < 6; ++i) first.push_back(taken.emplace_back(std::make_unique<Domains>())->first());
  first.push_back(domain());
  std::sort(first.begin(), first.end());
  for (std::size_t i = 1; i < first.size(); ++i) EXPECT_GE(first[i] - first[i - 1], Domains::kCount);
  EXPECT_GE(first.front(), 10U);
  EXPECT_LT(first.back() + Domains::kCount, 101U);
}

TEST(LiveDomains, AreFreeAgainWhenNotUsed) {
  for (int i = 0; i < 100; ++i) {  // more than there are
    const Domains domains;
    ASSERT_GE(domains.first(), 10U);
  }
}

TEST(LiveDomains, AProcessKeepsItsOwn) {
  EXPECT_EQ(domain(), domain(0));
  EXPECT_EQ(domain(4), domain() + 4);
  EXPECT_THROW((void)domain(5), std::out_of_range);
}

}  // namespace
}  // namespace adit::live
