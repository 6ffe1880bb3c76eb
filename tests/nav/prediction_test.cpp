// SPDX-License-Identifier: Apache-2.0
#include "nav/tracking/prediction.hpp"

#include <gtest/gtest.h>

#include "nav/geometry/footprint.hpp"
#include "tests/nav/box_world.hpp"

namespace adit::nav::test {
namespace {

Mover somebody(float x, float y, float vx, float vy) {
  Mover mover;
  mover.moves = vx != 0 || vy != 0;
  mover.position = {x, y};
  mover.velocity = {vx, vy};
  mover.points[0] = {x, y - 0.2f};
  mover.points[1] = {x, y};
  mover.points[2] = {x, y + 0.2f};
  mover.count = 3;
  return mover;
}

struct Places {
  std::vector<ObstaclePoint> points{};
  Places(const Mover& mover, double speed, const Pose2& pose = {}, std::size_t room = 4096) {
    points.reserve(room);
    predict(std::span(&mover, 1), 0.0, pose, speed, wheeled(), points);
  }
  /// The highest cost within 0.15 m of a place.
  float cost(float x, float y) const {
    float most = 0;
    for (const ObstaclePoint& p : points)
      if (std::hypot(p.x - x, p.y - y) < 0.15f) most = std::max(most, p.cost);
    return most;
  }
};

TEST(Prediction, CrossingMoverIsAnObstacleWhereThePathsMeet) {
  // At 1.5 m/s the robot is 2.4 m ahead after 1.6 s; he walks from 2.4 m on the right across its way.
  const Places places(somebody(2.4f, -2.4f, 0, 1.5f), 1.5);
  EXPECT_GT(places.cost(2.4f, 0.0f), 0.0f);
  EXPECT_EQ(places.cost(2.4f, -2.4f), 0.0f) << "where he is now he is no more then";
  EXPECT_EQ(Places(somebody(2.4f, -2.4f, 0, -1.5f), 1.5).cost(2.4f, 0.0f), 0.0f) << "he walks away";
}

TEST(Prediction, MoverThatHasPassedIsNoObstacle) {
  const Places places(somebody(3.0f, 0.0f, 0, 1.5f), 0.2);
  EXPECT_EQ(places.cost(3.0f, 0.0f), 0.0f);
}

TEST(Prediction, NearPredictionsBlockAndLaterOnesCost) {
  const Places places(somebody(3.5f, 0.3f, -1.5f, 0), 1.0);
  float first = 0, later = 1;
  for (const ObstaclePoint& p : places.points) {
    first = std::max(first, p.cost);
    later = std::min(later, p.cost);
  }
  EXPECT_EQ(first, 1.0f);
  EXPECT_LT(later, 1.0f);
}

TEST(Prediction, OncomingMoverRaisesTheCostOnTheLeft) {
  for (const double turned : {0.0, 2.0}) {
    const Pose2 pose{1, 2, turned};
    const Eigen::Vector2f at = (pose * Eigen::Vector2d(3.0, 0.0)).cast<float>();
    const Eigen::Vector2f velocity(static_cast<float>(-1.5 * std::cos(turned)),
                                   static_cast<float>(-1.5 * std::sin(turned)));
    const Places places(somebody(at.x(), at.y(), velocity.x(), velocity.y()), 1.0, pose);
    EXPECT_GT(places.cost(1.5f, 0.7f), 0.0f);
    EXPECT_EQ(places.cost(1.5f, -0.7f), 0.0f) << "the right stays free";
  }
  EXPECT_EQ(Places(somebody(3.0f, 1.5f, -1.5f, 0), 1.0).cost(1.5f, 2.2f), 0.0f) << "he passes beside it";
}

TEST(Prediction, LeavesOutStationaryMoversTheBodyAndWhatExceedsTheCapacity) {
  EXPECT_TRUE(Places(somebody(2, 0, 0, 0), 1.0).points.empty());
  const Footprint body(wheeled());
  for (const ObstaclePoint& p : Places(somebody(2, 0, -1.5f, 0), 0.0).points)
    EXPECT_LE(body.depth(p.x, p.y), 0.0f);
  EXPECT_LE(Places(somebody(2, 0, -1.5f, 0), 1.0, {}, 5).points.size(), 5u);
}

/// How fast a straight path of 3 m may be driven beside somebody.
double beside(const Mover& mover) {
  Plan plan;
  plan.length = 3.0;
  plan.pose_count = 61;
  for (int i = 0; i <= 60; ++i) plan.poses[i] = {0.05 * i, 0, 0};
  return speed_beside(std::span(&mover, 1), 0.0, plan, wheeled());
}

TEST(Prediction, TheNearerTheSlower) {
  EXPECT_EQ(beside(somebody(-9, 0, -1, 0)), 2.0);
  EXPECT_EQ(beside(somebody(1.5f, 6, 0, 0)), 2.0);
  const double far = beside(somebody(1.5f, 2.5f, 0, 0)), near = beside(somebody(1.5f, 1.2f, 0, 0));
  EXPECT_LT(far, 2.0);
  EXPECT_LT(near, far);
  EXPECT_LT(beside(somebody(1.5f, 2.5f, 0, -1.5f)), far) << "who comes towards its way the more so";
}

TEST(Prediction, ItCanStandBeforeSomebodyStepsInItsWay) {
  const Platform p = wheeled();
  const PredictionParams params;
  for (const float apart : {0.6f, 1.0f, 2.0f}) {
    // He stands beside the start of the path and begins to walk at once.
    const double v = beside(somebody(0.0f, 0.25f + apart + 0.2f, 0, 0));
    const double stops = params.reaction + v / (params.braking_share * p.max_acceleration);
    EXPECT_LE(stops * params.stepping, apart + 0.02) << apart;
  }
}

}  // namespace
}  // namespace adit::nav::test
