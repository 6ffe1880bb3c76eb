// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/height_colours.hpp"

#include <algorithm>
#include <cmath>

namespace adit::gui {

Rgb turbo(double share) {
  const double x = std::clamp(share, 0.0, 1.0);
  const auto channel = [x](std::array<double, 6> c) {  // A polynomial of degree 5.
    const double value = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
    return static_cast<Rgb>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
  };
  return channel({0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943}) << 16 |
         channel({0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604}) << 8 |
         channel({0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973});
}

HeightColours::HeightColours(const VoxelScene& scene, const Slice& slice) {
  constexpr double kIgnored = 0.003, kStep = 0.2;  // Share; m
  const double edge = scene.edge();
  const auto shown = [&](int z) { return (z + 0.5) * edge >= slice.low && (z + 0.5) * edge <= slice.high; };
  double count = 0.0;
  for (const auto& [z, voxels] : scene.heights())
    if (shown(z)) count += voxels;
  if (count == 0.0) return;
  double below = 0.0;
  bool begun = false;
  for (const auto& [z, voxels] : scene.heights()) {
    if (!shown(z)) continue;
    if (!begun && below + voxels > kIgnored * count) {
      low_ = z * edge;
      begun = true;
    }
    if (below < (1.0 - kIgnored) * count) high_ = (z + 1) * edge;
    below += voxels;
  }
  low_ = std::floor(low_ / kStep + 1e-6) * kStep;
  high_ = std::max(std::ceil(high_ / kStep - 1e-6) * kStep, low_ + 1.0);
}

Rgb HeightColours::at(double z) const {
  constexpr double kFirst = 0.07, kLast = 0.93, kPale = 0.12;
  const double share = std::clamp((z - low_) / (high_ - low_), 0.0, 1.0);
  return mixed(turbo(kFirst + share * (kLast - kFirst)), 0x808080, kPale);
}

std::vector<double> HeightColours::ticks(int most) const {
  double step = 0.1;
  for (int i = 0; (high_ - low_) / step > most; ++i) step *= i % 3 == 1 ? 2.5 : 2.0;
  std::vector<double> out;
  for (double z = std::ceil(low_ / step - 1e-6); z * step <= high_ + 1e-6; ++z) out.push_back(z * step);
  return out;
}

}  // namespace adit::gui
