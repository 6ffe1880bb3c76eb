// SPDX-License-Identifier: Apache-2.0
// Routes over staircases that the robot knows.
#include "nav/routing/known_stairs.hpp"

#include <gtest/gtest.h>

#include "nav/routing/route_follower.hpp"
#include "nav/routing/route_planner.hpp"
#include "tests/nav/box_world.hpp"
#include "tests/nav/places.hpp"
#include "tests/nav/route_world.hpp"

namespace adit::nav::test {
namespace {

/// Nine steps of 0.16 m along x from (5, 2), 1.4 m wide, between two floors with walls around them.
Staircase nine_steps() {
  Staircase stairs;
  stairs.foot = {5.0, 2.0, 0.08};
  stairs.rise = 0.16;
  stairs.run = 0.3;
  stairs.width = 1.4;
  stairs.steps = 9;
  return stairs;
}
constexpr double kUpper = 9 * 0.16;

/// What scans showed: the floors and their walls, and nothing between x = 4.9 and `seen_again`.
void show_floors(RoutePlanner& planner, double seen_again = 7.6) {
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 110; ++x) {
      const double at = (x + 0.5) * 0.1;
      const bool beside = at > 4.9 && at < 7.6 && (y < 13 || y >= 27);
      if (y % 39 == 0 || x % 109 == 0 || beside)
        planner.set_obstacle(middle(x, y, at < 5 ? 0.0 : kUpper), 2.5);
      else if (at < 4.9 || at > seen_again)
        planner.set_ground(middle(x, y, at < 5 ? 0.0 : kUpper));
    }
  planner.finish();
}

RouteParams seen_only() {
  RouteParams params;
  params.through_unknown = false;
  return params;
}

TEST(KnownStairs, ATreadIsAsHighAsItsStep) {
  const Staircase stairs = nine_steps();
  EXPECT_NEAR(tread_height(stairs, -0.1), 0.0, 1e-9);
  EXPECT_NEAR(tread_height(stairs, 0.1), 0.16, 1e-9);
  EXPECT_NEAR(tread_height(stairs, 2.39), 8 * 0.16, 1e-9);
  EXPECT_NEAR(tread_height(stairs, 3.0), kUpper, 1e-9);
}

TEST(KnownStairs, ALeggedRobotCrossesStepsThatItHasNotSeen) {
  RoutePlanner planner(legged(), seen_only());
  show_floors(planner);
  EXPECT_FALSE(planner.plan({1, 2, 0}, {9.5, 2, kUpper}).found());
  planner.set_stairs(std::vector{nine_steps()});
  for (const bool up : {true, false}) {
    const Eigen::Vector3d below{1, 1, 0}, above{9.5, 3.3, kUpper};
    const Route route = up ? planner.plan(below, above) : planner.plan(above, below);
    ASSERT_TRUE(route.found()) << (up ? "up" : "down");
    EXPECT_EQ(route.unknown_length, 0.0);
  }
}

TEST(KnownStairs, ARouteKeepsToTheAxis) {
  Staircase wide = nine_steps();
  wide.width = 3.6;
  RoutePlanner planner(legged(), seen_only());
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 110; ++x) {
      const double at = (x + 0.5) * 0.1;
      const Eigen::Vector3d place = middle(x, y, tread_height(wide, at - 5.0));
      if (y % 39 == 0 || x % 109 == 0)
        planner.set_obstacle(place, 2.5);
      else
        planner.set_ground(place);
    }
  planner.finish();
  const auto off_axis = [&] {
    const Route route = planner.plan({3.0, 0.8, 0}, {9.0, 0.8, kUpper});
    EXPECT_TRUE(route.found());
    double most = 0.0;
    for (std::size_t i = 0; i + 1 < route.points.size(); ++i)
      for (double t = 0; t <= 1; t += 0.02) {
        const Eigen::Vector3d at = route.points[i] + t * (route.points[i + 1] - route.points[i]);
        if (at.x() > 5.3 && at.x() < 7.1) most = std::max(most, std::abs(at.y() - 2.0));
      }
    return most;
  };
  EXPECT_GT(off_axis(), 0.9);
  planner.set_stairs(std::vector{wide});
  EXPECT_LT(off_axis(), 0.4);
}

TEST(KnownStairs, RisersThatLookedLikeObstaclesAreNone) {
  RoutePlanner planner(legged(), seen_only());
  show_floors(planner);
  const Staircase stairs = nine_steps();
  for (int n = 0; n < stairs.steps; ++n)
    for (int y = 13; y < 27; ++y) planner.set_obstacle(middle(50 + 3 * n, y, n * stairs.rise), 0.3);
  planner.set_stairs(std::vector{stairs});
  EXPECT_TRUE(planner.plan({1, 2, 0}, {9.5, 2, kUpper}).found());
  // What stands on them is one.
  for (int y = 13; y < 27; ++y) planner.set_obstacle(middle(60, y, tread_height(stairs, 1.05)), 0.8);
  EXPECT_FALSE(planner.plan({1, 2, 0}, {9.5, 2, kUpper}).found());
}

TEST(KnownStairs, WheelsDoNotTakeThemAndTheReasonNamesThem) {
  RoutePlanner planner(wheeled());
  show_floors(planner);
  EXPECT_TRUE(planner.plan({1, 2, 0}, {9.5, 2, kUpper}).found()) << "through what was not seen";
  planner.set_stairs(std::vector{nine_steps()});
  const Route route = planner.plan({1, 2, 0}, {9.5, 2, kUpper});
  EXPECT_EQ(route.status, RouteStatus::unreachable);
  ASSERT_TRUE(route.stairs);
  EXPECT_EQ(*route.stairs, nine_steps());
  planner.set_stairs({});
  EXPECT_TRUE(planner.map().stairs().empty());
}

TEST(KnownStairs, TheGroundOfOneThatIsNotKnownAnyMoreGoesWithIt) {
  RoutePlanner planner(legged(), seen_only());
  show_floors(planner);
  planner.set_stairs(std::vector{nine_steps()});
  EXPECT_TRUE(planner.plan({1, 2, 0}, {9.5, 2, kUpper}).found());
  planner.set_stairs({});
  EXPECT_FALSE(planner.plan({1, 2, 0}, {9.5, 2, kUpper}).found());
  EXPECT_FALSE(planner.ground(6.0, 2.0, 0.6));
  EXPECT_TRUE(planner.ground(4.5, 2.0, 0.0)) << "the floor before it was seen";
}

TEST(KnownStairs, TheGroundMovesWithThem) {
  RoutePlanner planner(legged(), seen_only());
  show_floors(planner);
  Staircase narrow = nine_steps(), moved = nine_steps();
  narrow.width = moved.width = 0.8;
  moved.foot.y() += 0.3;
  const double z = tread_height(moved, 1.05);
  for (const Staircase& stairs : {narrow, moved, narrow, moved}) {
    planner.set_stairs(std::vector{stairs});
    const bool aside = stairs == moved;
    EXPECT_EQ(planner.ground(6.05, 1.65, z).has_value(), !aside);
    EXPECT_EQ(planner.ground(6.05, 2.65, z).has_value(), aside);
    ASSERT_TRUE(planner.ground(6.05, 2.15, z));
    EXPECT_NEAR(*planner.ground(6.05, 2.15, z), z, 1e-5) << "both of them are there";
  }
}

TEST(KnownStairs, WhatScansShowedOfThemFromNearStays) {
  SurfaceMap map({}, 0.1f);
  const auto see = [&](double robot_x, double x, float z, SurfaceMap::Seen seen) {
    map.begin_scan(robot_x, 2.0);
    map.see_free(route_cell(x), route_cell(2.05), z, 0.0f, seen);
  };
  const auto height = [&](double x) -> std::optional<float> {
    const GroundCell* cell = map.cell(route_cell(x), route_cell(2.05), 0.5);
    return cell && cell->known ? std::optional(cell->z) : std::nullopt;
  };
  const Staircase stairs = nine_steps();
  see(4.0, 5.15, 0.13f, SurfaceMap::Seen::measured);
  map.set_stairs(std::vector{stairs});
  EXPECT_EQ(height(5.15), 0.13f) << "seen from 1 m before it was known";
  see(4.0, 5.45, 0.3f, SurfaceMap::Seen::measured);
  EXPECT_EQ(height(5.45), 0.3f) << "seen from 1 m";
  see(4.0, 5.75, 0.45f, SurfaceMap::Seen::between);
  see(0.0, 6.05, 0.6f, SurfaceMap::Seen::measured);
  EXPECT_NEAR(height(5.75).value_or(0), 0.48f, 1e-5) << "between returns";
  EXPECT_NEAR(height(6.05).value_or(0), 0.64f, 1e-5) << "from afar";
  map.set_stairs({});
  EXPECT_EQ(height(5.15), 0.13f);
  EXPECT_EQ(height(5.45), 0.3f);
  EXPECT_FALSE(height(5.75));
  EXPECT_FALSE(height(6.05));
}

TEST(KnownStairs, WhatStoodOnThemIsThereWithoutThem) {
  SurfaceMap map({}, 0.1f);
  map.begin_scan(0.0, 2.0);
  map.set_stairs(std::vector{nine_steps()});
  map.see_obstacle(6.05f, 2.05f, 0.64f, 0.8f, true);
  map.set_stairs({});
  const GroundCell* cell = map.cell(route_cell(6.05), route_cell(2.05), 0.64);
  ASSERT_TRUE(cell);
  EXPECT_TRUE(cell->blocked);
}

TEST(KnownStairs, LegsDoNotTakeStepsAboveTheirs) {
  Platform low = legged();
  low.step = 0.15;
  RoutePlanner planner(low);
  show_floors(planner);
  planner.set_stairs(std::vector{nine_steps()});
  const Route route = planner.plan({1, 2, 0}, {9.5, 2, kUpper});
  EXPECT_EQ(route.status, RouteStatus::unreachable);
  EXPECT_TRUE(route.stairs);
}

TEST(KnownStairs, TheNearestToARobotAndToItsGoalAreTaken) {
  std::vector<Staircase> stairs;
  for (int i = 0; i < 6; ++i) {
    stairs.push_back(nine_steps());
    stairs.back().foot.x() += 10.0 * i;
  }
  const auto feet = [](const std::vector<Staircase>& some) {
    std::vector<double> out;
    for (const Staircase& each : some) out.push_back(each.foot.x());
    return out;
  };
  using Ends = std::vector<Eigen::Vector3d>;
  EXPECT_EQ(feet(nearest_stairs(stairs, Ends{{56, 2, 0}, {28, 2, 0}}, 2)), (std::vector{25.0, 55.0}));
  EXPECT_EQ(feet(nearest_stairs(stairs, Ends{{47, 2, kNan}}, 1)), (std::vector{45.0})) << "over its steps";
  EXPECT_EQ(nearest_stairs(stairs, Ends{{0, 0, 0}}, 6), stairs);
  // Of equal ones, those of another floor are farther.
  stairs = {nine_steps(), nine_steps()};
  stairs[0].foot.z() += 6.0;
  EXPECT_EQ(nearest_stairs(stairs, Ends{{4, 2, 0}}, 1), (std::vector{nine_steps()}));
}

TEST(KnownStairs, AFlightLeadsTowardsAHeightByAStoreyAtLeast) {
  const std::vector<Staircase> stairs{nine_steps()};
  const auto up = flights_towards(stairs, kUpper);
  ASSERT_EQ(up.size(), 1U);
  EXPECT_LT((up[0].begin - Eigen::Vector3d(4.2, 2, 0)).norm(), 1e-9) << up[0].begin.transpose();
  EXPECT_LT((up[0].end - Eigen::Vector3d(8.2, 2, kUpper)).norm(), 1e-9) << up[0].end.transpose();
  EXPECT_EQ(flights_towards(stairs, 4.8).size(), 1U) << "the first of several flights";
  const auto down = flights_towards(stairs, -3.0);
  ASSERT_EQ(down.size(), 1U);
  EXPECT_GT(down[0].begin.z(), down[0].end.z());
  EXPECT_TRUE(flights_towards(stairs, kUpper / 2).empty());
}

/// A floor of so many cells with walls around it, from a cell on.
void show_room(RoutePlanner& planner, int x0, int y0, int nx, int ny, double z) {
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x)
      if (y % (ny - 1) == 0 || x % (nx - 1) == 0)
        planner.set_obstacle(middle(x0 + x, y0 + y, z), 2.5);
      else
        planner.set_ground(middle(x0 + x, y0 + y, z));
}

TEST(KnownStairs, TheReasonNamesOnlyStairsThatTheRobotReaches) {
  Staircase elsewhere = nine_steps();
  elsewhere.foot += Eigen::Vector3d(60, 80, 0);
  RoutePlanner planner(wheeled());
  show_floors(planner);
  for (int y = 12; y < 28; ++y) planner.set_obstacle(middle(60, y, 0.6), 2.5);
  for (int y = 12; y < 28; ++y) planner.set_obstacle(middle(60, y, 0.0), 2.5);
  planner.set_stairs(std::vector{elsewhere});
  const Route other = planner.plan({1, 2, 0}, {9.5, 2, kUpper});
  EXPECT_EQ(other.status, RouteStatus::unreachable);
  EXPECT_FALSE(other.stairs) << "a staircase of other floors";
  planner.set_stairs(std::vector{elsewhere, nine_steps()});
  const Route named = planner.plan({1, 2, 0}, {9.5, 2, kUpper});
  EXPECT_EQ(named.status, RouteStatus::unreachable);
  ASSERT_TRUE(named.stairs);
  EXPECT_EQ(*named.stairs, nine_steps());
}

TEST(KnownStairs, TheReasonNamesOnlyStairsFromWhichARouteLeadsToTheGoal) {
  RoutePlanner planner(wheeled());
  show_floors(planner);
  show_room(planner, 150, 0, 40, 40, kUpper);
  planner.finish();
  planner.set_stairs(std::vector{nine_steps()});
  const Route route = planner.plan({1, 2, 0}, {17, 2, kUpper});
  EXPECT_EQ(route.status, RouteStatus::unreachable);
  EXPECT_FALSE(route.stairs) << "a wall is between their upper end and the goal";
}

TEST(KnownStairs, TheReasonNamesTheFirstOfTwoFlights) {
  Staircase second = nine_steps();
  second.foot += Eigen::Vector3d(5.0, 0, kUpper);
  RoutePlanner planner(wheeled());
  show_room(planner, 0, 0, 50, 40, 0.0);
  show_room(planner, 75, 0, 25, 40, kUpper);
  show_room(planner, 125, 0, 40, 40, 2 * kUpper);
  planner.finish();
  planner.set_stairs(std::vector{second, nine_steps()});
  const Route route = planner.plan({1, 2, 0}, {15, 2, 2 * kUpper});
  EXPECT_EQ(route.status, RouteStatus::unreachable);
  ASSERT_TRUE(route.stairs);
  EXPECT_EQ(*route.stairs, nine_steps());
}

/// Nine steps of 0.16 m down along x from the edge of a landing at x = 0, between walls.
struct FlightDown {
  static constexpr double kRise = 0.16, kRun = 0.25, kLanding = 9 * kRise;
  BoxWorld world{};
  FlightDown() {
    world.ceiling = 6.0;
    world.lowest = -45;
    world.boxes = {{-3, 0, -1.5, 1.5, 0, kLanding}, {-3, 0, 1.5, 1.7, 0, 5},  {-3, 0, -1.7, -1.5, 0, 5},
                   {-3.2, -3, -2, 2, 0, 5},         {0, 2.5, 0.7, 1.7, 0, 5}, {0, 2.5, -1.7, -0.7, 0, 5}};
    for (int n = 0; n < 8; ++n)
      world.boxes.push_back({n * kRun, (n + 1) * kRun, -0.7, 0.7, 0, kLanding - (n + 1) * kRise});
  }
  static Staircase stairs() {
    Staircase steps;
    steps.foot = {8 * kRun, 0, kRise / 2};
    steps.heading = M_PI;
    steps.rise = kRise;
    steps.run = kRun;
    steps.width = 1.4;
    steps.steps = 9;
    return steps;
  }
  /// Impassable cells on the upper steps, after a look from the landing, 1.2 m before the edge.
  int blocked(const Platform& platform, const std::vector<Staircase>& known) const {
    TerrainMap map(platform);
    map.set_stairs(known);
    std::mt19937 random(1);
    for (int i = 0; i < 5; ++i) {
      auto points = world.scan({-1.2, 0, 0}, kLanding + platform.lidar_height, 32, 720, 0.0, random);
      for (Eigen::Vector3f& point : points) point.z() -= static_cast<float>(kLanding);
      Pose3 body;
      body.position = {-1.2, 0, kLanding};
      map.add_scan(points, body, 0.1 * i);
    }
    return static_cast<int>(std::ranges::count_if(places(map), [](const LocalPlace& cell) {
      return cell.cost >= 1.0f && cell.x > -0.15f && cell.x < 1.0f && std::abs(cell.y) < 0.4f;
    }));
  }
};

TEST(KnownStairs, TheEdgeOfALandingHidesStepsThatAreKnown) {
  const FlightDown flight;
  EXPECT_GT(flight.blocked(legged(), {}), 5) << "they cannot be seen from there";
  EXPECT_EQ(flight.blocked(legged(), {FlightDown::stairs()}), 0);
  EXPECT_GT(flight.blocked(wheeled(), {FlightDown::stairs()}), 5) << "which wheels do not descend";
  Staircase elsewhere = FlightDown::stairs();
  elsewhere.foot.z() -= 3.0;
  EXPECT_GT(flight.blocked(legged(), {elsewhere}), 5) << "those of another floor";
}

TEST(KnownStairs, ARouteThatClimbsWhereTheGroundDoesNotIsReplaced) {
  RoutePlanner planner(legged());
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) planner.set_ground(middle(x, y));
  planner.finish();
  RouteFollower follower(legged());
  Eigen::Vector3d place(1, 2, 0);
  for (int i = 0; i < 60; ++i) {
    const RouteStep step = follower.step(planner, {.place = place, .goal = {9, 2, 4.8}, .stamp_s = 0.2 * i});
    if (step.state != RouteStep::State::along) continue;
    ASSERT_LE(std::abs(step.ahead.front().z() - place.z()), kFloorSeparation) << place.transpose();
    const Eigen::Vector2d way = (step.target - place).head<2>();
    place.head<2>() += std::min(0.2, way.norm()) * way.normalized();
    const int cx = route_cell(place.x()), cy = route_cell(place.y());
    for (int y = cy - 3; y <= cy + 3; ++y)
      for (int x = cx - 3; x <= cx + 3; ++x) planner.set_ground(middle(x, y));
  }
  EXPECT_GT(place.x(), 6.0);
}

/// Drives along the route on a floor at z = 0 that becomes known only around the robot. Returns the metres.
double driven_before_giving_up(const std::vector<Staircase>& stairs, RouteStep& last) {
  RoutePlanner planner(wheeled());
  RouteFollower follower(wheeled());
  const Eigen::Vector3d goal{9.5, 2, 4.8};
  Eigen::Vector3d place(1, 2, 0);
  double driven = 0.0;
  for (int i = 0; i < 600 && driven < 60.0; ++i) {
    const int cx = route_cell(place.x()), cy = route_cell(place.y());
    for (int y = cy - 12; y <= cy + 12; ++y)
      for (int x = cx - 12; x <= cx + 12; ++x) planner.set_ground(middle(x, y));
    planner.set_stairs(stairs);
    last = follower.step(planner, {.place = place, .goal = goal, .stamp_s = 0.2 * i});
    if (last.state == RouteStep::State::unreachable) break;
    if (last.state != RouteStep::State::along) continue;
    const Eigen::Vector2d way = (last.target - place).head<2>();
    const double step = std::min(0.2, way.norm());
    place.head<2>() += step * way.normalized();
    driven += step;
  }
  return driven;
}

TEST(KnownStairs, WheelsSearchAWayRoundForSoManyMetresAndNameTheStairs) {
  RouteStep last;
  const double driven = driven_before_giving_up({nine_steps()}, last);
  EXPECT_EQ(last.state, RouteStep::State::unreachable) << driven << " m";
  EXPECT_EQ(last.goal, Standing::over_stairs);
  ASSERT_TRUE(last.stairs);
  EXPECT_EQ(*last.stairs, nine_steps());
  EXPECT_LE(driven, 21.0);
}

TEST(KnownStairs, AStaircaseThatWheelsCannotReachEndsNoSearch) {
  Staircase elsewhere = nine_steps();
  elsewhere.foot += Eigen::Vector3d(60, 80, 0);
  RouteStep last;
  const double driven = driven_before_giving_up({elsewhere}, last);
  EXPECT_FALSE(last.stairs) << driven << " m";
  EXPECT_NE(last.goal, Standing::over_stairs);
}

TEST(KnownStairs, ARouteBeginsOnTheGroundThatTheRobotIsOn) {
  RoutePlanner planner(legged(), seen_only());
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) {
      if (x < 16) planner.set_ground(middle(x, y));
      if (x > 20) planner.set_ground(middle(x, y, 1.2));
    }
  planner.finish();
  const Route route = planner.plan({2.0, 2.0, 0.0}, {0.7, 2.0, 0.0});
  ASSERT_TRUE(route.found());
  EXPECT_NEAR(route.points.front().z(), 0.0, 0.1);
}

}  // namespace
}  // namespace adit::nav::test
