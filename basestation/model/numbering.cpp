// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/numbering.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <set>

namespace adit::station {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes a run of digits from the front of a text, and returns it without leading zeros.
std::string_view take_digits(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

/// The number in a name `r<n>` without leading zeros; 0: the name is another one, or the number too large.
int own_number(std::string_view name) {
  int number = 0;
  if (name.size() < 2 || name[0] != 'r' || name[1] == '0') return 0;
  const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), number);
  const bool read = error == std::errc{} && end == name.data() + name.size();
  return read && number >= 1 && number <= kMaxOwnNumber ? number : 0;
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  const std::string_view all_of_a = a, all_of_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a[0]) && is_digit(b[0])) {
      const std::string_view x = take_digits(a), y = take_digits(b);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else {
      if (a[0] != b[0]) return a[0] < b[0];
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return all_of_a < all_of_b;  // They differ in leading zeros.
}

std::vector<int> numbers_of(const std::vector<std::string>& names) {
  std::vector<std::size_t> order(names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, NaturalOrder{}, [&](std::size_t i) -> std::string_view { return names[i]; });
  std::vector<int> numbers(names.size(), 0);
  std::set<int> used;
  for (const std::size_t i : order)
    if (const int own = own_number(names[i]); own != 0 && used.insert(own).second) numbers[i] = own;
  int next = 1;
  for (const std::size_t i : order) {
    if (numbers[i] != 0) continue;
    while (used.contains(next)) ++next;
    numbers[i] = next++;
  }
  return numbers;
}

std::vector<int> numbers_of(const World& world) {
  std::vector<std::string> names;
  for (const Robot& robot : world.robots) names.push_back(robot.name);
  return numbers_of(names);
}

const Robot* robot_with_number(const World& world, int number) {
  const std::vector<int> numbers = numbers_of(world);
  const auto found = std::ranges::find(numbers, number);
  return found == numbers.end() ? nullptr : &world.robots[static_cast<std::size_t>(found - numbers.begin())];
}

}  // namespace adit::station
