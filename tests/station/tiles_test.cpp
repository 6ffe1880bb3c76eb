// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/tiles.hpp"

#include <gmock/gmock.h>

namespace adit::station {
namespace {

using perception::Voxel;
using perception::VoxelImage;

constexpr double kEdge = 0.2;  // m

std::uint8_t cell(const std::vector<MapTile>& tiles, int x, int y) {
  for (const MapTile& tile : tiles) {
    const int dx = x - tile.x * MapTile::kSide, dy = y - tile.y * MapTile::kSide;
    if (dx >= 0 && dx < MapTile::kSide && dy >= 0 && dy < MapTile::kSide)
      return tile.cells[static_cast<std::size_t>(dy) * MapTile::kSide + static_cast<std::size_t>(dx)];
  }
  return MapTile::kUnknown;
}

/// Free ground at some places, with a wall of 1.2 m at one of them.
VoxelImage image() {
  VoxelImage out(kEdge);
  for (const auto& [x, y] : {std::pair{-1, 0}, {0, 0}, {127, 5}, {128, 5}, {-129, -128}})
    out.set({x, y, 0}, Voxel::free);
  for (int z = 0; z < 6; ++z) out.set({-128, -1, z}, Voxel::occupied);
  return out;
}

TEST(Tiles, LieOnOneGridAlsoAtNegativePlaces) {
  const std::vector<MapTile> tiles = tiles_of(TopView(image()));
  std::vector<std::pair<int, int>> places;
  for (const MapTile& tile : tiles) places.emplace_back(tile.x, tile.y);
  EXPECT_THAT(places, testing::UnorderedElementsAre(std::pair{-1, 0}, std::pair{0, 0}, std::pair{1, 0},
                                                    std::pair{-2, -1}, std::pair{-1, -1}));
  for (const auto& [x, y] : {std::pair{-1, 0}, {0, 0}, {127, 5}, {128, 5}, {-129, -128}})
    EXPECT_EQ(cell(tiles, x, y), MapTile::kGround) << x << " " << y;
  EXPECT_EQ(cell(tiles, -128, -1), MapTile::kThing + 5) << "six voxels high";
  EXPECT_EQ(cell(tiles, 1, 0), MapTile::kUnknown);
}

TEST(Tiles, OnlyWhatChangedIsSentAndAllOfItInParts) {
  Tiles tiles;
  EXPECT_TRUE(tiles.since(0, 10).tiles.empty());
  VoxelImage map = image();
  tiles.show(kEdge, tiles_of(TopView(map)));
  const MapUpdate all = tiles.since(0, 10);
  EXPECT_EQ(all.tiles.size(), 5U);
  EXPECT_EQ(all.revision, tiles.revision());

  // The same view changes nothing.
  tiles.show(kEdge, tiles_of(TopView(map)));
  EXPECT_EQ(tiles.revision(), all.revision);
  EXPECT_TRUE(tiles.since(all.revision, 10).tiles.empty());

  map.set({3, 3, 0}, Voxel::free);
  tiles.show(kEdge, tiles_of(TopView(map)));
  const MapUpdate one = tiles.since(all.revision, 10);
  ASSERT_EQ(one.tiles.size(), 1U);
  EXPECT_EQ(cell(one.tiles, 3, 3), MapTile::kGround);

  // In parts of two, with a change between two parts.
  TileMap client;
  for (int asked = 0; asked < 10 && client.revision < tiles.revision(); ++asked) {
    client = updated(client, tiles.since(client.revision, 2));
    if (asked != 0) continue;
    map.set({4, 4, 0}, Voxel::free);
    tiles.show(kEdge, tiles_of(TopView(map)));
  }
  const MapUpdate whole = tiles.since(0, 10);
  ASSERT_EQ(client.tiles.size(), whole.tiles.size());
  for (const MapTile& tile : whole.tiles) EXPECT_EQ(client.tiles.at({tile.x, tile.y})->cells, tile.cells);
}

TEST(Tiles, WhatIsGoneFromTheViewBecomesUnknown) {
  Tiles tiles;
  tiles.show(kEdge, tiles_of(TopView(image())));
  TileMap client = updated({}, tiles.since(0, 10));
  VoxelImage small(kEdge);
  small.set({0, 0, 0}, Voxel::free);
  tiles.show(kEdge, tiles_of(TopView(small)));
  client = updated(client, tiles.since(client.revision, 10));
  for (const auto& [place, tile] : client.tiles) {
    const bool known =
        std::ranges::any_of(tile->cells, [](std::uint8_t c) { return c != MapTile::kUnknown; });
    EXPECT_EQ(known, place == std::pair(0, 0)) << place.first << " " << place.second;
  }
}

}  // namespace
}  // namespace adit::station
