// SPDX-License-Identifier: Apache-2.0
#include "perception/stream/range_coder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace adit::perception {
namespace {

TEST(RangeCoder, ReadsWhatWasWritten) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    struct Step {
      std::uint32_t one{};
      bool value{};
    };
    std::vector<Step> steps(random() % 400);
    RangeEncoder encoder;
    for (Step& step : steps) {
      // All kinds of probabilities, with values that they do not expect, too.
      const std::uint32_t edge = random() % 4;
      step.one = edge == 0 ? 1 : edge == 1 ? 65535 : 1 + random() % 65535;
      step.value = random() % 3 == 0 ? random() % 2 == 0 : random() % 65536 < step.one;
      encoder.bit(step.value, step.one);
    }
    const auto bytes = encoder.finish();
    RangeDecoder decoder(bytes);
    for (const Step& step : steps) ASSERT_EQ(decoder.bit(step.one), step.value) << round;
  }
}

TEST(RangeCoder, CarriesThroughAnyNumberOfBytes) {
  // A long run of the upper part of the range leaves bytes of 0xff behind, which one more step turns over.
  for (std::size_t run = 0; run < 200; ++run) {
    RangeEncoder encoder;
    for (std::size_t i = 0; i < run; ++i) encoder.bit(false, 65535);
    for (std::size_t i = 0; i < 40; ++i) encoder.bit(i % 2 == 0, 1 + static_cast<std::uint32_t>(i));
    const auto bytes = encoder.finish();
    RangeDecoder decoder(bytes);
    for (std::size_t i = 0; i < run; ++i) ASSERT_FALSE(decoder.bit(65535));
    for (std::size_t i = 0; i < 40; ++i)
      ASSERT_EQ(decoder.bit(1 + static_cast<std::uint32_t>(i)), i % 2 == 0) << run;
  }
}

TEST(RangeCoder, TakesAsManyBitsAsTheProbabilitiesSay) {
  std::mt19937 random(5);
  for (const std::uint32_t one : {60u, 600u, 6000u, 32768u, 60000u, 65000u}) {
    RangeEncoder encoder;
    const double p = one / 65536.0;
    double bits = 0;
    for (int i = 0; i < 100'000; ++i) {
      const bool value = random() % 65536 < one;
      encoder.bit(value, one);
      bits -= std::log2(value ? p : 1.0 - p);
    }
    EXPECT_NEAR(static_cast<double>(encoder.position()), bits, 16 + 0.002 * bits);
    EXPECT_NEAR(8.0 * static_cast<double>(encoder.finish().size()), bits, 24 + 0.002 * bits);
  }
}

TEST(RangeCoder, NumbersOfAnySize) {
  std::vector<std::uint32_t> numbers{0, 1, 2, 3, 254, 255, 65535, 0x7fffffff, 0xfffffffe};
  RangeEncoder encoder;
  for (const std::uint32_t n : numbers) {
    encoder.number(n);
    encoder.bits(n, 32);
  }
  const auto bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  for (const std::uint32_t n : numbers) {
    EXPECT_EQ(decoder.number(), n);
    EXPECT_EQ(decoder.bits(32), n);
  }
}

TEST(RangeCoder, NothingWrittenTakesNothing) { EXPECT_TRUE(RangeEncoder().finish().empty()); }

TEST(RangeDecoder, ReadsZerosBehindTheEnd) {
  RangeDecoder decoder({});
  for (int i = 0; i < 1000; ++i) static_cast<void>(decoder.number());
}

}  // namespace
}  // namespace adit::perception
