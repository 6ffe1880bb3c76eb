// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/falco/rotation.hpp"

#include <gtest/gtest.h>

namespace adit::nav {
namespace {

const Footprint kTurningBody(0.4, 0.2);

TurnRoom room_with(double x, double y) {
  const RotationTable table(kTurningBody);
  const int ring = CorrespondenceGrid::ring_of(static_cast<float>(std::hypot(x, y)));
  const int angle = (static_cast<int>(std::floor(std::atan2(y, x) * 180 / M_PI)) + 360) % 360;
  TurnRoom room;
  if (ring < table.rings()) table.limit(ring, angle, room);
  return room;
}

TEST(Rotation, IsUnlimitedWithoutNearObstacles) {
  EXPECT_TRUE(room_with(0.6, 0.0).full());
  EXPECT_TRUE(room_with(0.0, -0.5).full());
}

TEST(Rotation, AnObstacleBesideLimitsBothWays) {
  // At (0, 0.3): the front left corner comes round to the left, the rear left one to the right.
  const TurnRoom room = room_with(0.0, 0.3);
  EXPECT_GT(room.left, 30);
  EXPECT_LT(room.left, 75);
  EXPECT_NEAR(room.left, room.right, 3);
}

TEST(Rotation, AnObstacleAtTheLeftFrontLeavesMoreRoomToTheRight) {
  const TurnRoom room = room_with(0.30, 0.26);
  EXPECT_LT(room.left, 25);
  EXPECT_GT(room.right, 60);
}

TEST(Rotation, IsMirrored) {
  const TurnRoom left = room_with(0.25, 0.28), right = room_with(0.25, -0.28);
  EXPECT_NEAR(left.left, right.right, 2);
  EXPECT_NEAR(left.right, right.left, 2);
}

}  // namespace
}  // namespace adit::nav
