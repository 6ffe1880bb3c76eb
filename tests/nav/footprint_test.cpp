// SPDX-License-Identifier: Apache-2.0
#include "nav/geometry/footprint.hpp"

#include <gtest/gtest.h>

#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

/// A body that is pointed in front.
Platform pointed() {
  Platform p = wheeled();
  p.footprint = {{0.30, 0.0}, {0.0, 0.25}, {-0.30, 0.25}, {-0.30, -0.25}, {0.0, -0.25}};
  return p;
}

TEST(Footprint, ARectangleIsTheRectangle) {
  const Footprint body(wheeled());
  EXPECT_NEAR(body.depth(0.25f, 0.0f), 0.05, 1e-6);
  EXPECT_NEAR(body.depth(0.0f, -0.24f), 0.01, 1e-6);
  EXPECT_LT(body.depth(0.31f, 0.0f), 0.0f);
  EXPECT_NEAR(body.radius(), std::hypot(0.3, 0.25), 1e-9);
  EXPECT_NEAR(body.front(), 0.3, 1e-9);
  EXPECT_TRUE(body.symmetric());
  EXPECT_EQ(body.edges().size(), 4U);
}

TEST(Footprint, GrowsAlongAndAcross) {
  const Footprint body = Footprint(wheeled()).grown(0.2, 0.1);
  EXPECT_NEAR(body.depth(0.49f, 0.0f), 0.01, 1e-5);
  EXPECT_NEAR(body.depth(0.0f, 0.34f), 0.01, 1e-5);
  EXPECT_NEAR(body.radius(), std::hypot(0.5, 0.35), 1e-9);
}

TEST(Footprint, APolygonLeavesItsCornersFree) {
  const Footprint body(pointed());
  EXPECT_LT(body.depth(0.28f, 0.2f), 0.0f) << "where the rectangle has a corner";
  EXPECT_GT(body.depth(0.28f, 0.0f), 0.0f);
  EXPECT_GT(body.depth(-0.28f, 0.2f), 0.0f);
  EXPECT_FALSE(body.symmetric());
  EXPECT_GT(body.turned().depth(0.28f, 0.2f), 0.0f);
  EXPECT_LT(body.turned().depth(-0.28f, 0.2f), 0.0f);
}

TEST(Footprint, AGrownPolygonHoldsEveryPointWithinTheMargin) {
  const Footprint body(pointed());
  const Footprint grown = body.grown(0.15, 0.05);
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) {
      const float x = -0.5f + 0.025f * static_cast<float>(i), y = -0.5f + 0.025f * static_cast<float>(j);
      bool near = false;  // of some point of the body
      for (float dx = -0.15f; dx < 0.155f; dx += 0.01f)
        for (float dy = -0.05f; dy < 0.055f; dy += 0.01f) near |= body.depth(x + dx, y + dy) > 0;
      if (near) {
        EXPECT_GT(grown.depth(x, y), -0.012f) << x << " " << y;
      }
      if (grown.depth(x, y) > 0.02f) {
        EXPECT_TRUE(near) << x << " " << y;
      }
    }
}

}  // namespace
}  // namespace adit::nav::test
