// SPDX-License-Identifier: Apache-2.0
#include "core/contract/traffic_meter.hpp"

#include <gtest/gtest.h>

namespace adit::contract {
namespace {

using wire::kStatusPriority;
using wire::LinkProfile;
using wire::SenderState;
using wire::WireCounters;

WireCounters counters_of_two_peers() {
  return {.topics = {{.topic = "adit/command", .peer = {1}, .samples_out = 10, .bytes_out = 1000},
                     {.topic = "adit/command",
                      .peer = {2},
                      .samples_out = 5,
                      .bytes_out = 500,
                      .failed_writes = 1,
                      .malformed = 3}},
          .discovery_out = 100};
}

TEST(TrafficMeter, RatesAreDifferencesOverTime) {
  TrafficMeter meter;
  WireCounters counters = counters_of_two_peers();
  EXPECT_EQ(meter.read("op1", counters, {}, Time(1s)).discovery_out, 0.0F);
  counters.topics[0].bytes_out += 200;
  counters.topics[1].bytes_out += 100;
  counters.discovery_out += 50;
  const LinkReport report = meter.read("op1", counters, {}, Time(3s));
  ASSERT_EQ(report.topics.size(), 1U);
  EXPECT_FLOAT_EQ(report.topics[0].bytes_out, 150.0F);
  EXPECT_FLOAT_EQ(report.discovery_out, 25.0F);
  EXPECT_EQ(report.malformed, 3U);
  EXPECT_EQ(report.topics[0].dropped, 4U);
}

TEST(TrafficMeter, TheFirstReadingCoversTheGivenTime) {
  TrafficMeter meter(2s);
  const LinkReport report = meter.read("r1", counters_of_two_peers(), {}, Time(100s));
  EXPECT_FLOAT_EQ(report.discovery_out, 50.0F);
  EXPECT_FLOAT_EQ(report.topics.at(0).samples_out, 7.5F);
}

// For example after the participant dropped the counters of a peer that left.
TEST(TrafficMeter, ACounterThatFellHasNoRate) {
  TrafficMeter meter;
  WireCounters counters = counters_of_two_peers();
  (void)meter.read("r1", counters, {}, Time(1s));
  counters.topics.pop_back();
  counters.topics[0].samples_out += 4;
  counters.discovery_out = 7;
  const LinkReport fell = meter.read("r1", counters, {}, Time(2s));
  EXPECT_EQ(fell.discovery_out, 0.0F);
  EXPECT_EQ(fell.topics.at(0).bytes_out, 0.0F);
  EXPECT_EQ(fell.topics.at(0).samples_out, 0.0F);
  counters.discovery_out += 10;
  counters.topics[0].bytes_out += 30;
  const LinkReport rises = meter.read("r1", counters, {}, Time(4s));
  EXPECT_FLOAT_EQ(rises.discovery_out, 5.0F);
  EXPECT_FLOAT_EQ(rises.topics.at(0).bytes_out, 15.0F);
}

TEST(TrafficMeter, TheSenderIsReportedAsItIs) {
  LinkProfile link{};
  link.name = "mesh_100k";
  link.bandwidth = 1e5;
  SenderState sender{.link = &link};
  sender.queue[kStatusPriority] = 250ms;
  sender.queue[kStatusPriority + 1] = 5s;
  sender.dropped[2] = 9;
  sender.dropped[3] = std::uint64_t{1} << 40;
  const LinkReport report = TrafficMeter{}.read("r1", {}, sender, Time(1s));
  EXPECT_EQ(report.agent, "r1");
  EXPECT_EQ(report.link, "mesh_100k");
  EXPECT_EQ(report.bandwidth, 1e5);
  EXPECT_DOUBLE_EQ(report.queue, 0.25);
  EXPECT_EQ(report.dropped[2], 9U);
  EXPECT_EQ(report.dropped[3], UINT32_MAX);
}

}  // namespace
}  // namespace adit::contract
