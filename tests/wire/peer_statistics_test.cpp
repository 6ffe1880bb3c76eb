// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/peer_statistics.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>

namespace adit::wire {
namespace {

ParticipantId id(std::uint8_t first, std::uint8_t second = 0) { return {first, second}; }
const in_addr_t kMachine = htonl(0x0a000002);
constexpr std::uint16_t kDiscoveryPort = 7412, kDataPort = 7413;

RtpsPeek from(ParticipantId who) { return {.source = who}; }
RtpsPeek to(ParticipantId who) { return {.destination = who}; }

TEST(PeerStatistics, CountsBytesByParticipantOnceItsAddressIsKnown) {
  PeerStatistics book;
  book.sent({}, kMachine, kDataPort, 100);  // to somebody
  book.sent(to(id(1)), kMachine, kDiscoveryPort, 10);
  book.sent({}, kMachine, kDataPort, 5);  // its other port
  book.sent(to(id(1)), inet_addr("239.255.0.1"), 7400, 1000);
  book.received(from(id(1)), 7);
  book.received({}, 1000);
  const auto all = book.all(id(9), nullptr);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].peer, id(1));
  EXPECT_EQ(all[0].bytes_out, 15U);
  EXPECT_EQ(all[0].bytes_in, 7U);
  EXPECT_FALSE(all[0].signal);
  EXPECT_TRUE(book.all(id(1), nullptr).empty());  // what a participant hears of itself
}

TEST(PeerStatistics, AnAddressThatChangedHandsIsTheNewOnes) {
  PeerStatistics book;
  book.sent(to(id(1)), kMachine, kDataPort, 10);
  book.sent(to(id(2)), kMachine, kDataPort, 20);
  book.sent({}, kMachine, kDataPort, 1);
  EXPECT_EQ(book.all({}, nullptr)[0].bytes_out, 10U);
  EXPECT_EQ(book.all({}, nullptr)[1].bytes_out, 21U);
}

TEST(PeerStatistics, DistanceAndSignalAreKnownOnceBothPlacesAre) {
  PeerStatistics book;
  const LinkProfile link{.fading = 2.0, .path_loss = 40, .power = 20};
  book.sent(to(id(1)), kMachine, kDataPort, 10);
  EXPECT_FALSE(book.path(kMachine, kDataPort).distance);
  book.set_place(id(1), {10, 0, 0});
  EXPECT_FALSE(book.path(kMachine, kDataPort).distance);
  book.set_own_place({0, 0, 0});
  EXPECT_EQ(book.path(kMachine, kDataPort).distance, 10.0);
  EXPECT_NEAR(book.all({}, &link)[0].signal.value(), -40.0, 1e-9);
  EXPECT_FALSE(book.path(kMachine, 9000).distance);  // no peer is known there
}

TEST(PeerStatistics, StrangersWithoutEndTakeTheSilentOnesPlace) {
  PeerStatistics book;
  for (int i = 0; i < 10000; ++i) {
    book.received(from(id(static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8))), 1);
    if (i % 100 == 0) book.received(from(id(0, 200)), 1);
  }
  const auto all = book.all({}, nullptr);
  EXPECT_EQ(all.size(), PeerStatistics::kMaxPeers);
  const auto remembered = std::find_if(all.begin(), all.end(), [](auto& p) { return p.peer == id(0, 200); });
  ASSERT_NE(remembered, all.end());
  EXPECT_GE(remembered->bytes_in, 100U);
}

}  // namespace
}  // namespace adit::wire
