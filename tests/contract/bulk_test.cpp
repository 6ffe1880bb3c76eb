// SPDX-License-Identifier: Apache-2.0
#include "core/contract/bulk.hpp"

#include <gmock/gmock.h>

#include "adit/bulk.h"
#include "core/command/words.hpp"
#include "core/wire/topics.hpp"
#include "tests/contract/random_samples.hpp"

namespace adit::contract {

static void randomize(RandomSamples& random, radio::BulkPiece& out) {
  random.any(out.robot(), out.session(), out.id(), out.kind(), out.waiting(), out.data());
  if (random.random().chance(0.5)) out.data().resize(random.random().below(2 * transfer::kMaxPieceBytes));
}
static void randomize(RandomSamples& random, radio::BulkReceipt& out) {
  random.any(out.robot(), out.session(), out.newest(), out.received());
}
static void randomize(RandomSamples& random, radio::BulkDigest& out) { random.any(out.robot(), out.parts()); }
static void randomize(RandomSamples& random, radio::BulkAck& out) {
  random.any(out.station(), out.station_id(), out.start(), out.receipts(), out.look(), out.carrier(),
             out.all_digests(), out.digests());
  if (random.random().chance(0.5)) out.look().resize(3);
}

namespace {

TEST(ContractBulk, APieceComesBackAsItWasAndFitsItsTopic) {
  for_each_seed([](RandomSamples& random) {
    BulkPiece sent{.robot = random.name()};
    random.any(sent.session, sent.id, sent.kind, sent.waiting, sent.data);
    sent.data.resize(random.random().below(transfer::kMaxPieceBytes + 1), 7);
    EXPECT_EQ(decode(through_cdr(encode(sent), wire::topics::kBulk)), sent);
  });
}

TEST(ContractBulk, AnAcknowledgementComesBackAsItWasAndFitsItsTopic) {
  for_each_seed([](RandomSamples& random) {
    BulkAck sent{.station = random.name()};
    random.any(sent.station_id, sent.start, sent.carrier, sent.all_digests);
    sent.receipts.resize(random.random().below(BulkAck::kMaxReceipts + 1));
    for (auto& [robot, receipt] : sent.receipts) {
      robot = random.name();
      random.any(receipt.session, receipt.newest, receipt.received);
    }
    if (random.random().chance(0.5))
      sent.look = {static_cast<float>(random.number(1e4)), static_cast<float>(random.number(1e4)),
                   transfer::Look::kMaxRadius};
    // All of both do not fit at once: DigestList sends fewer digests with more receipts.
    if (sent.receipts.size() < 8) sent.digests.resize(random.random().below(BulkAck::kMaxDigests + 1));
    for (transfer::ContentDigest& digest : sent.digests) {
      digest.robot = random.name();
      random.any(digest.parts);
    }
    EXPECT_EQ(decode(through_cdr(encode(sent), wire::topics::kBulkAck)), sent);
  });
}

TEST(ContractBulk, AnyPieceIsBounded) {
  for_any<radio::BulkPiece>([](const radio::BulkPiece& sample) {
    const bool good = command::valid_name(sample.robot()) && sample.data().size() <= transfer::kMaxPieceBytes;
    EXPECT_EQ(decode(sample).has_value(), good);
  });
}

TEST(ContractBulk, AnyAcknowledgementIsBounded) {
  int taken = 0, looks = 0;
  for_any<radio::BulkAck>([&](const radio::BulkAck& sample) {
    const auto read = decode(sample);
    EXPECT_EQ(read.has_value(), command::valid_name(sample.station()));
    if (!read) return;
    ++taken;
    EXPECT_LE(read->receipts.size(), BulkAck::kMaxReceipts);
    EXPECT_LE(read->digests.size(), BulkAck::kMaxDigests);
    for (const auto& [robot, receipt] : read->receipts) EXPECT_TRUE(command::valid_name(robot));
    for (const transfer::ContentDigest& digest : read->digests)
      EXPECT_TRUE(command::valid_name(digest.robot));
    if (!read->look) return;
    ++looks;
    EXPECT_TRUE(finite(read->look->x, read->look->y));
    EXPECT_GT(read->look->radius, 0.0F);
    EXPECT_LE(read->look->radius, transfer::Look::kMaxRadius);
  });
  EXPECT_GT(taken, 0);
  EXPECT_GT(looks, 0);
}

TEST(ContractBulk, ARobotGetsItsOwnReceipt) {
  const BulkAck ack{.station = "op1",
                    .station_id = {1},
                    .start = 7,
                    .receipts = {{"r1", {5, 3, {7, 0}}}, {"r2", {6, 4, {15, 0}}}}};
  const transfer::Ack to_r2 = ack.to("r2");
  EXPECT_EQ(to_r2.receipt, (transfer::Receipt{6, 4, {15, 0}}));
  EXPECT_EQ(to_r2.peer, ack.station_id);
  EXPECT_EQ(to_r2.start, 7U);
  EXPECT_THAT(to_r2.senders, testing::ElementsAre("r1", "r2"));
  EXPECT_EQ(ack.to("r3").receipt, transfer::Receipt{});
}

}  // namespace
}  // namespace adit::contract
