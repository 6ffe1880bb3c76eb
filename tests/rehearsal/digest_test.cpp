// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/digest.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace adit::sim {
namespace {

std::string of(const std::vector<std::uint8_t>& bytes) {
  Digest d;
  d.add(std::span(bytes));
  return d.text();
}

TEST(Digest, EqualStreamsGiveEqualDigests) {
  EXPECT_EQ(of({1, 2, 3, 4, 5, 6, 7, 8, 9}), of({1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(Digest, EveryByteCounts) {
  std::set<std::string> seen{of(std::vector<std::uint8_t>(21, 0))};
  for (std::size_t i = 0; i < 21; ++i) {
    std::vector<std::uint8_t> bytes(21, 0);
    bytes[i] = 1;
    EXPECT_TRUE(seen.insert(of(bytes)).second) << "byte " << i;
  }
}

TEST(Digest, LengthCounts) { EXPECT_NE(of({1, 0}), of({1, 0, 0})); }

TEST(Digest, OrderCounts) {
  Digest a, b;
  a.add(1.0);
  a.add(2.0);
  b.add(2.0);
  b.add(1.0);
  EXPECT_NE(a.text(), b.text());
}

TEST(Digest, TextHas32HexadecimalDigits) {
  EXPECT_EQ(Digest{}.text().size(), 32U);
  EXPECT_EQ(Digest{}.text().find_first_not_of("0123456789abcdef"), std::string::npos);
}

}  // namespace
}  // namespace adit::sim
