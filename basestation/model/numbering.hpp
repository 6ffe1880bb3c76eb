// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "basestation/model/world.hpp"

/// The order of robots and the numbers by which operators call them, the same in every front end.
namespace adit::station {

/// Natural order of names: runs of digits compare by their value, so that r2 comes before r10. A total order.
bool natural_less(std::string_view a, std::string_view b);
struct NaturalOrder {
  bool operator()(std::string_view a, std::string_view b) const { return natural_less(a, b); }
};

/// The largest number that a robot has by its name.
inline constexpr int kMaxOwnNumber = 999;

/// The number of each robot, from 1, in the order of `names`. A robot named `r<n>` has the number n, up to
/// kMaxOwnNumber; the others have the smallest free numbers, in natural order of their names.
std::vector<int> numbers_of(const std::vector<std::string>& names);
std::vector<int> numbers_of(const World& world);
/// Returns the robot with that number, or null if there is none.
const Robot* robot_with_number(const World& world, int number);

}  // namespace adit::station
