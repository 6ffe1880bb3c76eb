// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/floors.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "basestation/gui/scene/floor_choice.hpp"
#include "tests/gui/floor_fixture.hpp"

namespace adit::gui {
namespace {

using station::MapTile;

std::vector<std::string> names(const Floors& floors) {
  std::vector<std::string> out;
  for (const Floor& floor : floors.floors()) out.push_back(floor.name);
  return out;
}

Floors floors_of(const station::TileMap& map, const station::World& world) {
  Floors floors;
  floors.show(map);
  floors.show(world, Trails{});
  return floors;
}

/// A tile of 25.6 m whose ground rises by `slope`, below a ceiling 2.4 m above it.
station::TileMap ramp(double slope) {
  station::TileMap map;
  auto tile = std::make_shared<MapTile>();
  tile->cells.assign(std::size_t{MapTile::kSide} * MapTile::kSide, MapTile::kGround);
  for (int cell = 0; cell < MapTile::kSide * MapTile::kSide; ++cell) {
    const auto z = static_cast<std::int16_t>(std::lround(cell % MapTile::kSide * slope));
    const auto number = static_cast<std::uint16_t>(cell);
    tile->runs.push_back({number, z, 1});
    tile->runs.push_back({number, static_cast<std::int16_t>(z + 13), 1});
  }
  map.tiles[{0, 0}] = tile;
  return map;
}

TEST(Floors, AreWhereRobotsCouldDriveAndNamedFromTheStation) {
  station::World world = ten_robots();
  Floors floors = floors_of(two_floors(), world);
  ASSERT_EQ(names(floors), (std::vector<std::string>{"-1", "0"}));
  EXPECT_NEAR(floors.floors()[0].z, -4.0, 0.01);
  EXPECT_NEAR(floors.floors()[1].z, 0.0, 0.01);
  world.stations[0].place = {{10.0F, 0.0F, -3.8F}};
  floors = floors_of(two_floors(), world);
  EXPECT_EQ(names(floors), (std::vector<std::string>{"0", "+1"}));
}

TEST(Floors, OneFloorWithItsCeilingAndFurnitureIsOne) {
  EXPECT_EQ(names(floors_of(corridors(), ten_robots())), (std::vector<std::string>{"0"}));
  EXPECT_TRUE(floors_of({}, {}).floors().empty());
}

TEST(Floors, ARobotAloneMakesOneAndARampMakesNone) {
  station::World world{.robots = {robot("r1", 0, 0), robot("r2", 5, 0)}};
  world.robots[1].z = -6.1F;
  EXPECT_EQ(names(floors_of({}, world)), (std::vector<std::string>{"-1", "0"}));
  world.robots[1].platform = "aerial";
  EXPECT_EQ(names(floors_of({}, world)), (std::vector<std::string>{"0"})) << "it may fly at any height";
  EXPECT_TRUE(floors_of(ramp(0.3), {}).floors().empty());
  EXPECT_EQ(floors_of(ramp(0.0), {}).floors().size(), 1U);
}

TEST(Floors, TheNamesStayWhileTheFirstRobotChangesItsFloor) {
  station::World world{.robots = {robot("r1", 12, 0)}};
  Floors floors;
  floors.show(two_floors());
  EXPECT_TRUE(floors.show(world, Trails{}));
  EXPECT_FALSE(floors.show(world, Trails{}));
  world.robots[0].z = -4.0F;
  floors.show(world, Trails{});
  EXPECT_EQ(names(floors), (std::vector<std::string>{"-1", "0"}));
}

TEST(Floors, TilesThatGoAwayOrChangeAreForgotten) {
  Floors floors;
  floors.show(two_floors());
  floors.show(corridors());
  floors.show({}, Trails{});
  EXPECT_EQ(floors.floors().size(), 1U);
  station::TileMap none;
  floors.show(none);
  floors.show({}, Trails{});
  EXPECT_TRUE(floors.floors().empty());
}

TEST(Floors, HeightsThatAreNoneAreLeftOut) {
  for (const float wrong : {1e30F, -1e30F, std::numeric_limits<float>::quiet_NaN()}) {
    station::World world = ten_robots();
    for (station::Robot& robot : world.robots) robot.z = wrong;
    world.stations[0].place = {{0.0F, 0.0F, wrong}};
    const Floors floors = floors_of(two_floors(), world);
    EXPECT_EQ(floors.floors().size(), 2U);
    EXPECT_FALSE(floors.floor_at(wrong) && std::isnan(wrong));
  }
}

TEST(Floors, WhatStandsOnAFloorBelongsToIt) {
  const Floors floors = floors_of(two_floors(), ten_robots());
  EXPECT_EQ(floors.floor_at(-4.2), 0U);
  EXPECT_EQ(floors.floor_at(-1.0), 0U);
  EXPECT_EQ(floors.floor_at(-0.3), 1U);
  EXPECT_EQ(floors.floor_at(2.0), 1U);
}

TEST(Slices, ShowAFloorAndGhostsOfOthers) {
  const station::TileMap map = two_floors();
  std::vector<std::uint8_t> cells;
  const auto at = [&](double x, double y, const Floor& floor) {
    const int column = static_cast<int>(std::floor(x / 0.2)), row = static_cast<int>(std::floor(y / 0.2));
    const std::pair key{column < 0 ? -1 : column / 128, row < 0 ? -1 : row / 128};
    slice_cells(*map.tiles.at(key), map.resolution, floor, cells);
    return int{cells[static_cast<std::size_t>((row - key.second * 128) * 128 + column - key.first * 128)]};
  };
  const Floor below{.z = -4.0}, above{.z = 0.0};
  EXPECT_EQ(at(10, -3, below), MapTile::kGround) << "below its ceiling and the floor above";
  EXPECT_EQ(at(12, -6, below), MapTile::kThing + 10) << "a pillar up to the end of the slice";
  EXPECT_GT(at(12, -6, above), kGhost);
  EXPECT_EQ(at(10, 0, above), MapTile::kGround);
  EXPECT_GT(at(-4, 0, below), kGhost);
  EXPECT_EQ(at(15, 12, below), MapTile::kUnknown);
  EXPECT_EQ(at(13.5, 5.5, above), MapTile::kThing + 2) << "furniture, three voxels";
  MapTile wrong;
  slice_cells(wrong, 0.2, above, cells);
  EXPECT_EQ(cells.size(), std::size_t{128} * 128);
}

TEST(Slices, TheGroundIsThatOfTheFloorAtThePlace) {
  station::TileMap map = two_floors();
  EXPECT_NEAR(ground_at(map, {.z = -4.0}, {10, -3}), -4.0, 1e-6);
  EXPECT_NEAR(ground_at(map, {.z = 0.0}, {10, 0}), 0.0, 1e-6);
  EXPECT_EQ(ground_at(map, {.z = -4.0}, {-4, 0}), -4.0) << "not seen";
  EXPECT_EQ(ground_at(map, {.z = -4.0}, {1e30, 0}), -4.0);
}

TEST(FloorChoice, FollowsTheSelectionUntilOneIsChosen) {
  const station::World world = robots_on_two_floors();
  const Floors floors = floors_of(two_floors(), world);
  FloorChoice choice;
  const auto label = [&](const std::vector<std::string>& selection) {
    choice.update(floors, world, selection);
    return choice.label();
  };
  EXPECT_EQ(label({}), "floor 0, auto");
  EXPECT_EQ(label({"r1", "r4"}), "floor -1, auto");
  EXPECT_EQ(label({}), "floor -1, auto") << "it stays";
  choice.move(1, floors);
  EXPECT_EQ(label({"r4"}), "floor 0");
  choice.move(1, floors);
  EXPECT_EQ(label({"r4"}), "floor 0") << "it is the highest";
  choice.toggle();
  EXPECT_EQ(label({"r4"}), "floor -1, auto");
  choice.toggle();
  EXPECT_EQ(label({"r4"}), "all floors");
  EXPECT_FALSE(choice.shown());
  choice.move(1, floors);
  EXPECT_EQ(label({"r4"}), "floor -1");
  choice.show_height(0.3, floors);
  EXPECT_EQ(label({"r4"}), "floor 0");
  choice.show_height(std::nan(""), floors);
  EXPECT_EQ(label({"r4"}), "floor 0");
}

TEST(FloorChoice, ShowsEverythingWithOneFloor) {
  const Floors floors = floors_of(corridors(), ten_robots());
  FloorChoice choice;
  choice.move(1, floors);
  choice.update(floors, ten_robots(), {"r1"});
  EXPECT_EQ(choice.label(), "");
  EXPECT_FALSE(choice.shown());
}

}  // namespace
}  // namespace adit::gui
