// SPDX-License-Identifier: Apache-2.0
#include "bench/nav_real/true_map.hpp"

#include <gtest/gtest.h>

#include "bench/nav_real/doors.hpp"

namespace adit::bench {
namespace {

constexpr double kWidth = 0.6, kLength = 0.8;  // m, of the body
constexpr double kTolerance = 0.25;            // m

Platform body() {
  Platform platform;
  platform.name = "tracked";
  platform.length = kLength;
  platform.width = kWidth;
  platform.height = 0.5;
  platform.step = 0.15;
  return platform;
}

/// Two rooms of 3 x 3 m beside each other, with a doorway of that width in the wall between them, at y = 1.5.
sim::World rooms(double doorway) {
  const std::array<sim::Box, 6> boxes{{{0, 6.2, -0.2, 0, 0, 3},
                                       {0, 6.2, 3, 3.2, 0, 3},
                                       {-0.2, 0, -0.2, 3.2, 0, 3},
                                       {6.2, 6.4, -0.2, 3.2, 0, 3},
                                       {3, 3.2, 0, 1.5 - doorway / 2, 0, 3},
                                       {3, 3.2, 1.5 + doorway / 2, 3, 0, 3}}};
  return sim::make_box_world(boxes, 0.0, 3.0).value();
}

TEST(TrueMap, MeasuresTheShortestPathOfTheBodyThroughADoor) {
  const TrueMap map(rooms(1.0), body());
  const auto distances = map.distances({1, 1.5, 0});
  // A doorway of 1 m leaves 20 cm a side.
  EXPECT_NEAR(map.distance_to(distances, {5, 1.5}, kTolerance), 4.0 - kTolerance, 0.3);
  EXPECT_EQ(map.distance_to(distances, {3.1, 0.5}, 0.1), TrueMap::kFar) << "inside the wall";
}

TEST(TrueMap, NoPathLeadsThroughADoorThatLeavesTooLittle) {
  // 5 cm a side.
  const TrueMap map(rooms(kWidth + 0.1), body());
  const auto distances = map.distances({1, 1.5, 0});
  EXPECT_EQ(map.distance_to(distances, {5, 1.5}, kTolerance), TrueMap::kFar);
  EXPECT_LT(map.distance_to(distances, {2, 1.5}, kTolerance), 1.2f);
}

TEST(TrueMap, FindsTheDoorAndTheRoomBesideTheBody) {
  const TrueMap map(rooms(1.0), body());
  auto doors = find_doors(map);
  // Outside, the world goes on beside the walls.
  std::erase_if(doors, [](const Door& door) {
    return door.at.x() < 0 || door.at.x() > 6.2 || door.at.y() < 0 || door.at.y() > 3;
  });
  ASSERT_EQ(doors.size(), 1u) << doors.back().at.transpose() << " width " << doors.back().width;
  EXPECT_NEAR(doors.front().at.x(), 3.1, 0.2);
  EXPECT_NEAR(doors.front().at.y(), 1.5, 0.15);
  const Passage passage = fit_passage(map, doors.front());
  EXPECT_NEAR(passage.beside, 0.5 * (1.0 - kWidth), 0.03);
  EXPECT_NEAR(std::remainder(passage.middle.yaw, M_PI), 0.0, 0.06);
}

TEST(TrueMap, DrawsOnlyPosesWhereTheBodyFits) {
  const TrueMap map(rooms(1.0), body());
  Random random(1);
  for (int n = 0; n < 50; ++n) {
    const auto pose = map.draw_pose(random, 0.02);
    ASSERT_TRUE(pose.has_value());
    EXPECT_TRUE(map.fits(*pose, 0.02));
  }
}

}  // namespace
}  // namespace adit::bench
