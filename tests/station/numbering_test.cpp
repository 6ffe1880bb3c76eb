// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/numbering.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "core/time/random.hpp"

namespace adit::station {
namespace {

using testing::ElementsAre;

TEST(Numbering, NumbersInNamesCompareByTheirValue) {
  std::vector<std::string> names{"r10", "spot", "r2", "r1", "husky-12b", "husky-2a", "r", "r02", "7", "R3"};
  std::ranges::sort(names, NaturalOrder{});
  EXPECT_THAT(names, ElementsAre("7", "R3", "husky-2a", "husky-12b", "r", "r1", "r02", "r2", "r10", "spot"));
}

TEST(Numbering, ARobotHasTheNumberOfItsName) {
  EXPECT_THAT(numbers_of({"r1", "r10", "r2", "r3"}), ElementsAre(1, 10, 2, 3));
  EXPECT_THAT(numbers_of({"r7"}), ElementsAre(7));
}

TEST(Numbering, OthersHaveTheSmallestFreeNumbersInTheOrderOfTheirNames) {
  EXPECT_THAT(numbers_of({"spot", "r2", "husky10", "husky9"}), ElementsAre(4, 2, 3, 1));
  EXPECT_THAT(numbers_of({"r01", "r1", "r0", "r1x", "r1000", "r99999999999", ""}),
              ElementsAre(4, 1, 3, 5, 6, 7, 2));
  EXPECT_THAT(numbers_of(std::vector<std::string>{}), ElementsAre());
}

TEST(Numbering, ANewlyHeardRobotChangesNoNumberOfAnR) {
  World world;
  for (const char* name : {"amber", "r1", "r2", "r10"}) world.robots.emplace_back().name = name;
  ASSERT_NE(robot_with_number(world, 2), nullptr);
  EXPECT_EQ(robot_with_number(world, 2)->name, "r2");
  EXPECT_EQ(robot_with_number(world, 3)->name, "amber");
  EXPECT_EQ(robot_with_number(world, 10)->name, "r10");
  EXPECT_EQ(robot_with_number(world, 4), nullptr);
}

TEST(Numbering, AnyNamesAreInOneOrderAndEachHasANumberOfItsOwn) {
  Random random(3);
  const std::string letters = "r0129-Z";
  for (int round = 0; round < 2000; ++round) {
    std::set<std::string> drawn;
    for (int i = 0; i < 12; ++i) {
      std::string name = random.uniform() < 0.5 ? "r" : "";
      for (int n = static_cast<int>(random.uniform() * 5); n > 0; --n)
        name += letters[static_cast<std::size_t>(random.uniform() * static_cast<double>(letters.size()))];
      drawn.insert(name);
    }
    std::vector<std::string> names(drawn.begin(), drawn.end());
    std::ranges::sort(names, NaturalOrder{});
    for (std::size_t i = 0; i < names.size(); ++i)
      for (std::size_t j = 0; j < names.size(); ++j)
        ASSERT_EQ(natural_less(names[i], names[j]), i < j) << names[i] << " " << names[j];
    const std::vector<int> numbers = numbers_of(names);
    ASSERT_EQ(std::set<int>(numbers.begin(), numbers.end()).size(), names.size());
    ASSERT_GE(*std::ranges::min_element(numbers), 1);
  }
}

}  // namespace
}  // namespace adit::station
