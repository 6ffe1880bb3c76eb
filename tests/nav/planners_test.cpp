// SPDX-License-Identifier: Apache-2.0
// Every planner behind its face: named in a platform's file, driven in a closed loop with each controller.
#include "nav/planners/make_planner.hpp"

#include <gtest/gtest.h>

#include "nav/planners/hybrid_astar/motion_primitives.hpp"
#include "tests/nav/closed_loop.hpp"

namespace adit::nav::test {
namespace {

Platform with(const Platform& base, const std::string& planner) {
  Platform p = base;
  p.planner = planner;
  return p;
}

/// A corridor 4 m wide with a crate in the middle, closed at the end.
BoxWorld corridor() {
  return {{{-2, 12, 2, 2.2},
           {-2, 12, -2.2, -2},
           {-2.2, -2, -2.2, 2.2},
           {12, 12.2, -2.2, 2.2},
           {4, 4.4, -0.3, 0.3, 0.0, 0.8}}};
}

TEST(Planners, AnUnknownNameIsAnError) {
  const auto made = make_planner(with(wheeled(), "dijkstra"));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().reason, Reason::bad_argument);
  EXPECT_EQ(made.error().text, "no planner 'dijkstra': trajectories or vfh or lattice");
}

TEST(Planners, EveryNameMakesOne) {
  for (const std::string& name : planner_names()) EXPECT_TRUE(make_planner(with(wheeled(), name))) << name;
  EXPECT_EQ(planner_names().front(), Platform{}.planner);
}

TEST(Planners, ACarHasNoneThatTurnsOnTheSpot) {
  for (const std::string& name : planner_names()) {
    const auto made = make_planner(with(car(), name));
    EXPECT_EQ(made.ok(), name == "lattice") << name;
    if (!made) {
      EXPECT_EQ(made.error().reason, Reason::bad_argument);
    }
  }
}

TEST(Planners, APlatformChoosesTheCurvatureOfItsPaths) {
  Platform gentle = wheeled();
  gentle.path_curvature = 0.5;
  gentle.path_segment = 0.8;
  const auto usual = PlannerLibrary::build(wheeled()), own = PlannerLibrary::build(gentle);
  const PathTreeParams& params = own->options.front().tree.params();
  EXPECT_NEAR(params.curvature[0], 0.5, 1e-9);
  EXPECT_LT(params.curvature[2], params.curvature[0]);
  EXPECT_EQ(params.segment, 0.8);
  EXPECT_EQ(usual->options.front().tree.params().curvature, PathTreeParams{}.curvature);
  Platform lattice = car();
  lattice.path_curvature = 0.4;
  EXPECT_NEAR(MotionPrimitives(lattice).curvature(MotionPrimitives::kLevels - 1), 0.4, 1e-9);
  EXPECT_LT(MotionPrimitives(car()).curvature(MotionPrimitives::kLevels - 1), 1 / car().least_radius());
}

class EveryPlanner : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  Platform platform_ = with(wheeled(), std::get<0>(GetParam()));
  std::string tracks_ = std::get<1>(GetParam());
};

TEST_P(EveryPlanner, DrivesRoundACrate) {
  ClosedLoop run(platform_, corridor(), {0, 0.1, 0}, tracks_);
  EXPECT_TRUE(run.drive(Target::to({9, 0}), 40));
  EXPECT_LT(run.distance_to(9, 0), 0.35);
  EXPECT_GT(run.least_clearance, 0.03);
}

TEST_P(EveryPlanner, ReportsBlockedWhenWalledIn) {
  BoxWorld world{
      {{0.55, 0.7, -0.7, 0.7}, {-0.7, -0.55, -0.7, 0.7}, {-0.7, 0.7, 0.55, 0.7}, {-0.7, 0.7, -0.7, -0.55}}};
  ClosedLoop run(platform_, world, {0, 0, 0}, tracks_);
  EXPECT_FALSE(run.drive(Target::to({6, 0}), 15));
  EXPECT_TRUE(run.last.blocked);
  EXPECT_GT(run.least_clearance, 0.0);
}

TEST_P(EveryPlanner, NoTargetNoPath) {
  const auto planner = make_planner(platform_).value();
  EXPECT_TRUE(planner->plan({}, {}, {}, 0).path().empty());
  EXPECT_TRUE(planner->plan(Target::to({0.1, 0}), {}, {}, 0).arrived);
}

INSTANTIATE_TEST_SUITE_P(Swap, EveryPlanner,
                         testing::Combine(testing::ValuesIn(planner_names()),
                                          testing::ValuesIn(controller_names())),
                         [](const auto& each) {
                           return std::get<0>(each.param) + "_" + std::get<1>(each.param);
                         });

TEST(RoughGround, IsAvoidedWhereThereIsAnotherWayAndCrossedSlowlyWhereThereIsNone) {
  FalcoPlanner planner(wheeled());
  std::vector<ObstaclePoint> patch, everywhere;
  for (float x = 0.8f; x < 2.5f; x += 0.05f)
    for (float y = -4.0f; y < 4.0f; y += 0.05f) {
      if (y < 0.1f) patch.push_back({x, y, 0.7f});
      everywhere.push_back({x, y, 0.7f});
    }
  const Plan free = planner.plan(Target::to({3, 0}), {}, {}, 0);
  const Plan round = planner.plan(Target::to({3, 0}), {}, patch, 0);
  ASSERT_FALSE(round.blocked);
  EXPECT_GT(round.path()[round.pose_count / 2].y, free.path()[free.pose_count / 2].y + 0.1);
  const Plan across = planner.plan(Target::to({3, 0}), {}, everywhere, 0);
  ASSERT_FALSE(across.blocked) << "it costs, it does not block";
  EXPECT_LT(across.max_speed, 0.5 * free.max_speed);
}

TEST(PolygonFootprint, APointedRobotPassesWhereItsRectangleDoesNot) {
  // Corners of the rectangle would touch two posts; the pointed body goes between them.
  Platform pointed = wheeled();
  pointed.footprint = {{0.30, 0.05}, {0.0, 0.25}, {-0.30, 0.05}, {-0.30, -0.05}, {0.0, -0.25}, {0.30, -0.05}};
  std::vector<ObstaclePoint> posts{{0.30f, 0.36f, 1.0f}, {0.30f, -0.36f, 1.0f}};
  const RotationTable square(Footprint(wheeled()).grown(0.02, 0.02)),
      round(Footprint(pointed).grown(0.02, 0.02));
  TurnRoom of_square, of_round;
  for (const ObstaclePoint& o : posts) {
    const int ring = CorrespondenceGrid::ring_of(std::hypot(o.x, o.y) - 0.1f);
    const int angle = (static_cast<int>(std::atan2(o.y, o.x) * 180 / M_PI) + 360) % 360;
    if (ring < square.rings()) square.limit(ring, angle, of_square);
    if (ring < round.rings()) round.limit(ring, angle, of_round);
  }
  EXPECT_LT(of_square.left, 60);
  EXPECT_TRUE(of_round.full()) << "it turns on the spot, the rectangle does not";
}

TEST(PolygonFootprint, DrivesBackwardsWithItsOwnShape) {
  // Wide in front, narrow behind: what stands beside its back does not hinder it driving back.
  Platform wedge = wheeled();
  wedge.footprint = {{0.30, 0.25}, {-0.30, 0.08}, {-0.30, -0.08}, {0.30, -0.25}};
  const auto library = PlannerLibrary::build(wedge);
  EXPECT_GT(library->options.front().back.rings(), 0);
  EXPECT_EQ(PlannerLibrary::build(wheeled())->options.front().back.rings(), 0) << "symmetric: the same grid";
  FalcoPlanner planner(wedge, library);
  const Plan plan = planner.plan(Target::along(M_PI, 0.5), {}, {}, 0);
  EXPECT_TRUE(plan.reverse);
}

}  // namespace
}  // namespace adit::nav::test
