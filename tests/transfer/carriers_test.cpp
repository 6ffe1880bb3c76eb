// SPDX-License-Identifier: Apache-2.0
// Robots that carry content on to stations, as peers of a sender.
#include <gtest/gtest.h>

#include "core/transfer/sender.hpp"
#include "tests/transfer/toy_source.hpp"

namespace adit::transfer {
namespace {

class CarriersTest : public testing::Test {
 protected:
  CarriersTest() {
    sender.add(source);
    for (std::uint8_t part = 0; part < 100; ++part) source.set(part, 1);
  }
  static Ack ack(std::uint8_t peer, bool carrier) { return {.peer = {peer}, .start = 1, .carrier = carrier}; }
  /// Lets time pass while these peers acknowledge once a second; returns what went out.
  std::vector<Piece> run(Duration span, const std::vector<Ack>& heard) {
    std::vector<Piece> out;
    for (int step = 0; span > Duration{}; span -= 100ms, now += 100ms, ++step) {
      if (step % 10 == 0)
        for (const Ack& each : heard) sender.acknowledged(each, now);
      for (Piece& piece : sender.due(now, {})) out.push_back(std::move(piece));
    }
    return out;
  }
  void change(std::uint8_t value) {
    for (std::uint8_t part = 0; part < 100; ++part) source.set(part, value);
  }

  Time now{10s};
  ToySource source{};
  Sender sender{{.session = 7}};
};

TEST_F(CarriersTest, GetNothingUntilNoStationWasHeardForAWhile) {
  EXPECT_TRUE(run(14s, {ack(1, true)}).empty());
  EXPECT_FALSE(sender.serves_carriers(now));
  const auto sent = run(3s, {ack(1, true)});
  ASSERT_FALSE(sent.empty());
  for (const Piece& piece : sent) EXPECT_TRUE(piece.for_carriers);
}

TEST_F(CarriersTest, AStationGoesFirstAndNothingGoesToBoth) {
  (void)run(20s, {ack(1, true)});
  change(2);
  for (const Piece& piece : run(20s, {ack(1, true), ack(2, false)})) EXPECT_FALSE(piece.for_carriers);
  EXPECT_EQ(source.missing({2}), 0U);
  change(3);
  EXPECT_TRUE(run(4s, {ack(1, true)}).size() < 20) << "the station may be back in a moment";
  bool to_carriers = false;
  for (const Piece& piece : run(20s, {ack(1, true)})) to_carriers = to_carriers || piece.for_carriers;
  EXPECT_TRUE(to_carriers);
}

TEST_F(CarriersTest, GetOnlyWhatIsForThem) {
  ToySource findings;
  findings.carried = false;
  findings.set(1, 1);
  Sender both({.session = 7});
  both.add(findings);
  both.add(source);
  for (int second = 0; second < 30; ++second, now += 1s) {
    both.acknowledged(ack(1, true), now);
    for (const Piece& piece : both.due(now, {})) EXPECT_GT(piece.data.size(), ToySource::kPart);
  }
  EXPECT_EQ(findings.joins, 0);
  EXPECT_EQ(source.joins, 1);
}

TEST_F(CarriersTest, AStationTakesACarriersSlotAndACarrierNoStations) {
  for (std::uint8_t peer = 1; peer <= 15; ++peer) EXPECT_TRUE(sender.acknowledged(ack(peer, false), now));
  EXPECT_TRUE(sender.acknowledged(ack(16, true), now));
  EXPECT_FALSE(sender.acknowledged(ack(17, true), now));
  EXPECT_TRUE(sender.acknowledged(ack(18, false), now)) << "a station goes before a carrier that is heard";
  EXPECT_FALSE(sender.acknowledged(ack(16, true), now));
  now += 100s;
  EXPECT_FALSE(sender.acknowledged(ack(16, true), now)) << "what silent stations have is worth more";
  EXPECT_TRUE(sender.acknowledged(ack(19, false), now));
  EXPECT_EQ(sender.peers(), 16U);
}

TEST_F(CarriersTest, ARobotThatUsesAStationsIdKeepsItFromNothing) {
  EXPECT_TRUE(sender.acknowledged(ack(1, true), now));
  EXPECT_TRUE(sender.acknowledged(ack(1, false), now));
  EXPECT_FALSE(sender.acknowledged(ack(1, true), now));
  EXPECT_EQ(sender.peers(), 1U);
  EXPECT_FALSE(run(5s, {ack(1, false)}).empty());
  EXPECT_TRUE(sender.acknowledged(ack(2, false), now));
  EXPECT_FALSE(sender.acknowledged(ack(2, true), now));
}

}  // namespace
}  // namespace adit::transfer
