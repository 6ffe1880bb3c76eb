// SPDX-License-Identifier: Apache-2.0
#include "sim/world/world.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace adit::sim {

double World::column_floor(int i, int j, double headroom) const {
  const std::vector<double>& levels = grid_.levels();
  constexpr double tolerance = 1e-6;
  if (!grid_.inside(i, j))
    return grid_.open_sides() && levels.back() - levels.front() >= headroom - tolerance
               ? levels.front()
               : std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < grid_.layers(); ++k) {
    if (grid_.solid(i, j, k)) continue;
    const int bottom = k;
    while (k < grid_.layers() && !grid_.solid(i, j, k)) ++k;
    if (levels[k] - levels[bottom] >= headroom - tolerance) return levels[bottom];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

Result<double> World::ground_height(double x, double y, double headroom) const {
  if (!std::isfinite(x) || !std::isfinite(y) || std::abs(x) > 1e6 || std::abs(y) > 1e6)
    return {Reason::out_of_range, "a position outside the world"};
  const double floor = column_floor(grid_.column_x(x), grid_.column_y(y), headroom);
  if (std::isnan(floor))
    return {Reason::out_of_range,
            fmt::format("{}: no floor with {:.2f} m of headroom at ({:.2f}, {:.2f})", name_, headroom, x, y)};
  return floor;
}

Result<std::filesystem::path> find_map(const std::string& name,
                                       std::span<const std::filesystem::path> folders) {
  std::error_code ignored;
  if (std::filesystem::path(name).is_absolute()) {
    if (std::filesystem::is_regular_file(name, ignored)) return std::filesystem::path(name);
    return {Reason::cannot_read, name + ": no such map"};
  }
  std::string looked;
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path file = folder / name;
    if (std::filesystem::is_regular_file(file, ignored)) return file;
    looked += (looked.empty() ? "" : ", ") + folder.string();
  }
  return {Reason::cannot_read, fmt::format("{}: no such map in {}; run ./run setup to fetch the maps", name,
                                           looked.empty() ? "any folder" : looked)};
}

}  // namespace adit::sim
