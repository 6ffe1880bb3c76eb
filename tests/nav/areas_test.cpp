// SPDX-License-Identifier: Apache-2.0
#include "nav/areas/area_set.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/time/random.hpp"
#include "nav/explore/route_ground.hpp"
#include "nav/goals/goal_check.hpp"
#include "nav/local_navigation.hpp"
#include "tests/nav/area_sets.hpp"
#include "tests/nav/route_world.hpp"
#include "tests/nav/scanned_monitor.hpp"

namespace adit::nav::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Area area(const char* name, AreaKind kind, std::vector<Eigen::Vector2d> corners) {
  return Area{.name = name, .kind = kind, .corners = std::move(corners)};
}

std::string refusal(const Area& bad) {
  const auto valid = checked(bad);
  EXPECT_TRUE(valid || valid.reason() == Reason::bad_argument);
  return valid ? "" : valid.error().text;
}

TEST(Areas, MalformedOnesAreRefusedByName) {
  using testing::HasSubstr;
  const std::vector<Eigen::Vector2d> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  EXPECT_EQ(refusal(area("a", AreaKind::keep_in, square)), "");
  EXPECT_THAT(refusal(area("", AreaKind::keep_in, square)), HasSubstr("name"));
  EXPECT_THAT(refusal(area("a b", AreaKind::keep_in, square)), HasSubstr("name"));
  EXPECT_THAT(refusal(area("a", static_cast<AreaKind>(3), square)), HasSubstr("neither"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {})), HasSubstr("two corners"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{1, 1}})), HasSubstr("two corners"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, std::vector<Eigen::Vector2d>(17, {1, 1}))),
              HasSubstr("16 corners"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{0, 0}, {kNan, 1}})), HasSubstr("10 km"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{0, 0}, {4, 0}, {4, kNan}})), HasSubstr("10 km"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{0, 0}, {kInfinity, 1}})), HasSubstr("10 km"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{0, 0}, {1, 10'001}})), HasSubstr("10 km"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{0, 0}, {0, 5}})), HasSubstr("nothing"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{0, 0}, {2, 2}, {4, 4}})), HasSubstr("nothing"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{0, 0}, {4, 4}, {4, 0}, {0, 3}})), HasSubstr("cross"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{0, 0}, {0, 0}, {4, 0}, {4, 4}})), HasSubstr("cross"));
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{0, 0}, {6, 0}, {3, 0}, {3, 3}})), HasSubstr("cross"))
      << "a side that goes back on the one before";
  EXPECT_THAT(refusal(area("a", AreaKind::keep_in, {{0, 0}, {6, 0}, {6, 4}, {3, 0}, {0, 4}})),
              HasSubstr("cross"))
      << "a corner on a side";
  Area bad = area("a", AreaKind::keep_in, square);
  bad.z_min = 2;
  bad.z_max = 1;
  EXPECT_THAT(refusal(bad), HasSubstr("interval"));
  bad.z_min = kNan;
  EXPECT_THAT(refusal(bad), HasSubstr("interval"));
  bad = area("a", AreaKind::prefer, square);
  for (const double weight : {-0.1, 10.1, kNan}) {
    bad.weight = weight;
    EXPECT_THAT(refusal(bad), HasSubstr("weight"));
  }
}

TEST(Areas, TwoCornersAreThoseOfARectangleAndTurnsDoNotMatter) {
  const auto rectangle = checked(area("a", AreaKind::keep_in, {{4, 1}, {0, 3}}));
  ASSERT_TRUE(rectangle);
  EXPECT_EQ(rectangle->corners, (std::vector<Eigen::Vector2d>{{0, 1}, {4, 1}, {4, 3}, {0, 3}}));
  EXPECT_EQ(checked(*rectangle).value(), *rectangle) << "a checked area stays as it is";
  const auto clockwise = checked(area("a", AreaKind::keep_in, {{0, 0}, {0, 4}, {4, 4}}));
  ASSERT_TRUE(clockwise);
  EXPECT_EQ(clockwise->corners, (std::vector<Eigen::Vector2d>{{0, 0}, {4, 4}, {0, 4}}));
}

TEST(Areas, AnyNumbersAreRefusedOrMakeAnAreaThatWorks) {
  Random random(1);
  const double odd[]{0.0, 1.0, 1.0, -3.5, 1e4, 1e-9, 2.0, 4.0, kInfinity, kNan, 1e300};
  int accepted = 0;
  for (int i = 0; i < 20'000; ++i) {
    Area any = area("a", static_cast<AreaKind>(random.below(3)), {});
    for (std::size_t n = random.below(18); n > 0; --n)
      any.corners.emplace_back(
          random.chance(0.9) ? static_cast<double>(random.below(9)) : odd[random.below(11)],
          random.chance(0.9) ? static_cast<double>(random.below(9)) : odd[random.below(11)]);
    if (random.chance(0.2)) any.z_max = odd[random.below(11)];
    const auto valid = checked(any);
    if (!valid) continue;
    ++accepted;
    ASSERT_EQ(checked(*valid).value(), *valid);
    const AreaSet set = set_of({*valid, area("b", AreaKind::keep_in, {{-5, -5}, {20, 20}})});
    std::vector<Eigen::Vector2f> points;
    sample_border(set, {4, 4, 0}, 5.0, points);
    ASSERT_LE(points.size(), 4'000U);
    for (const Eigen::Vector2f& p : points) ASSERT_TRUE(p.allFinite());
    (void)set.weight({4, 4, 0});
  }
  EXPECT_GT(accepted, 500);
}

TEST(Areas, AtMostSixteenAndOneOfEachName) {
  AreaSet set;
  EXPECT_TRUE(set.empty());
  EXPECT_FALSE(set.remove("a0"));
  for (int i = 0; i < 16; ++i)
    ASSERT_TRUE(set.add(
        checked(area(("a" + std::to_string(i)).c_str(), AreaKind::prefer, {{0, 0}, {1, 1}})).value()));
  const Area more = checked(area("more", AreaKind::prefer, {{0, 0}, {1, 1}})).value();
  EXPECT_EQ(set.add(more).reason(), Reason::bad_argument);
  Area again = more;
  again.name = "a3";
  again.weight = 4;
  EXPECT_TRUE(set.add(again)) << "it replaces the one of its name";
  EXPECT_EQ(set.find("a3")->weight, 4);
  EXPECT_EQ(set.all().size(), 16U);
  EXPECT_TRUE(set.remove("a3"));
  EXPECT_TRUE(set.add(more));
}

TEST(Areas, KeepInAreasAreAUnion) {
  const AreaSet set = set_of({area("west", AreaKind::keep_in, {{0, 0}, {10, 10}}),
                              area("east", AreaKind::keep_in, {{10, 2}, {20, 8}}),
                              area("hole", AreaKind::keep_out, {{4, 4}, {6, 6}})});
  EXPECT_TRUE(set.permits({1, 1, 0}));
  EXPECT_TRUE(set.permits({15, 5, 0}));
  EXPECT_FALSE(set.permits({15, 9, 0}));
  EXPECT_FALSE(set.permits({5, 5, 0}));
  EXPECT_FALSE(set.permits({-1, 5, 0}));
  EXPECT_TRUE(set.permits({10, 5, 0}, 1.0)) << "where they meet there is no border";
  EXPECT_FALSE(set.permits({10.5, 2.5, 0}, 1.0));
  EXPECT_TRUE(set.permits({10.5, 2.5, 0}, 0.4));
  const auto body = [](double x, double y) {
    return std::vector<Eigen::Vector2d>{
        {x - 0.3, y - 0.3}, {x + 0.3, y - 0.3}, {x + 0.3, y + 0.3}, {x - 0.3, y + 0.3}};
  };
  EXPECT_TRUE(set.permits(body(10, 5), 0.0));
  EXPECT_FALSE(set.permits(body(10, 8), 0.0)) << "a corner reaches out";
  EXPECT_FALSE(set.permits(body(3.9, 5), 0.0));
}

TEST(Areas, ABodyThatContainsASmallForbiddenPieceIsNotPermitted) {
  const AreaSet set = set_of({area("post", AreaKind::keep_out, {{-0.1, -0.1}, {0.1, 0.1}})});
  EXPECT_FALSE(set.permits(std::vector<Eigen::Vector2d>{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 0.0));
  EXPECT_TRUE(set.permits(std::vector<Eigen::Vector2d>{{1, 1}, {2, 1}, {2, 2}, {1, 2}}, 0.0));
}

TEST(Areas, HeightsLimitThem) {
  Area upstairs = area("deck", AreaKind::keep_out, {{0, 0}, {4, 4}});
  upstairs.z_min = 2;
  upstairs.z_max = 4;
  const AreaSet set = set_of({upstairs});
  EXPECT_TRUE(set.permits({2, 2, 0}));
  EXPECT_FALSE(set.permits({2, 2, 3}));
  EXPECT_FALSE(set.permits({2, 2, 1.8})) << "heights are not exact";
  EXPECT_TRUE(set.border(0).empty());
  EXPECT_EQ(set.border(3).size(), 4U);
  EXPECT_TRUE(set.border(6).empty());
  const AreaSet lower = set.in_frame({}, 2);
  EXPECT_FALSE(lower.permits({2, 2, 1}));
  EXPECT_TRUE(lower.permits({2, 2, 3}));
}

TEST(Areas, WeightsMultiplyAndForbiddenGroundHasNone) {
  Area better = area("b", AreaKind::prefer, {{0, 0}, {4, 4}});
  better.weight = 3;
  Area dull = area("c", AreaKind::prefer, {{2, 0}, {4, 4}});
  dull.weight = 0.5;
  const AreaSet set = set_of({better, dull, area("d", AreaKind::keep_out, {{0, 0}, {1, 1}})});
  EXPECT_EQ(set.weight({1.5, 1.5, 0}), 3.0);
  EXPECT_EQ(set.weight({3, 3, 0}), 1.5);
  EXPECT_EQ(set.weight({0.5, 0.5, 0}), 0.0);
  EXPECT_EQ(set.weight({9, 9, 0}), 1.0);
}

TEST(Areas, PointsAlongTheBorderCloseIt) {
  const AreaSet set = set_of({area("shaft", AreaKind::keep_out, {{0, 0}, {2, 1}})}).in_frame({5, 3, 0.7}, 0);
  std::vector<Eigen::Vector2f> points;
  sample_border(set, {5, 3, 0}, 6.0, points);
  for (const Eigen::Vector2f& p : points) {
    const Eigen::Vector3d place(p.x(), p.y(), 0);
    EXPECT_TRUE(set.permits(place));
    EXPECT_FALSE(set.permits(place, 1.5 * AreaSet::kMargin));
  }
  // From every side something is in the way before the margin.
  for (int k = 0; k < 360; ++k) {
    const Eigen::Vector2d out = Pose2{5, 3, 0.7} * Eigen::Vector2d(1, 0.5);
    const Eigen::Vector2d way(std::cos(k * M_PI / 180), std::sin(k * M_PI / 180));
    double gap = kInfinity;
    for (double along = 0; along < 3; along += 0.02)
      for (const Eigen::Vector2f& p : points)
        gap = std::min(gap, (out + along * way - p.cast<double>()).norm());
    EXPECT_LT(gap, 0.08) << k;
  }
}

TEST(Areas, AMarginIsKeptFromTheBorder) {
  const AreaSet set = set_of({area("shaft", AreaKind::keep_out, {{0, 0}, {4, 4}})}).with_margin(0.7);
  EXPECT_TRUE(set.permits({-0.2, 2, 0})) << "it is permitted ground";
  EXPECT_FALSE(set.permits({-0.6, 2, 0}, 0.0));
  EXPECT_TRUE(set.permits({-0.8, 2, 0}, 0.0));
  EXPECT_FALSE(set.permits({-0.8, 2, 0}, 0.2));
  std::vector<Eigen::Vector2f> points;
  sample_border(set, {2, 2, 0}, 6.0, points);
  ASSERT_FALSE(points.empty());
  for (const Eigen::Vector2f& p : points) EXPECT_TRUE(set.permits({p.x(), p.y(), 0}, -1e-4));
}

TEST(Areas, ANegativeMarginOpensAStripOfForbiddenGround) {
  for (const AreaKind kind : {AreaKind::keep_out, AreaKind::keep_in}) {
    const double out = kind == AreaKind::keep_out ? 1 : -1;  // Along x at the border, from permitted ground.
    const AreaSet set = set_of({area("shaft", kind, {{0, 0}, {4, 4}})}).with_margin(-0.5);
    EXPECT_TRUE(set.permits({out * 0.4, 2, 0}));
    EXPECT_FALSE(set.permits({out * 0.6, 2, 0}));
    EXPECT_TRUE(set.permits({out * 0.2, 2, 0}, 0.2));
    EXPECT_FALSE(set.permits({out * 0.4, 2, 0}, 0.2));
    EXPECT_TRUE(set.permits({-out * 0.1, 2, 0}, 0.3));
    std::vector<Eigen::Vector2f> points;
    sample_border(set, {2, 2, 0}, 6.0, points);
    ASSERT_FALSE(points.empty());
    for (const Eigen::Vector2f& p : points)
      EXPECT_FALSE(set.permits({p.x(), p.y(), 0}, 0.01)) << p.transpose();
  }
}

TEST(Areas, TheClearanceOfABodyIsThatOfItsFarthestPart) {
  const auto body = [](double x, double y) {
    return std::vector<Eigen::Vector2d>{
        {x + 0.3, y + 0.2}, {x - 0.3, y + 0.2}, {x - 0.3, y - 0.2}, {x + 0.3, y - 0.2}};
  };
  const AreaSet out = set_of({area("shaft", AreaKind::keep_out, {{0, 0}, {4, 4}})});
  EXPECT_NEAR(out.clearance(body(-1, 2), 0), 0.7, 1e-9);
  EXPECT_NEAR(out.clearance(body(0, 2), 0), -0.3, 1e-9);
  EXPECT_NEAR(out.clearance(body(-0.6, -0.6), 0), std::hypot(0.3, 0.4), 1e-9) << "a corner";
  const AreaSet in = set_of({area("hall", AreaKind::keep_in, {{0, 0}, {4, 4}})});
  EXPECT_NEAR(in.clearance(body(2, 2), 0), 1.7, 1e-9);
  EXPECT_NEAR(in.clearance(body(4, 2), 0), -0.3, 1e-9);
  // A wedge that reaches between the corners of the body.
  const AreaSet wedge = set_of({area("wedge", AreaKind::keep_out, {{0.1, 0}, {5, -0.1}, {5, 0.1}})});
  EXPECT_NEAR(wedge.clearance(body(0, 0), 0), -0.2, 1e-9);
  EXPECT_NEAR(wedge.clearance(body(-0.5, 0), 0), 0.3, 1e-9);
  EXPECT_EQ(AreaSet{}.clearance(body(0, 0), 0), kInfinity);
}

TEST(Areas, NoRouteLeavesThem) {
  GridWorld world(200, 200);
  world.border();
  RoutePlanner planner(wheeled());
  world.tell(planner);
  const Eigen::Vector3d from(2, 2, 0), to(18, 2, 0);
  const double straight = planner.plan(from, to).length;
  const AreaSet areas = set_of({area("shaft", AreaKind::keep_out, {{8, 0}, {12, 10}})});
  planner.map().set_areas(areas);
  const Route route = planner.plan(from, to);
  ASSERT_TRUE(route.found());
  EXPECT_GT(route.length, straight + 5);
  const double half = wheeled().width / 2;
  for (std::size_t i = 0; i + 1 < route.points.size(); ++i)
    for (double t = 0; t <= 1; t += 0.02)
      EXPECT_TRUE(areas.permits(route.points[i] + t * (route.points[i + 1] - route.points[i]), half));
  EXPECT_EQ(planner.plan(from, {10, 5, 0}).status, RouteStatus::unreachable);
  planner.map().set_areas(set_of({area("west", AreaKind::keep_in, {{0, 0}, {7, 20}})}));
  EXPECT_EQ(planner.plan(from, to).status, RouteStatus::unreachable);
  EXPECT_TRUE(planner.plan(from, {5, 15, 0}).found());
  planner.map().set_areas({});
  EXPECT_NEAR(planner.plan(from, to).length, straight, 0.01);
}

TEST(Areas, NoRouteLeavesThemThroughUnknownSpace) {
  RoutePlanner planner(wheeled());
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) planner.set_ground(middle(x, y));
  planner.finish();
  ASSERT_TRUE(planner.plan({1, 1, 0}, {9, 1, 0}).found());
  planner.map().set_areas(set_of({area("near", AreaKind::keep_in, {{-2, -2}, {6, 6}})}));
  EXPECT_FALSE(planner.plan({1, 1, 0}, {9, 1, 0}).found());
  EXPECT_TRUE(planner.plan({1, 1, 0}, {5, 1, 0}).found());
}

TEST(Areas, GoalsOutsideAreForbidden) {
  GridWorld world(200, 100);
  world.border();
  RoutePlanner planner(wheeled());
  world.tell(planner);
  GoalCheck check(wheeled());
  ASSERT_EQ(check.stand(planner, {10, 5, 0}, 0), Standing::standable);
  check.set_areas(set_of({area("shaft", AreaKind::keep_out, {{8, 0}, {12, 10}})}));
  EXPECT_EQ(check.stand(planner, {10, 5, 0}, 0), Standing::forbidden);
  EXPECT_EQ(check.stand(planner, {7.8, 5, 0}, 0), Standing::forbidden) << "the body would reach over";
  EXPECT_EQ(check.stand(planner, {7.0, 5, 0}, 0), Standing::standable);
  const GoalFinding other = check.check(planner, {2, 5, 0}, {8.5, 5, 0}, true);
  EXPECT_EQ(other.standing, Standing::standable);
  EXPECT_LT(other.place.x(), 7.7);
}

TEST(Areas, TheMonitorStopsAtTheirBorder) {
  const Platform platform = wheeled();
  ScannedMonitor monitor(platform);
  const AreaSet areas = set_of({area("beyond", AreaKind::keep_out, {{2, -5}, {9, 5}})});
  std::vector<Eigen::Vector2f> points;
  sample_border(areas, {0, 0, 0}, 5.0, points);
  const std::vector<Eigen::Vector3f> nothing(360, Eigen::Vector3f::Constant(std::nanf("")));
  monitor.look(nothing, {}, 1.0);
  const double edge = 2.0 - AreaSet::kMargin - platform.length / 2;
  using Policy = CollisionMonitor::Policy;
  const Twist2 ahead{1.0, 0, 0}, back{-1.0, 0, 0};
  const Pose2 near{edge - 0.03, 0, 0};
  EXPECT_EQ(monitor.check(ahead, near, 1.0, Policy::stop).velocity, ahead);
  monitor.set_border(points);
  EXPECT_TRUE(monitor.check(ahead, near, 1.0, Policy::stop).velocity.zero());
  EXPECT_EQ(monitor.check(back, near, 1.0, Policy::stop).velocity, back);
  EXPECT_EQ(monitor.check(ahead, {-2, 0, 0}, 1.0, Policy::stop).velocity, ahead);
  monitor.set_border({});
  EXPECT_EQ(monitor.check(ahead, near, 1.0, Policy::stop).velocity, ahead);
}

TEST(Areas, TheLocalPlannerPassesNoBorder) {
  const Platform platform = wheeled();
  LocalNavigation navigation(platform);
  BoxWorld world;
  std::mt19937 random(1);
  navigation.add_scan(world.scan({0, 0, 0}, platform.lidar_height, 16, 360, 0.0, random),
                      Pose3::level({0, 0, 0}, 0), 0.0);
  const Target target = Target::to({3, 0});
  ASSERT_FALSE(navigation.plan(target, {}, 0.05).blocked);
  const AreaSet areas = set_of({area("ahead", AreaKind::keep_out, {{1.5, -0.6}, {2.5, 0.6}})});
  std::vector<Eigen::Vector2f> points;
  sample_border(areas, {0, 0, 0}, 5.0, points);
  const Plan plan = navigation.plan(target, {}, 0.1, points);
  for (std::uint32_t i = 0; i < plan.pose_count; ++i)
    EXPECT_TRUE(areas.permits(outline(platform, plan.poses[i]), 0.0)) << i;
}

TEST(Areas, ExplorationLeavesOutForbiddenGround) {
  GridWorld world(100, 100);
  world.border();
  RoutePlanner planner(wheeled());
  world.tell(planner);
  RouteGround free(planner, wheeled());
  EXPECT_FALSE(free.weighs());
  RouteGround ground(planner, wheeled(), set_of({area("shaft", AreaKind::keep_out, {{4, 4}, {6, 6}})}));
  EXPECT_TRUE(ground.weighs());
  EXPECT_TRUE(ground.standable({2, 2, 0}));
  EXPECT_FALSE(ground.standable({3.8, 5, 0}));
  EXPECT_EQ(ground.weight({5, 5, 0}), 0.0);
  EXPECT_EQ(ground.weight({2, 2, 0}), 1.0);
}

}  // namespace
}  // namespace adit::nav::test
