// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/navigation.hpp"

#include <gtest/gtest.h>

#include "core/exec/virtual_runtime.hpp"
#include "robot_agent/motion/mux.hpp"

namespace adit::agent {
namespace {

/// A router whose answers the test gives.
class ScriptedRouter final : public Component {
 public:
  explicit ScriptedRouter(Executor& strand) : Component("router", strand) { EXPECT_TRUE(start()); }
  ~ScriptedRouter() override { stop(); }
  Result<void> on_start() override {
    offer(services.step, [this](const auto& job, const Reply<nav::RouteStep>& reply) {
      if (!answers) return;
      last = job;
      const bool asked = job->ask == nav::RouteAsk::around;
      if (asked) ++replans;
      nav::RouteStep step =
          job->goal && answer ? *answer : along(job->goal.value_or(Eigen::Vector3d{0, 0, 0}), true, left);
      step.replanned = asked;
      reply(step);
    });
    return {};
  }

  static nav::RouteStep along(const Eigen::Vector3d& target, bool last, double length = 5.0) {
    return {
        .state = nav::RouteStep::State::along, .route = 1, .target = target, .last = last, .length = length};
  }

  RouteServices services{};
  bool answers{true};
  double left{5.0};                        ///< Length of the route, m.
  int replans{0};                          ///< Times that another route was asked for.
  std::optional<nav::RouteStep> answer{};  ///< Empty: straight to the goal.
  std::shared_ptr<const RouteJob> last{};
};

/// Navigation on a virtual strand: a scan every 100 ms, a step every 50 ms, with odometry and points given by
/// the test.
class NavigationTest : public testing::Test {
 protected:
  explicit NavigationTest(double start_height = 0.0) : frames(Pose2{}, anything_goes(), start_height) {
    EXPECT_TRUE(planner.start());
    EXPECT_TRUE(navigation.start());
    mux.enable("goal", strand->now());
    run(100ms);  // through zero
    mux.step(strand->now());
    go({6, 0});
  }
  /// The tests put the robot elsewhere, which is no jump here.
  static Platform anything_goes() {
    Platform platform{};
    platform.max_speed = platform.max_turn = 1000;
    return platform;
  }
  void go(const Eigen::Vector2d& goal) {
    goal_writer.write(GoTo{{goal.x(), goal.y(), 0}}, strand->now());
    run(100ms);
  }
  void run(Duration time) {
    elapsed += time;
    scheduler.run_until(elapsed);
  }
  void odometry(const Pose2& pose) {
    EXPECT_TRUE(frames.update(Pose3::level(pose, 0), twist, ++stamp, strand->now()));
  }

  /// One tenth of a second in which the scan and the plan are made at `seen`, and the robot is at `stands`
  /// when it follows.
  void cycle(const Pose2& seen, const Pose2& stands) {
    odometry(seen);
    auto scan = std::make_shared<Scan>();
    scan->body = scan->located = Pose3::level(seen, 0);
    for (float y = -0.5f; y <= 0.3f; y += 0.03f)
      for (float z = 0.1f; z < 0.8f; z += 0.1f)
        scan->points.emplace_back(2.0f - static_cast<float>(seen.x), y, z);
    navigation.add_scan(scan, strand->now(), strand->now());
    run(40ms);
    odometry(stands);
    for (int i = 0; i < 2; ++i) {
      navigation.step(strand->now());
      run(30ms);
    }
  }

  // The plan leads round the post, but by the odometry of the moment the robot stands right before it.
  const Pose2 planned{1, 0, 0}, actual{1.71, 0.2, 0};

  VirtualScheduler scheduler{1};
  Duration elapsed{};
  std::unique_ptr<Runtime> machine{scheduler.machine("robot", 1h)};
  std::shared_ptr<Executor> strand{machine->strand("command")};
  Frames frames;
  Twist2 twist{};  ///< Of the odometry.
  std::uint64_t stamp{};
  Twist2 velocity{};
  Progress progress{};
  PlanService plans{"planner"};
  Planner planner{{}, *strand, {}, plans};
  ScriptedRouter router{*strand};
  Navigation navigation{
      NavigationParams{},
      *strand,
      {},
      frames,
      plans,
      &router.services,
      {[this](const Twist2& v) { velocity = v; }, [this](const Progress& p) { progress = p; }}};
  Mux mux{navigation};
  Mux::Output goal_writer{mux.connect("goal", 10s)};
};

TEST_F(NavigationTest, DrivesRoundWhatStandsInItsWay) {
  for (int i = 0; i < 30; ++i) {
    cycle({}, {});
    EXPECT_FALSE(progress.blocked);
  }
  EXPECT_GT(velocity.vx, 0.3);
}

TEST_F(NavigationTest, ARobotHeldByTheBrakingCheckReportsBlocked) {
  for (int i = 0; i < 12; ++i) cycle(planned, actual);
  EXPECT_TRUE(velocity.zero());
  EXPECT_FALSE(progress.blocked) << "not yet: it may be over in a moment";
  for (int i = 0; i < 10; ++i) cycle(planned, actual);
  EXPECT_TRUE(progress.blocked);

  for (int i = 0; i < 100; ++i) {
    router.left -= 0.01;
    cycle(planned, planned);
  }
  EXPECT_FALSE(progress.blocked) << "it goes on";
  EXPECT_FALSE(velocity.zero());
}

TEST_F(NavigationTest, AnotherGoalBeginsUnheld) {
  for (int i = 0; i < 25 && !progress.blocked; ++i) cycle(planned, actual);
  ASSERT_TRUE(progress.blocked);
  go({6, 0.5});
  for (int i = 0; i < 2; ++i) cycle(planned, actual);  // The first one asks for the route.
  EXPECT_FALSE(progress.blocked);
}

TEST_F(NavigationTest, FollowsTheRouteNotTheGoal) {
  router.answer = ScriptedRouter::along({-3, 3, 0}, false);
  go({6, 0});
  for (int i = 0; i < 10; ++i) cycle({}, {});
  EXPECT_GT(velocity.wz, 0.1) << "the route leads back and to the left";
}

TEST_F(NavigationTest, APlaceOnTheWayIsNoArrival) {
  router.answer = ScriptedRouter::along({0.05, 0, 0}, false);
  go({0.05, 0});
  for (int i = 0; i < 5; ++i) cycle({}, {});
  EXPECT_FALSE(progress.arrived);
  router.answer->last = true;
  for (int i = 0; i < 5; ++i) cycle({}, {});
  EXPECT_TRUE(progress.arrived);
}

TEST_F(NavigationTest, StopsBeforeAnUnreachableGoalAndReportsIt) {
  for (int i = 0; i < 10; ++i) cycle({}, {});
  ASSERT_GT(velocity.vx, 0.3);
  router.answer = nav::RouteStep{.state = nav::RouteStep::State::unreachable};
  for (int i = 0; i < 8; ++i) cycle({}, {});
  EXPECT_TRUE(velocity.zero());
  EXPECT_TRUE(progress.blocked && progress.unreachable());
  router.answer.reset();
  for (int i = 0; i < 10; ++i) cycle({}, {});
  EXPECT_FALSE(progress.unreachable()) << "a way was found";
  EXPECT_GT(velocity.vx, 0.3);
}

TEST_F(NavigationTest, WaitsForARouteUntilTheRouterAnswers) {
  for (int i = 0; i < 10; ++i) cycle({}, {});
  ASSERT_GT(velocity.vx, 0.3);
  router.answers = false;
  for (int i = 0; i < 45; ++i) cycle({}, {});
  EXPECT_TRUE(velocity.zero()) << "the last step of the route is outdated";
  router.answers = true;
  for (int i = 0; i < 30; ++i) cycle({}, {});
  EXPECT_GT(velocity.vx, 0.3);
}

TEST_F(NavigationTest, ARouteThatIsTooLongIsNotDriven) {
  router.answer = ScriptedRouter::along({3, -2, 0}, false, 9.0);
  goal_writer.write(GoTo{.goal = {6, 0, 0}, .max_route = 8.0}, strand->now());
  for (int i = 0; i < 30; ++i) cycle({}, {});
  EXPECT_TRUE(velocity.zero());
  EXPECT_TRUE(progress.unreachable());
  router.answer->length = 7.0;
  for (int i = 0; i < 30; ++i) cycle({}, {});
  EXPECT_GT(velocity.vx, 0.3) << "it became shorter";
}

TEST_F(NavigationTest, APlaceFartherAlongTheSamePathDoesNotStopTheRobot) {
  goal_writer.write(GoTo{.goal = {6, 0, 0}, .continues = true}, strand->now());
  for (int i = 0; i < 10; ++i) cycle({}, {});
  ASSERT_GT(velocity.vx, 0.3);
  router.answers = false;  // It answers for no other place.
  goal_writer.write(GoTo{.goal = {6.5, 0, 0}, .continues = true}, strand->now());
  for (int i = 0; i < 4; ++i) {
    cycle({}, {});
    EXPECT_GT(velocity.vx, 0.3);
  }
  for (int i = 0; i < 12; ++i) cycle({}, {});
  EXPECT_TRUE(velocity.zero()) << "for a moment only";
}

TEST_F(NavigationTest, AJumpOfTheOdometryEmptiesEveryMap) {
  for (int i = 0; i < 10; ++i) cycle({}, {});
  ASSERT_FALSE(navigation.goal_free({2, 0}));
  ASSERT_GT(velocity.vx, 0.3);
  // There and back, so that the second frame lies where the first one did.
  for (const double x : {1e5, 0.0}) {
    ASSERT_FALSE(frames.update(Pose3::level({x, 0, 0}, 0), {}, ++stamp, strand->now()));
    navigation.clear();
  }
  EXPECT_FALSE(navigation.terrain_fresh(strand->now()));
  EXPECT_TRUE(navigation.goal_free({2, 0}));
  navigation.step(strand->now());
  EXPECT_TRUE(velocity.zero());

  auto scan = std::make_shared<Scan>();
  scan->points.emplace_back(-3.0f, 0.0f, 0.5f);  // Nothing is seen where the post was.
  navigation.add_scan(scan, strand->now(), strand->now());
  run(100ms);
  EXPECT_TRUE(navigation.goal_free({2, 0})) << "the planner's map";
  EXPECT_EQ(router.last->odom_epoch, 2u);
}

class NavigationUpstairs : public NavigationTest {
 protected:
  NavigationUpstairs() : NavigationTest(3.0) {}
};

TEST_F(NavigationUpstairs, AsksTheRouterForHeightsOfTheOdometryFrame) {
  cycle({}, {});
  ASSERT_TRUE(router.last && router.last->goal);
  EXPECT_EQ(router.last->place.z(), 0.0);
  EXPECT_EQ(router.last->goal->z(), -3.0) << "the goal is at height 0 of the map";
}

TEST_F(NavigationTest, APlanOfTheOldFrameIsNotFollowed) {
  for (int i = 0; i < 10; ++i) cycle({}, {});
  auto scan = std::make_shared<Scan>();
  scan->points.emplace_back(2.0f, 0.0f, 0.5f);
  navigation.add_scan(scan, strand->now(), strand->now());
  ASSERT_FALSE(frames.update(Pose3::level({1e5, 0, 0}, 0), {}, ++stamp, strand->now()));
  navigation.clear();
  run(100ms);  // The plan comes back now.
  navigation.step(strand->now());
  EXPECT_TRUE(velocity.zero());
  EXPECT_TRUE(navigation.goal_free(frames.T_map_base() * Eigen::Vector2d(2, 0)));
}

class NavigationDetects : public NavigationTest {
 protected:
  NavigationDetects() {
    EXPECT_TRUE(slow.start());
    slow_mux.enable("program", strand->now());
    run(100ms);
    slow_mux.step(strand->now());
  }
  ~NavigationDetects() override { slow.stop(); }
  void scan(float x) {
    auto points = std::make_shared<Scan>();
    for (float y = -0.5f; y <= 0.5f; y += 0.03f)
      for (float z = 0.1f; z < 0.8f; z += 0.1f) points->points.emplace_back(x, y, z);
    slow.add_scan(points, strand->now(), strand->now());
  }
  /// The velocity that passes now.
  double speed() {
    writer.write(Velocity{.twist = {0.3, 0, 0}, .by_program = true}, strand->now());
    slow.step(strand->now());
    return passed.vx;
  }

  Twist2 passed{};
  Navigation slow{NavigationParams{.detection = 30ms},
                  *strand,
                  {},
                  frames,
                  plans,
                  nullptr,
                  {[this](const Twist2& v) { passed = v; }, [](const Progress&) {}, {}}};
  Mux slow_mux{slow};
  Mux::Output writer{slow_mux.connect("program", 10s)};
};

TEST_F(NavigationDetects, TheObstaclesOfAScanCountWhenTheyAreDetectedAndAgeFromItsReception) {
  odometry({});
  scan(5.0f);
  EXPECT_EQ(speed(), 0.0) << "nothing is worked out within the call";
  run(40ms);
  EXPECT_GT(speed(), 0.2);
  run(450ms);
  EXPECT_GT(speed(), 0.2);
  run(20ms);  // So 0.51 s after its reception.
  EXPECT_EQ(speed(), 0.0);
}

TEST_F(NavigationDetects, WhileOneScanIsLookedAtTheNewestOneWaits) {
  odometry({});
  scan(5.0f);
  scan(0.1f);  // Replaced, as the next one is there before it begins.
  scan(4.0f);
  run(70ms);
  EXPECT_GT(speed(), 0.2);
}

TEST_F(NavigationDetects, AScanOfTheOldFrameThatIsLookedAtDoesNotCount) {
  odometry({});
  scan(5.0f);
  slow.clear();
  run(40ms);
  EXPECT_EQ(speed(), 0.0) << "stale until the next scan";
  scan(5.0f);
  run(40ms);
  EXPECT_GT(speed(), 0.2);
}

TEST_F(NavigationTest, AfterNudgeAndWayBackTheRouterIsAskedForOtherRoutesAndThenItGivesUp) {
  for (int i = 0; i < 150; ++i) cycle(planned, actual);
  EXPECT_EQ(router.replans, nav::RecoveryParams{}.replans);
  EXPECT_TRUE(progress.gave_up());
  EXPECT_EQ(router.last->goal->head<2>(), Eigen::Vector2d(6, 0));
}

TEST_F(NavigationTest, AGoalThatMovesWithTheMapIsTheSameGoal) {
  goal_writer.write(GoTo{.goal = {6, 0, 0}, .id = 7}, strand->now());
  for (int i = 0; i < 5; ++i) cycle({}, {});
  const std::uint64_t goal = router.last->generation;
  goal_writer.write(GoTo{.goal = {6, 0.5, 0}, .id = 7}, strand->now());
  for (int i = 0; i < 3; ++i) cycle({}, {});
  EXPECT_EQ(router.last->generation, goal);
  EXPECT_EQ(router.last->goal->head<2>(), Eigen::Vector2d(6, 0.5));
  EXPECT_GT(velocity.vx, 0.3);
}

TEST_F(NavigationTest, ARobotThatPassesItsGoalHasNotArrived) {
  router.answer = ScriptedRouter::along({-0.2, 0, 0}, true, 0.2);
  go({-0.2, 0});
  twist.vx = 0.6;
  for (int i = 0; i < 5; ++i) cycle({}, {});
  EXPECT_FALSE(progress.arrived) << "it comes to rest 0.38 m from the goal";
  EXPECT_TRUE(velocity.zero());
  twist.vx = 0;
  for (int i = 0; i < 5; ++i) cycle({}, {});
  EXPECT_TRUE(progress.arrived);
}

TEST_F(NavigationTest, TurnsToTheHeadingOfItsGoalBeforeItArrives) {
  router.answer = ScriptedRouter::along({0.05, 0, 0}, true, 0.05);
  goal_writer.write(GoTo{.goal = {0.05, 0, 0}, .id = 8, .yaw = 1.0}, strand->now());
  for (int i = 0; i < 5; ++i) cycle({}, {});
  EXPECT_FALSE(progress.arrived);
  EXPECT_GT(velocity.wz, 0.1);
  for (int i = 0; i < 5; ++i) cycle({0, 0, 0.95}, {0, 0, 0.95});
  EXPECT_TRUE(progress.arrived);
}

TEST_F(NavigationTest, ObeysSpeedAndToleranceOfItsGoal) {
  goal_writer.write(GoTo{.goal = {6, 0, 0}, .id = 9, .max_speed = 0.2}, strand->now());
  for (int i = 0; i < 20; ++i) cycle({}, {});
  EXPECT_NEAR(velocity.vx, 0.2, 0.06);
  goal_writer.write(Stand{}, strand->now());
  router.answer = ScriptedRouter::along({0.6, 0, 0}, true, 0.6);
  goal_writer.write(GoTo{.goal = {0.6, 0, 0}, .id = 10, .tolerance = 0.7}, strand->now());
  for (int i = 0; i < 5 && !progress.arrived; ++i) cycle({}, {});
  EXPECT_TRUE(progress.arrived);
}

}  // namespace
}  // namespace adit::agent
