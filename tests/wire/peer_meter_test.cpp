// SPDX-License-Identifier: Apache-2.0
#include "core/wire/link/peer_meter.hpp"

#include <gtest/gtest.h>

namespace adit::wire {
namespace {

Time at(double s) { return Time(from_seconds(s)); }

TEST(PeerMeter, LossIsTheShareOfMissingSequenceNumbers) {
  PeerMeter meter;
  for (std::uint32_t i = 1; i <= 100; ++i)
    if (i % 4 != 0) meter.heard("r1", i, at(i));
  const auto peer = meter.peer("r1", at(100));
  ASSERT_TRUE(peer);
  EXPECT_NEAR(peer->lost, 0.25, 0.04);
  EXPECT_EQ(peer->number, 99U);
  EXPECT_EQ(peer->held, 1s);
  for (std::uint32_t i = 101; i <= 140; ++i) meter.heard("r1", i, at(i));
  EXPECT_EQ(meter.peer("r1", at(140))->lost, 0.0F);
  EXPECT_FALSE(meter.peer("r2", at(140)));
}

TEST(PeerMeter, LateAndDoubledNumbersCountOnce) {
  PeerMeter meter;
  for (const std::uint32_t i : {1U, 3U, 3U, 2U, 4U}) meter.heard("r1", i, at(i));
  EXPECT_EQ(meter.peer("r1", at(4))->lost, 0.0F);
  EXPECT_EQ(meter.peer("r1", at(4))->number, 4U);
}

TEST(PeerMeter, AGapLongerThanTheWindowIsAllLost) {
  PeerMeter meter;
  meter.heard("r1", 1, at(1));
  meter.heard("r1", 1000, at(1000));
  EXPECT_GT(meter.peer("r1", at(1000))->lost, 0.9F);
}

TEST(PeerMeter, APeerThatBeganAnewBeginsAnew) {
  PeerMeter meter;
  meter.heard("r1", 500, at(1));
  meter.heard("r1", 1, at(2));
  meter.heard("r1", 2, at(3));
  EXPECT_EQ(meter.peer("r1", at(3))->number, 2U);
  EXPECT_EQ(meter.peer("r1", at(3))->lost, 0.0F);
}

TEST(PeerMeter, RoundTripExcludesThePeersDelay) {
  PeerMeter meter;
  meter.heard("r1", 1, at(0));
  EXPECT_FALSE(meter.peer("r1", at(0))->round_trip);
  meter.sent(7, at(10));
  meter.echoed("r1", 7, 1500ms, at(11.8));
  EXPECT_NEAR(*meter.peer("r1", at(12))->round_trip, 0.3, 1e-9);
  meter.echoed("r1", 7, 5s, at(11.8));   // more than all the time there was
  meter.echoed("r1", 6, 0s, at(11.8));   // never sent
  meter.echoed("r1", 39, 0s, at(11.8));  // the same place, another number
  meter.echoed("r9", 7, 0s, at(11.8));   // never heard
  EXPECT_NEAR(*meter.peer("r1", at(12))->round_trip, 0.3, 1e-9);
}

TEST(PeerMeter, StrangersBeyondTheBoundAreIgnored) {
  PeerMeter meter;
  for (int i = 0; i < 1000; ++i) meter.heard("x" + std::to_string(i), 1, at(1));
  EXPECT_EQ(meter.peers(at(1)).size(), PeerMeter::kMaxPeers);
}

}  // namespace
}  // namespace adit::wire
