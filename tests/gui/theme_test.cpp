// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "basestation/gui/scene/colours.hpp"

namespace adit::gui {
namespace {

using Linear = std::array<double, 3>;

Linear linear(Rgb rgb) {
  Linear out{};
  for (int i = 0; i < 3; ++i) {
    const double c = ((rgb >> (16 - 8 * i)) & 0xFFU) / 255.0;
    out[static_cast<std::size_t>(i)] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return out;
}

/// Contrast as WCAG 2 defines it.
double contrast(Rgb a, Rgb b) {
  const auto luminance = [](Rgb rgb) {
    const Linear c = linear(rgb);
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
  };
  const double one = luminance(a) + 0.05, two = luminance(b) + 0.05;
  return std::max(one, two) / std::min(one, two);
}

/// Machado et al. 2009, severity 1: normal sight, protanopia, deuteranopia, tritanopia.
constexpr std::array<std::array<double, 9>, 4> kSights{{
    {1, 0, 0, 0, 1, 0, 0, 0, 1},
    {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998},
    {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881},
    {1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900},
}};

std::array<double, 3> lab(const Linear& c) {
  const double x = 0.4124564 * c[0] + 0.3575761 * c[1] + 0.1804375 * c[2];
  const double y = 0.2126729 * c[0] + 0.7151522 * c[1] + 0.0721750 * c[2];
  const double z = 0.0193339 * c[0] + 0.1191920 * c[1] + 0.9503041 * c[2];
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  return {116 * f(y) - 16, 500 * (f(x / 0.95047) - f(y)), 200 * (f(y) - f(z / 1.08883))};
}

double delta_e(Rgb a, Rgb b, const std::array<double, 9>& sight) {
  const auto seen = [&](Rgb rgb) {
    const Linear c = linear(rgb);
    Linear out{};
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = std::clamp(sight[3 * i] * c[0] + sight[3 * i + 1] * c[1] + sight[3 * i + 2] * c[2], 0.0, 1.0);
    return lab(out);
  };
  const auto one = seen(a), two = seen(b);
  return std::sqrt(std::pow(one[0] - two[0], 2) + std::pow(one[1] - two[1], 2) +
                   std::pow(one[2] - two[2], 2));
}

TEST(Theme, TextsCanBeReadOnEveryGround) {
  for (const Palette& palette : {kDark, kLight})
    for (const Rgb ground : {palette.ground, palette.panel, palette.raised}) {
      EXPECT_GE(contrast(palette.text, ground), 4.5);
      EXPECT_GE(contrast(palette.dim, ground), 4.5);
    }
}

TEST(Theme, InkCanBeReadOnEveryFill) {
  for (const Rgb fill : kTokens) EXPECT_GE(contrast(kInk, fill), 4.5) << std::hex << fill;
}

TEST(Theme, MarksStandOutFromTheMap) {
  for (const Rgb fill : kTokens)
    for (const Rgb ground : {kDark.ground, kDark.unknown, kDark.floor})
      EXPECT_GE(contrast(fill, ground), 3.0) << std::hex << fill;
  // In the light theme their outline does.
  for (const Rgb ground : {kLight.ground, kLight.unknown, kLight.floor, kLight.panel})
    EXPECT_GE(contrast(kInk, ground), 3.0);
}

TEST(Theme, FreeUnknownClutterAndWallsOfTheMapDiffer) {
  for (const Palette& palette : {kDark, kLight}) {
    EXPECT_GE(contrast(palette.floor, palette.unknown), 1.5) << "free and unknown";
    EXPECT_GE(contrast(palette.floor, palette.high), 3.0) << "free and walls";
    EXPECT_GE(contrast(palette.floor, palette.low), 2.0) << "free and clutter";
    EXPECT_GE(contrast(palette.unknown, palette.high), 3.0) << "unknown and walls";
    EXPECT_GE(contrast(palette.low, palette.high), 2.0) << "clutter and walls";
    for (const auto& sight : kSights) EXPECT_GE(delta_e(palette.low, palette.high, sight), 25.0);
  }
}

TEST(Theme, TokensDifferForEveryKindOfSight) {
  for (std::size_t sight = 0; sight < kSights.size(); ++sight)
    for (std::size_t i = 0; i < kTokens.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_GE(delta_e(kTokens[i], kTokens[k], kSights[sight]), 16.0)
            << "sight " << sight << ", tokens " << i << " and " << k;
}

}  // namespace
}  // namespace adit::gui
