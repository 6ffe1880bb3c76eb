// SPDX-License-Identifier: Apache-2.0
#include "perception/voxel/flat_hash.hpp"

#include <gtest/gtest.h>

#include <map>

#include "core/time/random.hpp"

namespace adit::perception {
namespace {

TEST(FlatHash, AgreesWithAMapOverManyInsertionsAndErasures) {
  FlatHash<int> hash;
  std::map<std::uint64_t, int> expected;
  Random random(7);
  std::size_t at = 0;
  for (int n = 0; n < 60'000; ++n) {
    const auto v = [&] { return static_cast<std::int32_t>(random.below(40)) - 20; };
    const std::uint64_t key = voxel_key(v(), v(), v());
    hash.at(key) = n;
    expected[key] = n;
    const int limit = n - 9'000;
    at = hash.sweep(at, 32, [&](int value) { return value < limit; });
  }
  // What is young is there; what is not there is old.
  for (const auto& [key, value] : expected) {
    const int* found = hash.find(key);
    if (value >= 51'000) {
      ASSERT_TRUE(found);
    }
    if (found) {
      ASSERT_EQ(*found, value);
    }
  }
  at = 0;
  hash.sweep(at, hash.slots().size(), [](int) { return true; });
  EXPECT_EQ(hash.size(), 0u);
  for (const auto& [key, value] : expected) ASSERT_EQ(hash.find(key), nullptr);
}

TEST(FlatHash, KeysOfNegativeVoxelsDiffer) {
  EXPECT_NE(voxel_key(-1, 0, 0), voxel_key(0, -1, 0));
  EXPECT_NE(voxel_key(-1, 0, 0), voxel_key(1, 0, 0));
  EXPECT_NE(voxel_key(-1, -1, -1), FlatHash<int>::kEmpty);
}

}  // namespace
}  // namespace adit::perception
