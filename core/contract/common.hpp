// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace adit::radio {
class Epoch;
}

/// The messages of the radio domain as plain types (README.md).
namespace adit::contract {

/// 128 random bits stored on the owner's disk.
using Id = std::array<std::uint8_t, 16>;

/// A period of unchanged authority; compared for equality only.
struct Epoch {
  std::uint64_t start{};    ///< Drawn again at each start of the agent.
  std::uint32_t counter{};  ///< Rises with every change of holder.
  bool operator==(const Epoch&) const = default;
};

radio::Epoch encode(const Epoch& epoch);
Epoch decode(const radio::Epoch& sample);

/// Maximum distance of goals and robot poses from the map's origin, m.
inline constexpr double kFarthestPlace = 10'000.0;

inline constexpr std::size_t kMaxName = 32;   ///< Of names, modes, codes and services, bytes.
inline constexpr std::size_t kMaxText = 240;  ///< Of a received text, bytes.

/// Returns a received name or word as printable ASCII, at most kMaxName bytes.
std::string cleaned_name(std::string_view name);
/// Returns the first `max` of the received words, each cleaned as a name.
std::vector<std::string> cleaned_names(const std::vector<std::string>& words, std::size_t max);

/// Returns the text, cut to `max` bytes (3 or more) with "..." at the end if it is longer, so that a long
/// text from another participant does not make a message too large for its topic.
std::string clipped(const std::string& text, std::size_t max);

/// Returns the enumerator with the number of a received one; `otherwise` for a number above that of `last`.
/// Both enumerations have the same numbers, from 0.
template <class Enum, class Number>
constexpr Enum known_or(Number number, Enum last, Enum otherwise) {
  const auto value = static_cast<std::uint64_t>(number);
  return value <= static_cast<std::uint64_t>(last) ? static_cast<Enum>(value) : otherwise;
}

/// Returns a received amount; 0 if it is negative, not a number, or 1e12 or more.
constexpr float amount(float value) { return value >= 0.0F && value < 1e12F ? value : 0.0F; }

template <class... Numbers>
bool finite(Numbers... numbers) {
  return (std::isfinite(numbers) && ...);
}

}  // namespace adit::contract
