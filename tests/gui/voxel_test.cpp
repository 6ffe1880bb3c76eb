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

int covered(const VoxelPainter& painter) {
  return static_cast<int>(std::count_if(painter.pixels().begin(), painter.pixels().end(),
                                        [](std::uint32_t p) { return p != (0xFF000000U | kDark.ground); }));
}

bool is_covered(const VoxelPainter& painter, const Point& at) {
  return painter.pixels()[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(painter.width()) +
                          static_cast<std::size_t>(at.x)] != (0xFF000000U | kDark.ground);
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

TEST(OrbitCamera, FitsABoxIntoTheViewAndFillsIt) {
  for (const auto& [width, height] : {std::pair{1000.0, 400.0}, {400.0, 1000.0}}) {
    OrbitCamera camera{.width = width, .height = height};
    const Point3 low{-7, -5, -0.2}, high{30, 9, 3};
    camera.fit(low, high);
    double widest = 0.0;
    for (const double x : {low.x, high.x})
      for (const double y : {low.y, high.y})
        for (const double z : {low.z, high.z}) {
          const auto seen = camera.project({x, y, z});
          ASSERT_TRUE(seen);
          widest =
              std::max({widest, std::abs(seen->at.x / width - 0.5), std::abs(seen->at.y / height - 0.5)});
        }
    EXPECT_LE(widest, 0.5);
    EXPECT_GE(widest, 0.44);
  }
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
