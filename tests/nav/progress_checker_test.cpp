// SPDX-License-Identifier: Apache-2.0
#include "nav/recovery/progress_checker.hpp"

#include <gtest/gtest.h>

namespace adit::nav::test {
namespace {

TEST(ProgressChecker, ShorterRouteIsProgress) {
  ProgressChecker checker;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(checker.stuck(20.0 - 0.1 * i, false, 2.0 * i)) << i;
}

TEST(ProgressChecker, ToAndFroIsNoProgress) {
  ProgressChecker checker;
  for (int t = 0; t < 45; ++t) EXPECT_FALSE(checker.stuck(5.0 + t % 3, false, t)) << t;
  EXPECT_TRUE(checker.stuck(5.0, false, 46));
  EXPECT_FALSE(checker.stuck(4.0, false, 47)) << "it came nearer after all";
}

TEST(ProgressChecker, ADetourIsGivenItsTimeAndThreeAtMost) {
  ProgressChecker checker;
  checker.stuck(5.0, false, 0);
  for (int t = 1; t < 60; ++t) EXPECT_FALSE(checker.stuck(40.0 - 0.5 * t, t == 1, t)) << t;
  bool stuck = false;
  for (int t = 60; t < 300; ++t) stuck = checker.stuck(t % 20 < 10 ? 8 : 20, t % 20 == 10, t);
  EXPECT_TRUE(stuck);
}

}  // namespace
}  // namespace adit::nav::test
