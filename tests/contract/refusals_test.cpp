// SPDX-License-Identifier: Apache-2.0
#include "core/contract/refusals.hpp"

#include <gtest/gtest.h>

#include "adit/link.h"
#include "core/contract/traffic_meter.hpp"

namespace adit::contract {
namespace {

TEST(RefusalNews, EachKindIsNewsOnceAndAgainWhenItReturns) {
  RefusalNews news;
  wire::RefusalCounts counts{};
  EXPECT_EQ(news.told(counts, Time(1s)), "");
  counts[static_cast<std::size_t>(wire::Refusal::forged)] = 12;
  EXPECT_EQ(news.told(counts, Time(2s)), "forged 12");
  for (int t = 3; t < 300; t += 30) {
    ++counts[static_cast<std::size_t>(wire::Refusal::forged)];
    EXPECT_EQ(news.told(counts, Time(std::chrono::seconds(t))), "") << t;
  }
  counts[static_cast<std::size_t>(wire::Refusal::number_jump)] = 3;
  EXPECT_EQ(news.told(counts, Time(301s)), "number jump 3");
  counts[static_cast<std::size_t>(wire::Refusal::forged)] += 5;
  EXPECT_EQ(news.told(counts, Time(400s)), "forged 5");
}

TEST(TrafficMeter, RefusedDatagramsAreARowByReason) {
  TrafficMeter meter;
  wire::WireCounters counters{.topics = {{.topic = "adit/command", .samples_in = 1, .bytes_in = 10}}};
  EXPECT_EQ(meter.read("op1", counters, {}, Time(1s)).topics.size(), 1U);
  counters.refused[static_cast<std::size_t>(wire::Refusal::forged)] = 7;
  counters.refused[static_cast<std::size_t>(wire::Refusal::too_many)] = 2;
  const LinkReport report = meter.read("op1", counters, {}, Time(2s));
  ASSERT_EQ(report.topics.size(), 2U);
  EXPECT_EQ(report.topics.back().topic, "refused: forged 7, too many 2");
  EXPECT_EQ(report.topics.back().dropped, 9U);
  // There is room for it beside many topics.
  counters.topics.clear();
  for (int i = 0; i < 40; ++i) counters.topics.push_back({.topic = "topic" + std::to_string(i)});
  EXPECT_EQ(encode(meter.read("op1", counters, {}, Time(3s))).topics().back().topic(),
            "refused: forged 7, too many 2");
}

}  // namespace
}  // namespace adit::contract
