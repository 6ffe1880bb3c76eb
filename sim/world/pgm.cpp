// SPDX-License-Identifier: Apache-2.0
#include "sim/world/pgm.hpp"

#include <charconv>
#include <optional>

namespace adit::sim {
namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

/// The next whole number; comments (# to the end of the line) and blanks before it are skipped.
std::optional<int> next_number(std::string_view& rest) {
  while (!rest.empty() && (blank(rest.front()) || rest.front() == '#')) {
    if (rest.front() == '#') rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1));
    rest.remove_prefix(1);
  }
  int value = 0;
  const auto [end, failure] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (failure != std::errc{} || value < 0) return std::nullopt;
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  return value;
}

}  // namespace

Result<GreyImage> parse_pgm(std::string_view content, const std::string& name) {
  const std::string_view magic = content.substr(0, 2);
  if (magic != "P2" && magic != "P5")
    return {Reason::not_supported, name + ": not a PGM image (P2 or P5); convert it to PGM"};
  content.remove_prefix(2);
  const auto width = next_number(content), height = next_number(content), top = next_number(content);
  if (!width || !height || !top) return {Reason::syntax, name + ": expected width, height and largest value"};
  constexpr std::int64_t limit = 64'000'000;
  if (*width < 1 || *height < 1 || static_cast<std::int64_t>(*width) * *height > limit)
    return {Reason::syntax, name + ": expected between 1 and 64 million pixels"};
  if (*top < 1 || *top > 255) return {Reason::not_supported, name + ": expected a largest value of 1 to 255"};
  GreyImage image{*width, *height, {}};
  const std::size_t count = static_cast<std::size_t>(*width) * *height;
  const auto scaled = [&](int value) { return static_cast<std::uint8_t>(value * 255 / *top); };
  // One blank ends the header of a raw image; a plain one needs at least two characters for a pixel.
  const bool raw = magic == "P5";
  if (content.size() < (raw ? count + 1 : 2 * count))
    return {Reason::syntax, name + ": the image is cut off: fewer pixels than its header says"};
  image.pixels.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    const auto value =
        raw ? std::optional<int>(static_cast<unsigned char>(content[n + 1])) : next_number(content);
    if (!value || *value > *top)
      return {Reason::syntax, name + ": pixel " + std::to_string(n + 1) + " is missing or too large"};
    image.pixels.push_back(scaled(*value));
  }
  return image;
}

}  // namespace adit::sim
