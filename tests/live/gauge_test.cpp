// SPDX-License-Identifier: Apache-2.0
#include "bench/soak/gauge.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

namespace adit::soak {
namespace {

std::vector<double> samples(int count, double (*value)(int)) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(value(i));
  return out;
}

TEST(Trend, WhatStaysIsFlat) {
  const Trend t = trend(samples(200, [](int) { return 17.0; }));
  EXPECT_EQ(t.growth, 0.0);
  EXPECT_EQ(t.early, 17.0);
  EXPECT_EQ(t.late, 17.0);
}

TEST(Trend, AStepIsNoGrowthWhereverItIs) {
  EXPECT_EQ(trend(samples(200, [](int i) { return i < 60 ? 17.0 : 19.0; })).growth, 0.0);
  EXPECT_EQ(trend(samples(200, [](int i) { return i < 120 ? 17.0 : 19.0; })).growth, 0.0);
  EXPECT_EQ(trend(samples(200, [](int i) { return i < 190 ? 17.0 : 19.0; })).growth, 0.0);
}

TEST(Trend, ABusyMomentIsNoGrowth) {
  EXPECT_EQ(trend(samples(200, [](int i) { return i > 150 && i < 170 ? 40.0 : 17.0; })).growth, 0.0);
}

TEST(Trend, ALeakGoesOn) {
  EXPECT_NEAR(trend(samples(200, [](int i) { return 17.0 + std::floor(i / 20.0); })).growth, 8.0, 1.0);
  EXPECT_NEAR(trend(samples(200, [](int i) { return 17.0 + i * 0.01 + (i % 7); })).growth, 1.4, 0.4);
}

TEST(Trend, TheStartDoesNotCount) {
  EXPECT_NEAR(trend(samples(200, [](int i) { return i < 40 ? 1.0 * i : 40.0; })).growth, 0.0, 1e-9);
}

TEST(Trend, FewSamplesAreNoReasonToFail) {
  EXPECT_EQ(trend({}).growth, 0.0);
  EXPECT_EQ(trend({3.0}).growth, 0.0);
  EXPECT_EQ(trend({3.0, 4.0}).max, 4.0);
}

TEST(Gauge, TellsOfAProcess) {
  const Gauge own = gauge(::getpid());
  EXPECT_GT(own.rss_mb, 0.5);
  EXPECT_GE(own.threads, 1);
  EXPECT_GE(own.fds, 3);
  EXPECT_EQ(gauge(-1).rss_mb, 0.0);
}

}  // namespace
}  // namespace adit::soak
