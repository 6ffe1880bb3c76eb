// SPDX-License-Identifier: Apache-2.0
#include "core/transfer/receiver.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/time/random.hpp"

namespace adit::transfer {
namespace {

constexpr double kThin = 100e3, kWide = 20e6;

TEST(Receiver, ReceiptHasExactlyThePiecesThatArrived) {
  Random random(7);
  for (int run = 0; run < 50; ++run) {
    Receiver receiver;
    std::set<std::uint32_t> arrived;
    std::uint32_t base = 1;
    for (int i = 0; i < 200; ++i) {
      const auto id = base + static_cast<std::uint32_t>(random.below(20));
      EXPECT_EQ(receiver.take("r1", 5, id, Time{}), arrived.insert(id).second) << "id " << id;
      if (random.chance(0.3)) ++base;
    }
    const auto due = receiver.due(Time{}, kThin);
    ASSERT_TRUE(due);
    ASSERT_EQ(due->size(), 1U);
    const Receipt& receipt = due->front().second;
    EXPECT_EQ(receipt.newest, *arrived.rbegin());
    for (std::uint32_t id = 0; id < receipt.newest + 10; ++id)
      EXPECT_EQ(receipt.has(id), arrived.contains(id) && receipt.newest - id < Receipt::kSpan) << "id " << id;
  }
}

TEST(Receiver, AcknowledgesOnceASecondOnAThinLinkAndFasterOnOthers) {
  for (const auto& [bandwidth, most, least] : {std::tuple{kThin, 11, 9}, std::tuple{kWide, 41, 35}}) {
    Receiver receiver;
    int sent = 0;
    for (std::uint32_t i = 0; i < 200; ++i) {
      const Time now{i * 50ms};
      receiver.take("r1", 5, i + 1, now);
      sent += receiver.due(now, bandwidth) ? 1 : 0;
    }
    EXPECT_LE(sent, most);
    EXPECT_GE(sent, least);
  }
}

TEST(Receiver, ShowsNowAndThenThatItIsThere) {
  Receiver receiver;
  ASSERT_TRUE(receiver.due(Time{}, kThin));
  int sent = 0;
  for (int i = 1; i <= 200; ++i) sent += receiver.due(Time{i * 100ms}, kThin) ? 1 : 0;
  EXPECT_EQ(sent, 10);
}

TEST(Receiver, EachOfManySendersHasItsTurn) {
  // Pieces of all come all the time, or have come: what is acknowledged is lost now and then, and repeated.
  for (const bool all_the_time : {true, false}) {
    Receiver receiver;
    std::map<std::string, int> receipts;
    for (std::uint32_t i = 1; i <= 40; ++i) {
      const Time now{i * 500ms};
      if (all_the_time || i == 1)
        for (int n = 0; n < 40; ++n) receiver.take("r" + std::to_string(n), 5, i, now);
      const auto due = receiver.due(now, kWide);
      if (!due) continue;
      EXPECT_LE(due->size(), 16U);
      for (const auto& [name, receipt] : *due) ++receipts[name];
    }
    EXPECT_EQ(receipts.size(), 40U);
    int fewest = 1000, most = 0;
    for (const auto& [name, count] : receipts) fewest = std::min(fewest, count), most = std::max(most, count);
    EXPECT_GE(fewest, all_the_time ? 15 : 2);
    EXPECT_LE(most, fewest + 1);
  }
}

TEST(Receiver, AReceiptGoesOnceMoreBesideThoseOfOthers) {
  Receiver receiver;
  ASSERT_TRUE(receiver.due(Time{}, kThin));
  receiver.take("r1", 5, 1, Time{1s});
  EXPECT_EQ(receiver.due(Time{2s}, kThin)->size(), 1U);
  std::vector<std::size_t> with_r1;
  for (int n = 3; n <= 5; ++n) {
    receiver.take("r2", 6, static_cast<std::uint32_t>(n), Time{n * 1s});
    with_r1.push_back(receiver.due(Time{n * 1s}, kThin)->size());
  }
  EXPECT_EQ(with_r1, (std::vector<std::size_t>{2, 1, 1}));
}

TEST(Receiver, ARefusedPieceIsReportedSoon) {
  Receiver receiver;
  receiver.take("r1", 5, 1, Time{});
  ASSERT_TRUE(receiver.due(Time{}, kThin));
  EXPECT_FALSE(receiver.due(Time{1s}, kThin));
  receiver.refused("r1");
  receiver.refused("r9");
  EXPECT_EQ(receiver.due(Time{1s}, kThin)->size(), 1U);
}

TEST(Receiver, AnotherSessionBeginsAnew) {
  Receiver receiver;
  receiver.take("r1", 5, 90, Time{});
  EXPECT_TRUE(receiver.take("r1", 6, 1, Time{}));
  const auto due = receiver.due(Time{}, kThin);
  ASSERT_TRUE(due);
  EXPECT_EQ(due->front().second, (Receipt{6, 1, {1, 0}}));
}

TEST(Receiver, StaysBoundedWithManySenders) {
  Receiver receiver;
  for (int i = 0; i < 1000; ++i) receiver.take("robot" + std::to_string(i), 1, 1, Time{i * 1ms});
  std::size_t receipts = 0;
  for (int i = 0; i < 20; ++i)
    if (const auto due = receiver.due(Time{2s + i * 1s}, kThin)) {
      EXPECT_LE(due->size(), 16U);
      receipts += due->size();
    }
  EXPECT_GE(receipts, 64U);
}

}  // namespace
}  // namespace adit::transfer
