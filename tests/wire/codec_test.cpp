// SPDX-License-Identifier: Apache-2.0
// What a peer can send instead of a sample: nothing of it throws, allocates without bound or passes as whole.
#include <gtest/gtest.h>

#include "core/time/random.hpp"
#include "core/wire/cdr_key.hpp"
#include "tests/wire/largest_allocation.hpp"
#include "tests/wire/samples.hpp"

namespace adit::wire {
namespace {

/// A sequence's elements are made before their bytes are read: at most this many bytes for each byte
/// received.
constexpr std::size_t kGrowth = 128;

void set_length(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i)
    bytes[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value >> (8 * i));
}

TEST(Codec, EverySampleOfEveryTopicSurvivesTheRoundTripWithinItsLimit) {
  const auto all = examples();
  EXPECT_EQ(all.size(), 18U);
  for (const Example& e : all) {
    EXPECT_TRUE(e.decodes(e.bytes)) << e.topic.name;
    EXPECT_LE(e.bytes.size(), e.topic.max_bytes) << e.topic.name;
  }
}

TEST(Codec, TruncatedAtEveryByteIsRefused) {
  for (const Example& e : examples()) {
    for (std::size_t size = 0; size < e.bytes.size(); ++size) {
      EXPECT_FALSE(e.decodes(std::span(e.bytes).first(size))) << e.topic.name << " at " << size;
    }
  }
}

TEST(Codec, AnotherEncapsulationIsRefusedAndBigEndianIsRead) {
  for (const Example& e : examples()) {
    for (int kind = 2; kind < 256; ++kind) {
      auto bytes = e.bytes;
      bytes[1] = static_cast<std::uint8_t>(kind);
      EXPECT_FALSE(e.decodes(bytes)) << e.topic.name << " kind " << kind;
    }
    auto bytes = e.bytes;
    bytes[0] = 1;
    EXPECT_FALSE(e.decodes(bytes)) << e.topic.name;
  }
  radio::Presence presence, read;
  presence.name("op1");
  presence.seq(0x01020304U);
  std::vector<std::uint8_t> big(4 + radio::Presence::getCdrSerializedSize(presence));
  eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(big.data()), big.size());
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::BIG_ENDIANNESS, eprosima::fastcdr::Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  presence.serialize(cdr);
  ASSERT_TRUE(decode(big, read));
  EXPECT_EQ(read.seq(), presence.seq());
  EXPECT_EQ(first_string(big), "op1");
}

TEST(Codec, OversizeLengthsAnywhereAllocateNoMoreThanTheBytesAllow) {
  for (const Example& e : examples()) {
    for (std::size_t at = 4; at + 4 <= e.bytes.size(); at += 4) {
      for (const std::uint32_t length : {0xffffffffU, 0x7fffffffU, 0x80000000U, 0x00ffffffU}) {
        auto bytes = e.bytes;
        set_length(bytes, at, length);
        largest_allocation = 0;
        (void)e.decodes(bytes);
        EXPECT_LE(largest_allocation, kGrowth * bytes.size() + 4096) << e.topic.name << " at " << at;
      }
    }
  }
}

TEST(Codec, ABoolOfTwoIsRefused) {
  radio::Acknowledgement sample;
  sample.accepted(true);
  std::vector<std::uint8_t> bytes, other;
  encode(sample, bytes);
  sample.accepted(false);
  encode(sample, other);
  std::size_t at = 0;
  while (bytes[at] == other[at]) ++at;
  bytes[at] = 2;
  EXPECT_FALSE(decode(bytes, sample));
}

/// Seeded: random bytes flipped, cut, repeated and overwritten, for every topic.
TEST(Codec, RandomDamageNeitherThrowsNorAllocatesWithoutBound) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    for (const Example& e : examples()) {
      for (int round = 0; round < 20; ++round) {
        auto bytes = e.bytes;
        const std::uint64_t changes = 1 + random.below(8);
        for (std::uint64_t i = 0; i < changes && !bytes.empty(); ++i) {
          const std::size_t at = random.below(bytes.size());
          switch (random.below(4)) {
            case 0:
              bytes[at] ^= static_cast<std::uint8_t>(1U << random.below(8));
              break;
            case 1:
              bytes[at] = static_cast<std::uint8_t>(random.next());
              break;
            case 2:
              bytes.resize(at);
              break;
            default:
              bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), random.below(32), 0xff);
              break;
          }
        }
        largest_allocation = 0;
        EXPECT_NO_THROW((void)e.decodes(bytes));
        EXPECT_LE(largest_allocation, kGrowth * bytes.size() + 4096) << e.topic.name << " seed " << seed;
      }
    }
  }
}

// What another release wrote behind its end is no padding.
TEST(Codec, MoreThanPaddingBehindASampleIsRefused) {
  for (const Example& e : examples()) {
    auto bytes = e.bytes;
    bytes.resize(bytes.size() + 3);
    EXPECT_TRUE(e.decodes(bytes)) << e.topic.name;
    bytes.resize(bytes.size() + 5);
    EXPECT_FALSE(e.decodes(bytes)) << e.topic.name;
  }
}

TEST(Codec, TheKeyIsTheFirstStringOrNothing) {
  for (const Example& e : examples()) {
    if (e.topic.keyed) {
      EXPECT_TRUE(first_string(e.bytes)) << e.topic.name;
    }
  }
  const std::vector<std::uint8_t> good{0, 1, 0, 0, 3, 0, 0, 0, 'r', '1', 0, 0};
  EXPECT_EQ(first_string(good), "r1");
  EXPECT_EQ(first_string(std::span(good).first(7)), std::nullopt);
  EXPECT_EQ(first_string(std::span(good).first(10)), std::nullopt);
  auto bad = good;
  set_length(bad, 4, 0xffffffff);
  EXPECT_EQ(first_string(bad), std::nullopt);
  bad = good;
  bad[1] = 3;
  EXPECT_EQ(first_string(bad), std::nullopt);
  const std::vector<std::uint8_t> empty{0, 1, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(first_string(empty), "");
}

}  // namespace
}  // namespace adit::wire
