// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/world/world.hpp"

namespace adit::sim {
namespace {

constexpr double kResolution = 0.05;
/// Open ground around the boxes that belongs to the grid, m: clearances are measured there.
constexpr double kMargin = 2.0;

bool sane(const Box& b) {
  return std::all_of(b.begin(), b.end(), [](double v) { return std::isfinite(v) && std::abs(v) < 1e4; }) &&
         b[0] < b[1] && b[2] < b[3] && b[4] < b[5];
}

/// Borders of the layers: floor, ceiling, and every height where a box begins or ends.
std::vector<double> cut_levels(std::span<const Box> boxes, double floor, double ceiling) {
  std::vector<double> levels{floor, ceiling};
  for (const Box& box : boxes)
    for (const double z : {box[4], box[5]})
      if (z > floor && z < ceiling) levels.push_back(z);
  std::sort(levels.begin(), levels.end());
  constexpr double same = 1e-6;
  levels.erase(std::unique(levels.begin(), levels.end(), [](double a, double b) { return b - a < same; }),
               levels.end());
  return levels;
}

struct Span {
  int begin, end;
};
Span columns(double low, double high, double origin) {
  const int begin = static_cast<int>(std::lround((low - origin) / kResolution));
  return {begin, std::max(begin + 1, static_cast<int>(std::lround((high - origin) / kResolution)))};
}

}  // namespace

Result<World> make_box_world(std::span<const Box> boxes, double floor, double ceiling) {
  if (!std::isfinite(floor) || !std::isfinite(ceiling) || floor >= ceiling)
    return {Reason::bad_argument, "boxes: the ceiling must be above the floor"};
  double x0 = 0.0, x1 = 0.0, y0 = 0.0, y1 = 0.0;
  for (std::size_t n = 0; n < boxes.size(); ++n) {
    const Box& box = boxes[n];
    if (!sane(box))
      return {Reason::bad_argument,
              fmt::format("boxes: box {}: expected [x0, x1, y0, y1, z0, z1] in metres with x0 < x1, y0 < y1, "
                          "z0 < z1",
                          n + 1)};
    x0 = n == 0 ? box[0] : std::min(x0, box[0]);
    x1 = n == 0 ? box[1] : std::max(x1, box[1]);
    y0 = n == 0 ? box[2] : std::min(y0, box[2]);
    y1 = n == 0 ? box[3] : std::max(y1, box[3]);
  }
  // The origin is a whole number of columns, so that boxes on multiples of 0.05 m are exact.
  const double ox = std::floor((x0 - kMargin) / kResolution) * kResolution;
  const double oy = std::floor((y0 - kMargin) / kResolution) * kResolution;
  const std::int64_t nx = std::llround(std::ceil((x1 + kMargin - ox) / kResolution));
  const std::int64_t ny = std::llround(std::ceil((y1 + kMargin - oy) / kResolution));
  std::vector<double> levels = cut_levels(boxes, floor, ceiling);
  const int layers = static_cast<int>(levels.size()) - 1;
  if (nx * ny * layers > VoxelGrid::kMaxCells)
    return {Reason::bad_argument,
            fmt::format("boxes: a world of {:.0f} x {:.0f} m with {} different heights is too large", x1 - x0,
                        y1 - y0, layers)};
  VoxelGrid grid({ox, oy}, kResolution, static_cast<int>(nx), static_cast<int>(ny), std::move(levels), true);
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) grid.set(i, j, k, false);
  for (const Box& box : boxes) {
    const Span x = columns(box[0], box[1], ox), y = columns(box[2], box[3], oy);
    for (int k = 0; k < layers; ++k) {
      const double middle = 0.5 * (grid.levels()[k] + grid.levels()[k + 1]);
      if (middle < box[4] || middle > box[5]) continue;
      for (int j = y.begin; j < y.end; ++j)
        for (int i = x.begin; i < x.end; ++i) grid.set(i, j, k, true);
    }
  }
  grid.build();
  return World("boxes", std::move(grid));
}

}  // namespace adit::sim
