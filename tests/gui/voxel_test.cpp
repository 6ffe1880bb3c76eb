// SPDX-License-Identifier: Apache-2.0
// The map in three dimensions: the camera, the voxels, and their picture pixel by pixel.
#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "basestation/gui/scene/voxel_painter.hpp"
#include "core/time/random.hpp"

namespace adit::gui {
namespace {

using station::MapTile;
using station::TileMap;
using station::VoxelRun;

constexpr double kEdge = 0.2;

/// A map of voxels (x, y, z).
TileMap map_of(const std::set<std::array<int, 3>>& voxels) {
  std::map<std::pair<int, int>, MapTile> tiles;
  for (const auto& [x, y, z] : voxels) {
    const auto tile_of = [](int v) {
      return v >= 0 ? v / MapTile::kSide : -((MapTile::kSide - 1 - v) / MapTile::kSide);
    };
    MapTile& tile = tiles[{tile_of(x), tile_of(y)}];
    tile.x = tile_of(x);
    tile.y = tile_of(y);
    tile.runs.push_back({static_cast<std::uint16_t>((y - tile.y * MapTile::kSide) * MapTile::kSide + x -
                                                    tile.x * MapTile::kSide),
                         static_cast<std::int16_t>(z), 1});
  }
  TileMap map{.resolution = kEdge, .revision = 1};
  for (auto& [place, tile] : tiles) map.tiles[place] = std::make_shared<const MapTile>(tile);
  return map;
}

OrbitCamera camera_at(const Point3& target) {
  return {.target = target, .yaw = 0.7, .pitch = 0.6, .distance = 10.0, .width = 320, .height = 240};
}

bool is_covered(const VoxelPainter& painter, const Point& at) {
  return painter.covers(static_cast<int>(at.x), static_cast<int>(at.y));
}

int covered(const VoxelPainter& painter) {
  int count = 0;
  for (int row = 0; row < painter.height(); ++row)
    for (int column = 0; column < painter.width(); ++column) count += painter.covers(column, row);
  return count;
}

TEST(OrbitCamera, APlaceGoesToTheScreenAndBack) {
  const OrbitCamera camera = camera_at({3, -2, 1});
  const auto middle = camera.project({3, -2, 1});
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->at.x, 160, 1e-9);
  EXPECT_NEAR(middle->at.y, 120, 1e-9);
  EXPECT_NEAR(middle->depth, 10, 1e-9);
  const Point3 place{4.5, -1, 2};
  const auto seen = camera.project(place);
  ASSERT_TRUE(seen);
  const Point3 back = camera.to_map(seen->at.x, seen->at.y, seen->depth);
  EXPECT_NEAR(back.x, place.x, 1e-9);
  EXPECT_NEAR(back.y, place.y, 1e-9);
  EXPECT_NEAR(back.z, place.z, 1e-9);
  EXPECT_FALSE(camera.project(camera.eye() - camera.axes()[2])) << "it is behind the camera";
}

TEST(OrbitCamera, UpIsUpAndTheMapFollowsTheFinger) {
  OrbitCamera camera = camera_at({0, 0, 0});
  EXPECT_LT(camera.project({0, 0, 1})->at.y, camera.project({0, 0, 0})->at.y);
  const Point3 place{0, 0, 0};
  camera.pan(30, 0);
  EXPECT_NEAR(camera.project(place)->at.x, 190, 0.5);
  camera = camera_at({0, 0, 0});
  camera.pan(0, 12);
  EXPECT_NEAR(camera.project(place)->at.y, 132, 2.0);
  camera = camera_at({0, 0, 0});
  camera.orbit(20, 0);  // What is nearer than the target follows the finger.
  EXPECT_GT(camera.project(-2.0 * Point3{std::cos(0.7), std::sin(0.7), 0})->at.x, 160);
  for (int i = 0; i < 1000; ++i) camera.orbit(17, 50);
  EXPECT_LE(camera.pitch, OrbitCamera::kMaxPitch);
  EXPECT_LE(std::abs(camera.yaw), std::numbers::pi);
}

TEST(VoxelScene, EveryLevelIsOccupiedWhereAnyFinerVoxelIs) {
  std::set<std::array<int, 3>> voxels;
  Random random(5);
  for (int i = 0; i < 2000; ++i)
    voxels.insert({static_cast<int>(random.uniform() * 400) - 200,
                   static_cast<int>(random.uniform() * 400) - 200,
                   static_cast<int>(random.uniform() * 60) - 30});
  VoxelScene scene;
  scene.show(map_of(voxels));
  EXPECT_EQ(scene.voxels(), voxels.size());
  for (int level = 0; level < VoxelScene::kLevels; ++level) {
    std::set<std::array<int, 3>> got, expected;
    for (const auto& [x, y, z] : voxels) expected.insert({x >> level, y >> level, z >> level});
    for (const VoxelScene::Brick* brick : scene.bricks())
      for (const VoxelScene::Voxel& voxel : brick->levels[static_cast<std::size_t>(level)])
        got.insert({static_cast<int>(std::lround(brick->x / kEdge)) / (1 << level) + voxel.x,
                    static_cast<int>(std::lround(brick->y / kEdge)) / (1 << level) + voxel.y, voxel.z});
    EXPECT_EQ(got, expected) << "level " << level;
  }
}

TEST(VoxelScene, ReadsOnlyTheTilesThatChanged) {
  TileMap map = map_of({{0, 0, 0}, {200, 0, 0}});
  VoxelScene scene;
  scene.show(map);
  const VoxelScene::Brick* kept = scene.bricks().front();
  const MapTile other = *map_of({{201, 3, 4}, {200, 0, 0}}).tiles.at({1, 0});
  map.tiles[{1, 0}] = std::make_shared<const MapTile>(other);
  scene.show(map);
  EXPECT_EQ(scene.bricks().front(), kept);
  EXPECT_EQ(scene.voxels(), 3U);
  map.tiles.erase({1, 0});
  scene.show(map);
  EXPECT_EQ(scene.voxels(), 1U) << "another station's map";
  scene.show({});
  EXPECT_TRUE(scene.empty());
}

TEST(VoxelScene, SidesBetweenNeighboursAreNotSeenAtAnyLevel) {
  std::set<std::array<int, 3>> voxels;
  Random random(7);
  for (int i = 0; i < 3000; ++i)
    voxels.insert({static_cast<int>(random.uniform() * 40) + 10, static_cast<int>(random.uniform() * 40) + 10,
                   static_cast<int>(random.uniform() * 12) - 6});
  VoxelScene scene;
  scene.show(map_of(voxels));
  constexpr std::array<std::array<int, 3>, 6> kBeside{
      {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
  for (int level = 0; level < VoxelScene::kLevels; ++level) {
    std::set<std::array<int, 3>> coarse;
    for (const auto& [x, y, z] : voxels) coarse.insert({x >> level, y >> level, z >> level});
    for (const VoxelScene::Brick* brick : scene.bricks())
      for (const VoxelScene::Voxel& voxel : brick->levels[static_cast<std::size_t>(level)]) {
        const int x = static_cast<int>(std::lround(brick->x / kEdge)) / (1 << level) + voxel.x,
                  y = static_cast<int>(std::lround(brick->y / kEdge)) / (1 << level) + voxel.y;
        for (std::size_t side = 0; side < kBeside.size(); ++side)
          EXPECT_EQ((voxel.sides >> side & 1) == 0,
                    coarse.contains({x + kBeside[side][0], y + kBeside[side][1], voxel.z + kBeside[side][2]}))
              << "level " << level << ", side " << side;
      }
  }
}

TEST(VoxelScene, TheCornersOfASliceReachAsFarAsItsVoxels) {
  VoxelScene scene;
  scene.show(map_of({{3, 40, 0}, {9, 45, 9}, {200, 0, 20}}));
  Point3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const Point3& corner : scene.corners(-1.0, 1.0)) {
    low = {std::min(low.x, corner.x), std::min(low.y, corner.y), std::min(low.z, corner.z)};
    high = {std::max(high.x, corner.x), std::max(high.y, corner.y), std::max(high.z, corner.z)};
  }
  EXPECT_NEAR(low.x, 0.6, 1e-9);
  EXPECT_NEAR(high.x, 2.0, 1e-9) << "the column farther east is above the slice";
  EXPECT_NEAR(high.y, 9.2, 1e-9);
  EXPECT_NEAR(high.z, 1.0, 1e-9);
}

TEST(VoxelPainter, AVoxelIsPaintedWhereItIsAndNowhereElse) {
  VoxelScene scene;
  scene.show(map_of({{10, 5, 3}}));
  const Point3 centre{10.5 * kEdge, 5.5 * kEdge, 3.5 * kEdge};
  const OrbitCamera camera = camera_at(centre);
  VoxelPainter painter;
  painter.paint(scene, camera, {}, kDark, Detail3::fine);
  ASSERT_EQ(painter.pixels().size(), 320U * 240U);
  EXPECT_TRUE(is_covered(painter, {160, 120}));
  const double pixels = kEdge * camera.focal() / camera.distance;
  EXPECT_GE(covered(painter), pixels * pixels * 0.8);
  EXPECT_LE(covered(painter), pixels * pixels * 3.0);
  EXPECT_FALSE(is_covered(painter, {160 + 2 * pixels, 120}));
  EXPECT_FALSE(is_covered(painter, {160, 120 - 2 * pixels}));
  // The place under a finger is its surface.
  const auto place = painter.pick(160, 120);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->x, centre.x, 0.15);
  EXPECT_NEAR(place->z, centre.z, 0.15);
  EXPECT_FALSE(painter.pick(20, 20));
}

TEST(VoxelPainter, ASliceHidesWhatIsAboveAndBelow) {
  std::set<std::array<int, 3>> voxels;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) voxels.insert({x, y, 0}), voxels.insert({x, y, 12});
  VoxelScene scene;
  scene.show(map_of(voxels));
  OrbitCamera camera = camera_at({2, 2, 0});
  camera.pitch = OrbitCamera::kMaxPitch;
  VoxelPainter painter;
  painter.paint(scene, camera, {}, kDark, Detail3::fine);
  EXPECT_NEAR(painter.pick(160, 120)->z, 2.5, 0.2) << "the ceiling";
  painter.paint(scene, camera, {-1e9, 1.5}, kDark, Detail3::fine);
  EXPECT_NEAR(painter.pick(160, 120)->z, 0.1, 0.2) << "the floor below it";
  EXPECT_EQ(painter.drawn(), 400U);
  painter.paint(scene, camera, {0.5, 1.5}, kDark, Detail3::fine);
  EXPECT_EQ(covered(painter), 0);
}

TEST(VoxelPainter, WhatIsNearerHidesWhatIsBehindItInAnyOrder) {
  std::set<std::array<int, 3>> voxels;
  for (int y = -20; y < 20; ++y)
    for (int z = 0; z < 20; ++z) voxels.insert({0, y, z}), voxels.insert({70, y, z});
  VoxelScene scene;
  scene.show(map_of(voxels));
  OrbitCamera camera{
      .target = {7, 0, 2}, .yaw = 0.0, .pitch = 0.05, .distance = 20, .width = 200, .height = 150};
  VoxelPainter painter;
  painter.paint(scene, camera, {}, kDark, Detail3::fine);
  EXPECT_NEAR(painter.pick(100, 75)->x, 0.1, 0.3);
  camera.yaw = std::numbers::pi;
  painter.paint(scene, camera, {}, kDark, Detail3::fine);
  EXPECT_NEAR(painter.pick(100, 75)->x, 14.1, 0.3);
}

TEST(VoxelPainter, FarVoxelsAreMergedAndCoverTheSamePixels) {
  std::set<std::array<int, 3>> voxels;
  for (int x = -64; x < 64; ++x)
    for (int y = -64; y < 64; ++y) voxels.insert({x, y, 0});
  VoxelScene scene;
  scene.show(map_of(voxels));
  OrbitCamera camera = camera_at({0, 0, 0});
  camera.distance = 200;
  VoxelPainter painter;
  painter.paint(scene, camera, {}, kDark, Detail3::fine);
  const int fine = covered(painter);
  const std::size_t drawn = painter.drawn();
  EXPECT_LT(drawn, voxels.size() / 3);
  painter.paint(scene, camera, {}, kDark, Detail3::moving);
  EXPECT_LT(painter.drawn(), drawn);
  EXPECT_NEAR(covered(painter), fine, 0.35 * fine);
}

TEST(VoxelPainter, SidesOfABlockDifferInBrightnessAndEachIsEven) {
  std::set<std::array<int, 3>> voxels;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      for (int z = 0; z < 20; ++z) voxels.insert({x, y, z});
  VoxelScene scene;
  scene.show(map_of(voxels));
  for (const double distance : {8.0, 60.0}) {  // In sides of voxels, and in squares.
    OrbitCamera camera{
        .target = {2, 2, 2}, .yaw = 0.6, .pitch = 0.6, .distance = distance, .width = 640, .height = 480};
    VoxelPainter painter;
    painter.paint(scene, camera, {}, kDark, Detail3::fine);
    const auto pixel = [&](const Point3& place) {
      const auto seen = camera.project(place);
      return painter
          .pixels()[static_cast<std::size_t>(seen->at.y) * 640 + static_cast<std::size_t>(seen->at.x)];
    };
    const auto brightness = [](std::uint32_t p) { return (p >> 16 & 0xFF) + (p >> 8 & 0xFF) + (p & 0xFF); };
    const std::uint32_t top = pixel({2, 2, 4});
    if (distance < 10) {
      const std::uint32_t west = pixel({0, 2, 3.9}), south = pixel({2, 0, 3.9});
      EXPECT_GT(brightness(top), brightness(west) * 1.2);
      EXPECT_GT(brightness(west), brightness(south) * 1.2);
    }
    for (const double x : {1.2, 1.7, 2.3, 2.9})
      EXPECT_EQ(pixel({x, 2.5, 4}), top) << "no pattern on a plane, " << distance;
    const auto place = painter.pick(camera.project({2, 2, 4})->at.x, camera.project({2, 2, 4})->at.y);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->z, 4.0, 0.05);
  }
}

TEST(VoxelPainter, TheGridShowsWhereNoVoxelIs) {
  VoxelScene scene;
  scene.show(map_of({{0, 0, 0}, {100, 100, 0}}));
  OrbitCamera camera = camera_at({10, 10, 0});
  camera.distance = 40;
  VoxelPainter painter;
  painter.paint(scene, camera, {}, kDark, Detail3::fine);
  ASSERT_EQ(grid_step(camera), 20.0);
  const auto seen = camera.project({10, 0, 0});  // In the middle of a side.
  const auto column = static_cast<std::size_t>(seen->at.x), row = static_cast<std::size_t>(seen->at.y);
  int lines = 0;
  for (std::size_t i = row - 2; i <= row + 2; ++i)
    lines += painter.pixels()[i * 320 + column] != (0xFF000000U | kDark.ground);
  EXPECT_GE(lines, 1);
  EXPECT_LE(lines, 3);
  EXPECT_FALSE(painter.pick(seen->at.x, seen->at.y)) << "it is no place of the map";
}

TEST(HeightColours, FollowTheSliceAndIgnoreSingleVoxels) {
  std::set<std::array<int, 3>> voxels{{5, 5, -200}, {6, 6, 300}};
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) voxels.insert({x, y, 0}), voxels.insert({x, 0, y / 3});
  VoxelScene scene;
  scene.show(map_of(voxels));
  const HeightColours all(scene, {});
  EXPECT_NEAR(all.low(), 0.0, 1e-9);
  EXPECT_NEAR(all.high(), 2.8, 1e-9);
  EXPECT_NEAR(HeightColours(scene, {-1e9, 1.0}).high(), 1.0, 1e-9);
  EXPECT_NE(all.at(0.0), all.at(1.5));
  EXPECT_EQ(all.at(-40.0), all.at(0.0));
  const auto ticks = all.ticks(6);
  EXPECT_THAT(ticks, testing::SizeIs(testing::AllOf(testing::Ge(3U), testing::Le(7U))));
  EXPECT_GE(ticks.front(), all.low() - 1e-9);
  EXPECT_LE(ticks.back(), all.high() + 1e-9);
}

TEST(HeightColours, AreTurbo) {
  // The table that its author published, which the polynomial approximates.
  const auto near = [](Rgb a, Rgb b) {
    for (const int shift : {0, 8, 16})
      if (std::abs(static_cast<int>(a >> shift & 0xFF) - static_cast<int>(b >> shift & 0xFF)) > 24)
        return false;
    return true;
  };
  EXPECT_PRED2(near, turbo(0.25), 0x28BCEB);
  EXPECT_PRED2(near, turbo(0.5), 0xA4FC3C);
  EXPECT_PRED2(near, turbo(1.0), 0x7A0403);
}

TEST(VoxelPainter, OddCamerasAndMapsPaintSomethingOrNothing) {
  VoxelScene scene;
  scene.show(map_of({{0, 0, 0}, {-3000, 4000, -32000}, {5, 5, 32000}}));
  VoxelPainter painter;
  for (const double distance : {0.5, 10.0, 5000.0})
    for (const double pitch : {0.05, 1.57})
      for (const auto& [width, height] : {std::pair{0.0, 0.0}, {1.0, 1.0}, {300.0, 2.0}}) {
        painter.paint(
            scene,
            {.target = {0, 0, 0}, .pitch = pitch, .distance = distance, .width = width, .height = height},
            {-1e300, 1e300}, kLight, Detail3::fine);
        (void)painter.pick(-5, 1e6);
      }
  EXPECT_GE(painter.width(), 1);
}

}  // namespace
}  // namespace adit::gui
