// SPDX-License-Identifier: Apache-2.0
#include "core/transfer/pacer.hpp"

#include <gtest/gtest.h>

namespace adit::transfer {
namespace {

wire::SenderState on(const wire::LinkProfile& profile) {
  wire::SenderState state;
  state.link = &profile;
  return state;
}

/// Bytes on the air in `span` when something is always there to send.
double sent_in(Pacer& pacer, const wire::SenderState& link, Duration span, std::size_t peers = 1) {
  double bytes = 0;
  for (Time now{}; now.time_since_epoch() < span; now += 50ms) {
    pacer.observe(now, link, peers);
    while (pacer.allows()) {
      pacer.sent(pacer.piece_bytes());
      bytes += static_cast<double>((pacer.piece_bytes() + kPieceOverhead) * peers);
    }
  }
  return bytes;
}

TEST(Pacer, UsesItsShareOfAThinLinkForAnyNumberOfPeers) {
  for (const double bandwidth : {100e3, 500e3})
    for (const std::size_t peers : {1, 2, 3}) {
      wire::LinkProfile profile{.name = "mesh", .bandwidth = bandwidth};
      Pacer pacer;
      const double share = sent_in(pacer, on(profile), 60s, peers) * 8 / 60 / bandwidth;
      EXPECT_GT(share, 0.36) << bandwidth << " " << peers;
      EXPECT_LT(share, 0.6) << bandwidth << " " << peers;
    }
}

TEST(Pacer, MakesPiecesFitAFrame) {
  wire::LinkProfile thin{.name = "thin", .bandwidth = 100e3}, wide{.name = "wide", .bandwidth = 20e6};
  Pacer pacer;
  pacer.observe(Time{}, on(thin), 1);
  EXPECT_LE(pacer.piece_bytes() + kPieceOverhead, 500U);
  pacer.observe(Time{}, on(wide), 1);
  EXPECT_EQ(pacer.piece_bytes(), kMaxPieceBytes);
}

TEST(Pacer, AllowsOnePieceAtATimeOnAThinLink) {
  wire::LinkProfile profile{.name = "mesh", .bandwidth = 100e3};
  Pacer pacer;
  pacer.observe(Time{}, on(profile), 1);
  pacer.observe(Time{} + 10s, on(profile), 1);  // A long pause is no reason for a burst.
  ASSERT_TRUE(pacer.allows());
  pacer.sent(pacer.piece_bytes());
  pacer.observe(Time{} + 10s, on(profile), 1);
  int more = 0;
  for (; pacer.allows(); ++more) pacer.sent(pacer.piece_bytes());
  EXPECT_LE(more, 1);
}

TEST(Pacer, WaitsWhileSomethingElseIsQueued) {
  wire::LinkProfile profile{.name = "mesh", .bandwidth = 500e3};
  wire::SenderState link = on(profile);
  Pacer pacer;
  pacer.observe(Time{}, link, 1);
  pacer.observe(Time{} + 1s, link, 1);
  EXPECT_TRUE(pacer.allows());
  link.queue[0] = 100ms;
  pacer.observe(Time{} + 2s, link, 1);
  EXPECT_FALSE(pacer.allows());
}

TEST(Pacer, FallsBackWhenTheQueueDropsMessages) {
  wire::LinkProfile profile{.name = "mesh", .bandwidth = 500e3};
  wire::SenderState link = on(profile);
  Pacer pacer;
  pacer.observe(Time{}, link, 1);
  const double before = pacer.rate();
  for (int i = 1; i <= 20; ++i) {
    link.dropped[3] += 2;
    pacer.observe(Time{} + i * 100ms, link, 1);
  }
  EXPECT_LT(pacer.rate(), before / 2);
}

TEST(Pacer, FallsBackWithoutALinkProfileWhenMostPiecesAreLost) {
  wire::SenderState unknown;
  Pacer pacer;
  pacer.observe(Time{}, unknown, 1);
  const double before = pacer.rate();
  EXPECT_GT(before, 0.0);
  for (int i = 1; i <= 100; ++i) {
    pacer.settled(i % 4 == 0);
    pacer.observe(Time{} + i * 100ms, unknown, 1);
  }
  EXPECT_LT(pacer.rate(), before / 2);
}

TEST(Pacer, LetsOnePieceAheadOfTheRateAndNoMore) {
  wire::LinkProfile thin{.name = "thin", .bandwidth = 100e3};
  Pacer pacer;
  Time now{};
  for (int i = 0; i < 20; ++i, now += 50ms) pacer.observe(now, on(thin), 2);
  ASSERT_TRUE(pacer.allows());
  pacer.sent(pacer.piece_bytes());
  EXPECT_FALSE(pacer.allows());
  EXPECT_TRUE(pacer.allows(true));
  pacer.sent(pacer.piece_bytes());
  EXPECT_FALSE(pacer.allows(true)) << "the debt is that of two pieces";
  for (int i = 0; i < 200 && !pacer.allows(true); ++i, now += 50ms) pacer.observe(now, on(thin), 2);
  EXPECT_TRUE(pacer.allows(true));
  EXPECT_FALSE(pacer.allows()) << "others wait until it is made up for";
  wire::SenderState busy = on(thin);
  busy.queue[5] = 1s;
  pacer.observe(now, busy, 2);
  EXPECT_FALSE(pacer.allows(true)) << "nothing is added to a queue";
}

}  // namespace
}  // namespace adit::transfer
