// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

namespace adit::gui {

/// A colour as 0xRRGGBB.
using Rgb = std::uint32_t;

/// What a mark or a chip says. A colour is never alone: each token has a shape and a word as well.
enum class Token : std::uint8_t { ok, warn, bad, mine, other, none, goal, text, dim };
/// The name of a colour in QML.
constexpr const char* word_of(Token token) {
  constexpr std::array kWords{"ok", "warn", "bad", "mine", "other", "none", "goal", "text", "dim"};
  return kWords[static_cast<std::size_t>(token)];
}

/// The hues of Okabe and Ito, which differ for dichromats, too. Both themes use these fills: darkened for the
/// light theme they would no longer differ; there, each mark has a dark outline instead.
inline constexpr std::array<Rgb, 7> kTokens{0x009E73, 0xE69F00, 0xD55E00, 0x56B4E9,
                                            0xCC79A7, 0xF1F3F4, 0xF0E442};
inline constexpr Rgb kInk = 0x111111;  ///< Text on a fill, and the outline of marks.

/// Grounds and texts of a theme.
struct Palette {
  Rgb ground{}, panel{}, raised{}, edge{}, text{}, dim{};
  Rgb unknown{};      ///< Where the map shows nothing.
  Rgb floor{};        ///< Cells of the map with ground: free.
  Rgb low{}, high{};  ///< Cells with things up to 0.6 m, and from 1.4 m: clutter and walls, of another hue.
};
inline constexpr Palette kDark{.ground = 0x15181C,
                               .panel = 0x1E2329,
                               .raised = 0x2B333B,
                               .edge = 0x46515B,
                               .text = 0xF1F3F4,
                               .dim = 0xAEB7BF,
                               .unknown = 0x0A0C0F,
                               .floor = 0x2D3945,
                               .low = 0x9A7B52,
                               .high = 0xD3DEE8};
inline constexpr Palette kLight{.ground = 0xF5F6F7,
                                .panel = 0xFFFFFF,
                                .raised = 0xE1E5E8,
                                .edge = 0x9AA4AD,
                                .text = 0x15181C,
                                .dim = 0x48525B,
                                .unknown = 0xC6CDD4,
                                .floor = 0xFFFFFF,
                                .low = 0xB08B57,
                                .high = 0x36424E};

constexpr Rgb colour(Token token, const Palette& palette) {
  if (token == Token::text) return palette.text;
  if (token == Token::dim) return palette.dim;
  return kTokens[static_cast<std::size_t>(token)];
}

/// A colour between two. `share` of the second one, [0, 1].
inline Rgb mixed(Rgb a, Rgb b, double share) {
  Rgb out = 0;
  for (const int shift : {0, 8, 16}) {
    const double low = (a >> shift) & 0xFFU, high = (b >> shift) & 0xFFU;
    out |= static_cast<Rgb>(std::lround(low + share * (high - low))) << shift;
  }
  return out;
}

}  // namespace adit::gui
