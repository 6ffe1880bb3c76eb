// SPDX-License-Identifier: Apache-2.0
#include "basestation/map/tiles.hpp"

#include <gmock/gmock.h>

#include <array>

#include "core/time/random.hpp"

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
  const std::vector<MapTile> tiles = tiles_of(image());
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
  tiles.show(kEdge, tiles_of(map));
  const MapUpdate all = tiles.since(0, 10);
  EXPECT_EQ(all.tiles.size(), 5U);
  EXPECT_EQ(all.revision, tiles.revision());

  // The same view changes nothing.
  tiles.show(kEdge, tiles_of(map));
  EXPECT_EQ(tiles.revision(), all.revision);
  EXPECT_TRUE(tiles.since(all.revision, 10).tiles.empty());

  map.set({3, 3, 0}, Voxel::free);
  tiles.show(kEdge, tiles_of(map));
  const MapUpdate one = tiles.since(all.revision, 10);
  ASSERT_EQ(one.tiles.size(), 1U);
  EXPECT_EQ(cell(one.tiles, 3, 3), MapTile::kGround);

  // In parts of two, with a change between two parts.
  TileMap client;
  for (int asked = 0; asked < 10 && client.revision < tiles.revision(); ++asked) {
    client = updated(client, tiles.since(client.revision, 2));
    if (asked != 0) continue;
    map.set({4, 4, 0}, Voxel::free);
    tiles.show(kEdge, tiles_of(map));
  }
  const MapUpdate complete = tiles.since(0, 10);
  ASSERT_EQ(client.tiles.size(), complete.tiles.size());
  for (const MapTile& tile : complete.tiles) EXPECT_EQ(client.tiles.at({tile.x, tile.y})->cells, tile.cells);
}

TEST(Tiles, WhatIsGoneFromTheViewBecomesUnknown) {
  Tiles tiles;
  tiles.show(kEdge, tiles_of(image()));
  TileMap client = updated({}, tiles.since(0, 10));
  VoxelImage small(kEdge);
  small.set({0, 0, 0}, Voxel::free);
  tiles.show(kEdge, tiles_of(small));
  client = updated(client, tiles.since(client.revision, 10));
  for (const auto& [place, tile] : client.tiles) {
    const bool known =
        std::ranges::any_of(tile->cells, [](std::uint8_t c) { return c != MapTile::kUnknown; });
    EXPECT_EQ(known, place == std::pair(0, 0)) << place.first << " " << place.second;
  }
}

/// The occupied voxels of tiles, as (x, y, z).
std::vector<std::array<int, 3>> voxels(const std::vector<MapTile>& tiles) {
  std::vector<std::array<int, 3>> out;
  for (const MapTile& tile : tiles)
    for (const VoxelRun& run : tile.runs)
      for (int z = run.z; z < run.z + run.length; ++z)
        out.push_back({tile.x * MapTile::kSide + run.cell % MapTile::kSide,
                       tile.y * MapTile::kSide + run.cell / MapTile::kSide, z});
  std::ranges::sort(out);
  return out;
}

TEST(Tiles, HaveEveryOccupiedVoxelOnce) {
  VoxelImage map = image();
  Random random(3);
  for (int i = 0; i < 3000; ++i)
    map.set({static_cast<int>(random.uniform() * 300) - 150, static_cast<int>(random.uniform() * 300) - 150,
             static_cast<int>(random.uniform() * 20) - 10},
            Voxel::occupied);
  std::vector<std::array<int, 3>> expected;
  for (const auto& index : map.occupied()) expected.push_back({index.x, index.y, index.z});
  std::ranges::sort(expected);
  EXPECT_EQ(voxels(tiles_of(map)), expected);
  for (const MapTile& tile : tiles_of(map))
    for (std::size_t i = 1; i < tile.runs.size(); ++i) {
      const VoxelRun &a = tile.runs[i - 1], &b = tile.runs[i];
      EXPECT_TRUE(a.cell < b.cell || (a.cell == b.cell && a.z + a.length < b.z)) << "in order, none touches";
    }
}

TEST(Tiles, AreSentAgainWhenAVoxelChangesThatIsNotSeenFromAbove) {
  VoxelImage map = image();
  Tiles tiles;
  tiles.show(kEdge, tiles_of(map));
  const std::uint64_t before = tiles.revision();
  map.set({-128, -1, 20}, Voxel::occupied);  // Higher than the wall, and a gap between.
  tiles.show(kEdge, tiles_of(map));
  EXPECT_EQ(tiles.since(before, 10).tiles.size(), 1U);
}

TEST(Tiles, ARegionHasTheAgeOfItsNewestBlock) {
  VoxelImage map(kEdge);
  for (const int x : {0, 10, 127, -1}) map.set({x, 1, 0}, Voxel::free);
  std::vector<MapTile> tiles = tiles_of(map);
  MapPart part{Pose3{}, {{{0, 0, 0}, 1, 0}, {{0, 0, 1}, 1, 0}, {{31, 0, 0}, 1, 0}, {{-1, 0, 0}, 1, 0}}, true};
  part.received = {41, 101, 0, 201};
  add_received(tiles, {part}, kEdge);
  Tiles view;
  view.show(kEdge, tiles);
  MapUpdate update = view.since(0, 10);
  update.clock = tile_clock(401);
  const TileMap shown = updated({}, std::move(update));
  const MapTile& right = *shown.tiles.at({0, 0});
  EXPECT_EQ(age_at(shown, right, 1, 1), 30.0) << "the newest of two";
  EXPECT_EQ(age_at(shown, right, 127, 1), std::nullopt) << "from the disk";
  EXPECT_EQ(age_at(shown, right, 20, 1), std::nullopt);
  EXPECT_EQ(age_at(shown, *shown.tiles.at({-1, 0}), 127, 1), 20.0);

  // A newer time of a region is sent, though it looks the same.
  const std::uint64_t before = view.revision();
  part.received[0] = 301;
  std::vector<MapTile> later = tiles_of(map);
  add_received(later, {part}, kEdge);
  view.show(kEdge, later);
  EXPECT_EQ(view.since(before, 10).tiles.size(), 1U);
}

}  // namespace
}  // namespace adit::station
