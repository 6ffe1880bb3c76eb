// SPDX-License-Identifier: Apache-2.0
// Which tiles of the routes' map a change of the areas marks for a rebuild.
#include "nav/routing/surface_map.hpp"

#include <gtest/gtest.h>

#include "nav/areas/area_set.hpp"
#include "tests/nav/area_sets.hpp"
#include "tests/nav/route_world.hpp"

namespace adit::nav::test {
namespace {

int dirty(const SurfaceMap& map) {
  int count = 0;
  for (int i = 0; i < map.size(); ++i) count += map.tile(i).used && map.tile(i).dirty;
  return count;
}

Area rectangle(const char* name, AreaKind kind, double x0, double y0, double x1, double y1) {
  return Area{.name = name, .kind = kind, .corners = {{x0, y0}, {x1, y1}}};
}

/// Open ground of 40 x 40 m, 625 tiles.
class SurfaceMapAreas : public testing::Test {
 protected:
  SurfaceMapAreas() { world.tell(planner); }
  /// The tiles that the areas mark; rebuilds them.
  int marked_by(const AreaSet& areas) {
    planner.map().set_areas(areas);
    const int marked = dirty(planner.map());
    planner.finish();
    return marked;
  }

  GridWorld world{400, 400};
  RoutePlanner planner{wheeled()};
};

TEST(SurfaceMap, EqualAreasMarkNoTile) {
  GridWorld world(400, 400);
  RoutePlanner planner(wheeled());
  world.tell(planner);
  const std::vector<Area> areas{rectangle("site", AreaKind::keep_in, 2, 2, 38, 38),
                                rectangle("shaft", AreaKind::keep_out, 8, 8, 12, 12)};
  planner.map().set_areas(set_of(areas));
  planner.finish();
  ASSERT_EQ(dirty(planner.map()), 0);
  planner.map().set_areas(set_of(areas));
  EXPECT_EQ(dirty(planner.map()), 0) << "another set with the same areas";
  planner.map().set_areas(set_of(areas).with_margin(0.5));
  EXPECT_GT(dirty(planner.map()), 0) << "with another margin";
}

TEST(SurfaceMap, ItsExtentIsThatOfTheTilesInUse) {
  RouteParams params;
  params.tiles = 256;
  SurfaceMap map(params, 0.3f);
  for (int tx = 0; tx < 1000; ++tx) {
    map.begin_scan((tx + 0.5) * 1.6, 0.0);
    for (int ty = -1; ty <= 1; ++ty) map.see_free(tx * kTileSide, ty * kTileSide, 0.0f, 0.0f);
    ASSERT_LE(map.used(), params.tiles);
  }
  EXPECT_EQ(map.extent().x1, 999);
  EXPECT_GT(map.extent().x0, 900);
  EXPECT_EQ(map.first(0, 0), -1);
  EXPECT_GE(map.first(930, 0), 0);
  EXPECT_TRUE(map.near_seen(930, 8));
  EXPECT_TRUE(map.near_seen(1006, 0));
  EXPECT_FALSE(map.near_seen(800, 0)) << "its tiles are gone";
  EXPECT_FALSE(map.near_seen(930, 30));
}

TEST_F(SurfaceMapAreas, OneOfSeveralThatChangesMarksTheTilesAtItsBorder) {
  const Area site = rectangle("site", AreaKind::keep_in, 2, 2, 38, 38);
  const Area far = rectangle("far", AreaKind::keep_out, 28, 28, 34, 34);
  marked_by(set_of({site, far, rectangle("shaft", AreaKind::keep_out, 8, 8, 12, 12)}));
  // The outline of 4 m, and 2.4 m on each side of it.
  const int moved = marked_by(set_of({site, far, rectangle("shaft", AreaKind::keep_out, 8.2, 8, 12.2, 12)}));
  EXPECT_GT(moved, 8);
  EXPECT_LT(moved, 50);
  const int lost = marked_by(set_of({site, far}));
  EXPECT_GT(lost, 8);
  EXPECT_LT(lost, 50);
  // The ground within stays permitted, and the tiles of the border are 4 x 23.
  const int site_moved = marked_by(set_of({rectangle("site", AreaKind::keep_in, 2.1, 2, 38.1, 38), far}));
  EXPECT_GT(site_moved, 80);
  EXPECT_LT(site_moved, 330);
  EXPECT_EQ(marked_by(set_of({rectangle("site", AreaKind::keep_in, 2.1, 2, 38.1, 38), far,
                              rectangle("seen", AreaKind::prefer, 4, 4, 30, 30)})),
            0)
      << "an area that forbids nothing";
}

TEST_F(SurfaceMapAreas, TilesThatAreNotMarkedHaveTheCostsOfANewMap) {
  std::mt19937 draw(7);
  const auto upto = [&draw](double n) { return n * static_cast<double>(draw() % 1000) / 1000; };
  for (int round = 0; round < 40; ++round) {
    std::vector<Area> areas;
    constexpr std::array kNames{"a", "b", "c", "d"};
    const std::size_t count = draw() % 5;
    for (std::size_t i = 0; i < count; ++i) {
      const double x = upto(35) - 5, y = upto(35) - 5;
      areas.push_back(rectangle(kNames[i], i % 2 == 0 ? AreaKind::keep_out : AreaKind::keep_in, x, y,
                                x + 1 + upto(25), y + 1 + upto(25)));
      if (draw() % 4 == 0) areas.back().z_min = 1.0;
    }
    const AreaSet set = set_of(areas).with_margin(round % 5 == 0 ? -0.6 : round % 3 == 0 ? 3.0 : 0.1);
    planner.map().set_areas(set);
    planner.finish();
    RoutePlanner other(wheeled());
    other.map().set_areas(set);
    world.tell(other);
    ASSERT_EQ(other.map().size(), planner.map().size());
    for (int i = 0; i < other.map().size(); ++i)
      ASSERT_EQ(planner.map().tile(i).cost, other.map().tile(i).cost) << "round " << round << " tile " << i;
  }
}

}  // namespace
}  // namespace adit::nav::test
