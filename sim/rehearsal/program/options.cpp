// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/program/options.hpp"

#include <charconv>

namespace adit::sim {
namespace {

constexpr std::uint64_t kMaxSeeds = 1'000'000;

bool parse_number(std::string_view text, std::uint64_t& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size() && !text.empty();
}

}  // namespace

Result<SeedRange> parse_seeds(const std::string& text) {
  const std::size_t dots = text.find("..");
  SeedRange out;
  const bool read = dots != std::string::npos &&
                    parse_number(std::string_view(text).substr(0, dots), out.first) &&
                    parse_number(std::string_view(text).substr(dots + 2), out.last);
  const auto refuse = [&](const std::string& what) {
    return Error{Reason::bad_argument, "--seeds: expected " + what + ", not '" + text.substr(0, 50) + "'"};
  };
  if (!read) return refuse("A..B, two whole numbers as in 1..200");
  if (out.last < out.first) return refuse("A..B with A not above B");
  if (out.last - out.first >= kMaxSeeds) return refuse("at most " + std::to_string(kMaxSeeds) + " seeds");
  return out;
}

}  // namespace adit::sim
