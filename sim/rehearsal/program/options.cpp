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
  if (!read || out.last < out.first || out.last - out.first >= kMaxSeeds)
    return Error{Reason::bad_argument, "--seeds " + text + ": expected A..B with A not above B, e.g. 1..200"};
  return out;
}

}  // namespace adit::sim
