// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/gui/fixture.hpp"

namespace adit::gui {

/// The corridors, and a hall with a pillar below them, whose ground is at z = -4 m; voxels of 0.2 m.
inline station::TileMap two_floors() {
  station::TileMap map = corridors();
  constexpr int kSide = station::MapTile::kSide;
  for (auto& [place, known] : map.tiles) {
    auto tile = std::make_shared<station::MapTile>(*known);
    std::vector<station::VoxelRun> runs;
    auto above = known->runs.begin();
    for (int cell = 0; cell < kSide * kSide; ++cell) {
      const double x = (tile->x * kSide + cell % kSide + 0.5) * map.resolution,
                   y = (tile->y * kSide + cell / kSide + 0.5) * map.resolution;
      const auto number = static_cast<std::uint16_t>(cell);
      if (x > 6 && x < 24 && y > -8 && y < 3) {
        const bool wall =
            x < 6.4 || x > 23.6 || y < -7.6 || y > 2.6 || (std::abs(x - 12) < 1 && std::abs(y + 6) < 1);
        runs.push_back({number, -21, static_cast<std::uint16_t>(wall ? 14 : 1)});
        if (!wall) runs.push_back({number, -7, 1});  // The ceiling.
        auto& code = tile->cells[static_cast<std::size_t>(cell)];
        if (code == station::MapTile::kUnknown) code = wall ? 15 : station::MapTile::kGround;
      }
      for (; above != known->runs.end() && above->cell == cell; ++above) runs.push_back(*above);
    }
    tile->runs = std::move(runs);
    known = tile;
  }
  map.revision = 2;
  return map;
}

/// The ten robots, of which r4 and r9 are in the hall below.
inline station::World robots_on_two_floors() {
  station::World world = ten_robots();
  for (const std::size_t i : {3U, 8U}) {
    world.robots[i].z = -4.0F;
    world.robots[i].goal[2] = -4.0;
  }
  return world;
}

}  // namespace adit::gui
