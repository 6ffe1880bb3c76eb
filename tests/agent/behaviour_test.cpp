// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/behaviour.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "tests/folders/folders.hpp"

namespace adit::agent {
namespace {

struct Recorder : NavigationInput {
  void accept(MuxKey, const Motion& motion, Time) override { last = motion; }
  Motion last{};
};

class BehaviourTest : public testing::Test {
 protected:
  BehaviourTest() { run(100ms); }

  /// The 20 Hz beat, with the stick sent along when it is streaming.
  void run(Duration time) {
    for (const Time end = now + time; now < end;) {
      now += 50ms;
      if (streaming) (void)behaviour.stick(value, now);
      behaviour.tick(now);
      mux.step(now);
    }
  }
  void enter_manual(const char* mode = "manual") {
    streaming = true;
    value = {};
    run(100ms);
    ASSERT_TRUE(behaviour.request_mode(mode, now));
  }
  std::string mode() const { return behaviour.view().mode; }
  std::vector<std::string> codes() const {
    std::vector<std::string> all;
    for (const Notice& n : notices) all.push_back(n.code);
    return all;
  }

  Facts facts{false, true, true, true, false, false, false, false, false, false};
  bool goal_free{true};
  Recorder nav{};
  Mux mux{nav};
  std::vector<Notice> notices{};
  std::vector<Pose2> set{};
  Pose2 at{};
  double stopping{};
  int changes{};
  Behaviour behaviour{
      {},
      Decider::load(source_folder() + "/config/trees/robot.xml").value(),
      mux,
      {[this](Time) { return facts; },
       [this](const Eigen::Vector2d&) { return goal_free; },
       {},
       [this] { return std::optional(at); },
       [this](const Pose2& pose) -> Result<void> {
         set.push_back(pose);
         return {};
       },
       [this] { return stopping; }},
      {[this](Severity severity, const std::string& code, Reason reason, const std::string& text) {
         notices.push_back({{}, severity, code, reason, text});
       },
       [this] { ++changes; }}};
  Time now{Duration{1h}};
  bool streaming{};
  Twist2 value{};
};

TEST_F(BehaviourTest, PoseIsRefusedOutsideHold) {
  EXPECT_TRUE(behaviour.set_pose({3, 4, 1}, now));
  EXPECT_EQ(behaviour.set_pose({std::nan(""), 4, 1}, now).error().reason, Reason::out_of_range);
  EXPECT_EQ(behaviour.set_pose({3, 20'000, 1}, now).error().reason, Reason::out_of_range);
  EXPECT_EQ(behaviour.set_pose({3, 4, INFINITY}, now).error().reason, Reason::out_of_range);
  ASSERT_TRUE(behaviour.request_goal({5, 0, 0}, now));
  EXPECT_EQ(behaviour.set_pose({3, 4, 1}, now).error().reason, Reason::wrong_mode);
  enter_manual();
  EXPECT_EQ(behaviour.set_pose({3, 4, 1}, now).error().reason, Reason::wrong_mode);
  behaviour.stop_changed(true, now);
  EXPECT_TRUE(behaviour.set_pose({5, 6, 2}, now)) << "a stop ends in hold";
  EXPECT_EQ(set, (std::vector<Pose2>{{3, 4, 1}, {5, 6, 2}}));
  EXPECT_EQ(nav.last, Motion{Stand{}});
}

TEST_F(BehaviourTest, ThePoseAnswersAJumpOfTheOdometry) {
  behaviour.hold(Reason::odometry_jumped, now);
  EXPECT_EQ(behaviour.view().reason, Reason::odometry_jumped);
  EXPECT_TRUE(behaviour.set_pose({3, 4, 1}, now));
  EXPECT_EQ(behaviour.view().reason, Reason::none);
  EXPECT_EQ(nav.last, Motion{Stand{}});
}

TEST_F(BehaviourTest, StopsBeforeItsBudgetForAnUnseenGoalIsUsedUp) {
  ASSERT_TRUE(behaviour.request_goal({20, 0, 0}, now));
  behaviour.limit_unknown(2.0);
  stopping = 0.5;
  const auto drive_to = [this](double x) {
    for (; at.x < x - 1e-6; at.x += 0.25) {
      behaviour.set_progress({.goal_seen = false});
      run(50ms);
    }
    run(50ms);
  };
  drive_to(1.25);
  EXPECT_EQ(nav.last, (Motion{GoTo{{20, 0, 0}}}));
  drive_to(1.5);
  EXPECT_EQ(nav.last, Motion{Stand{}});
  EXPECT_EQ(behaviour.view().goal_state, GoalState::blocked);
  EXPECT_EQ(behaviour.view().reason, Reason::unknown_budget);
  EXPECT_THAT(codes(), testing::ElementsAre("unknown_budget"));
  ASSERT_TRUE(behaviour.request_mode("waypoint", now)) << "the goal is stored";
  run(100ms);
  EXPECT_EQ(nav.last, (Motion{GoTo{{20, 0, 0}}}));
  behaviour.set_progress({.goal_seen = true});
  for (; at.x < 10; at.x += 0.25) run(50ms);
  EXPECT_EQ(nav.last, (Motion{GoTo{{20, 0, 0}}})) << "metres towards a goal that was seen are free";
}

TEST_F(BehaviourTest, StartsInHoldWithZero) {
  EXPECT_EQ(mode(), "hold");
  EXPECT_EQ(nav.last, Motion{Stand{}});
  EXPECT_FALSE(behaviour.view().moving_allowed);
}

TEST_F(BehaviourTest, ManualPassesTheStickAtOnce) {
  enter_manual();
  EXPECT_EQ(mode(), "manual");
  run(100ms);
  now += 10ms;
  ASSERT_TRUE(behaviour.stick({0.4, 0, 0.1}, now));
  EXPECT_EQ(nav.last, (Motion{Velocity{{0.4, 0, 0.1}}}));
}

TEST_F(BehaviourTest, RestartOfTheHoldersStationEndsManual) {
  enter_manual();
  value = {0.4, 0, 0};
  run(500ms);
  behaviour.holder_restarted(now);
  EXPECT_EQ(mode(), "hold");
  EXPECT_EQ(nav.last, Motion{Stand{}});
  EXPECT_THAT(codes(), testing::ElementsAre("joystick_lost"));
  run(500ms);  // the stick is still pushed
  EXPECT_EQ(mode(), "hold");
  EXPECT_EQ(nav.last, Motion{Stand{}});
}

TEST_F(BehaviourTest, ManualNeedsAFreshCentredStick) {
  EXPECT_EQ(behaviour.request_mode("manual", now).reason(), Reason::joystick_stale);
  streaming = true;
  value = {0.3, 0, 0};
  run(100ms);
  EXPECT_EQ(behaviour.request_mode("manual", now).reason(), Reason::stick_not_centred);
  EXPECT_EQ(mode(), "hold");
  EXPECT_EQ(nav.last, Motion{Stand{}});
}

TEST_F(BehaviourTest, PushedStickInHoldIsRefusedAndMovesNothing) {
  EXPECT_EQ(behaviour.stick({0.5, 0, 0}, now).reason(), Reason::wrong_mode);
  EXPECT_TRUE(behaviour.stick({}, now));
  run(200ms);
  EXPECT_EQ(nav.last, Motion{Stand{}});
}

TEST_F(BehaviourTest, LettingGoOfACentredStickIsNoWarning) {
  enter_manual();
  value = {0.5, 0, 0};
  run(200ms);
  value = {};
  run(300ms);
  streaming = false;
  run(1100ms);
  EXPECT_EQ(mode(), "hold");
  EXPECT_THAT(codes(), testing::ElementsAre("mode_changed"));
  EXPECT_EQ(notices.back().severity, Severity::info);
  EXPECT_EQ(notices.back().reason, Reason::joystick_stale);
  EXPECT_EQ(behaviour.view().reason, Reason::none) << "the robot misses no stick";
}

TEST_F(BehaviourTest, SilentStickIsZeroAfter300msAndHoldAfterOneSecond) {
  enter_manual();
  value = {0.5, 0, 0};
  run(200ms);
  EXPECT_EQ(nav.last, (Motion{Velocity{value}}));
  streaming = false;
  run(250ms);
  EXPECT_EQ(nav.last, (Motion{Velocity{value}}));
  run(100ms);
  EXPECT_EQ(nav.last, Motion{Stand{}});
  EXPECT_EQ(mode(), "manual");
  run(600ms);
  EXPECT_EQ(mode(), "manual");
  run(100ms);
  EXPECT_EQ(mode(), "hold");
  EXPECT_THAT(codes(), testing::ElementsAre("joystick_lost"));
  EXPECT_EQ(behaviour.view().reason, Reason::joystick_stale);
  // A fresh joystick alone moves nothing (rule 7).
  streaming = true;
  run(500ms);
  EXPECT_EQ(mode(), "hold");
  EXPECT_EQ(nav.last, Motion{Stand{}});
}

TEST_F(BehaviourTest, StopIsZeroWithinTheCallAndResetMovesNothing) {
  enter_manual();
  value = {0.5, 0, 0};
  run(200ms);
  behaviour.stop_changed(true, now);
  EXPECT_EQ(nav.last, Motion{Stand{}});
  EXPECT_EQ(mode(), "hold");
  EXPECT_EQ(behaviour.view().reason, Reason::stopped);
  run(200ms);
  behaviour.stop_changed(false, now);
  run(500ms);
  EXPECT_EQ(mode(), "hold");
  EXPECT_EQ(nav.last, Motion{Stand{}});
}

TEST_F(BehaviourTest, AGoalWithoutAHeightIsOnTheFloor) {
  const Eigen::Vector3d no_height{5, 1, std::nan("")};
  ASSERT_TRUE(behaviour.request_goal(no_height, now));
  run(100ms);
  EXPECT_EQ(nav.last, (Motion{GoTo{no_height}}));
  EXPECT_TRUE(behaviour.view().goal.allFinite()) << "operators get a number";
  const StoredBehaviour stored = behaviour.stored();
  EXPECT_EQ(stored, behaviour.stored()) << "else it would be written again and again";
  behaviour.restore(stored, false, true, false);
  run(100ms);
  EXPECT_EQ(nav.last, (Motion{GoTo{no_height}})) << "also after a restart";
}

TEST_F(BehaviourTest, AGoalSurvivesAStopAndContinuesOnRequest) {
  ASSERT_TRUE(behaviour.request_goal({5, 1, 0}, now));
  run(100ms);
  EXPECT_EQ(nav.last, (Motion{GoTo{{5, 1, 0}}}));
  EXPECT_EQ(behaviour.view().goal_state, GoalState::active);
  behaviour.stop_changed(true, now);
  EXPECT_EQ(nav.last, Motion{Stand{}});
  EXPECT_EQ(behaviour.view().goal_state, GoalState::kept);
  behaviour.stop_changed(false, now);
  run(500ms);
  EXPECT_EQ(nav.last, Motion{Stand{}});
  ASSERT_TRUE(behaviour.request_mode("waypoint", now));
  run(100ms);
  EXPECT_EQ(nav.last, (Motion{GoTo{{5, 1, 0}}}));
  EXPECT_EQ(behaviour.view().goal_id, 1u);
}

TEST_F(BehaviourTest, GoalIsClearedByAnotherMode) {
  ASSERT_TRUE(behaviour.request_goal({5, 1, 0}, now));
  ASSERT_TRUE(behaviour.request_mode("hold", now));
  EXPECT_EQ(behaviour.view().goal_state, GoalState::none);
  EXPECT_EQ(behaviour.request_mode("waypoint", now).reason(), Reason::goal_missing);
}

TEST_F(BehaviourTest, GoalsAreNumberedAndChecked) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& bad : {Eigen::Vector3d{nan, 0, 0}, Eigen::Vector3d{0, inf, 0},
                                     Eigen::Vector3d{10'001, 0, 0}, Eigen::Vector3d{0, 0, inf}})
    EXPECT_EQ(behaviour.request_goal(bad, now).reason(), Reason::out_of_range);
  goal_free = false;
  EXPECT_EQ(behaviour.request_goal({1, 0, 0}, now).reason(), Reason::goal_unreachable);
  goal_free = true;
  facts.terrain_fresh = false;
  EXPECT_EQ(behaviour.request_goal({1, 0, 0}, now).reason(), Reason::terrain_stale);
  facts.terrain_fresh = true;
  EXPECT_EQ(behaviour.view().goal_id, 0u);
  EXPECT_TRUE(behaviour.request_goal({1, 0, nan}, now));
  EXPECT_TRUE(behaviour.request_goal({2, 0, 0}, now));
  EXPECT_EQ(behaviour.view().goal_id, 2u);
}

TEST_F(BehaviourTest, ArrivalEndsTheMotionNotTheMode) {
  ASSERT_TRUE(behaviour.request_goal({5, 1, 0}, now));
  run(100ms);
  behaviour.set_progress({true, false});
  run(50ms);
  EXPECT_EQ(mode(), "waypoint");
  EXPECT_EQ(behaviour.view().goal_state, GoalState::reached);
  EXPECT_EQ(nav.last, Motion{Stand{}});
  EXPECT_THAT(codes(), testing::ElementsAre("arrived"));
  ASSERT_TRUE(behaviour.request_goal({9, 1, 0}, now));
  run(100ms);
  EXPECT_EQ(behaviour.view().goal_state, GoalState::active);
}

TEST_F(BehaviourTest, ReportsAnUnreachableGoalOnceAndContinuesWhenARouteExists) {
  ASSERT_TRUE(behaviour.request_goal({5, 1, 0}, now));
  run(100ms);
  behaviour.set_progress({.blocked = true, .reason = Reason::goal_unreachable});
  run(20s);
  EXPECT_THAT(codes(), testing::ElementsAre("unreachable")) << "and not blocked as well";
  EXPECT_EQ(behaviour.view().goal_state, GoalState::blocked);
  EXPECT_EQ(behaviour.view().reason, Reason::goal_unreachable);
  behaviour.set_progress({});
  run(100ms);
  EXPECT_EQ(behaviour.view().goal_state, GoalState::active);
}

TEST_F(BehaviourTest, HandoverEndsManualModesOnly) {
  enter_manual();
  behaviour.holder_changed(now);
  EXPECT_EQ(mode(), "hold");
  ASSERT_TRUE(behaviour.request_goal({5, 1, 0}, now));
  behaviour.holder_changed(now);
  run(100ms);
  EXPECT_EQ(mode(), "waypoint");
  EXPECT_EQ(nav.last, (Motion{GoTo{{5, 1, 0}}}));
}

TEST_F(BehaviourTest, StickOfTheFormerHolderDoesNotCount) {
  enter_manual();
  streaming = false;
  behaviour.holder_changed(now);
  EXPECT_EQ(behaviour.request_mode("manual", now).reason(), Reason::joystick_stale);
}

TEST_F(BehaviourTest, SilentDriverPausesAutonomousModesAndEndsManualOnes) {
  ASSERT_TRUE(behaviour.request_goal({5, 1, 0}, now));
  facts.driver_alive = false;
  run(50ms);
  EXPECT_EQ(mode(), "waypoint");
  EXPECT_FALSE(behaviour.view().moving_allowed);
  EXPECT_EQ(behaviour.view().reason, Reason::driver_silent);
  EXPECT_EQ(nav.last, Motion{Stand{}});
  facts.driver_alive = true;
  run(100ms);
  EXPECT_EQ(nav.last, (Motion{GoTo{{5, 1, 0}}}));
  enter_manual();
  facts.driver_alive = false;
  run(50ms);
  EXPECT_EQ(mode(), "hold");
  EXPECT_EQ(notices.back().reason, Reason::driver_silent);
}

TEST_F(BehaviourTest, SmartJoystickGuidesTheLocalPlanner) {
  enter_manual("smart_joystick");
  value = {0.5, 0, 0.2};
  run(100ms);
  EXPECT_EQ(nav.last, (Motion{Guidance{value}}));
}

TEST_F(BehaviourTest, ListensAfterARestartBeforeItContinues) {
  StoredBehaviour stored{};
  stored.mode = "waypoint";
  stored.goal_known = true;
  stored.goal = {3, 0, 0};
  behaviour.restore(stored, false, true, true);
  facts.goal_known = true;
  run(500ms);
  EXPECT_EQ(mode(), "waypoint");
  EXPECT_EQ(behaviour.view().reason, Reason::just_restarted);
  EXPECT_EQ(nav.last, Motion{Stand{}});
  behaviour.stop_changed(true, now);  // the stop that was under way
  behaviour.go_on(now);
  EXPECT_FALSE(behaviour.view().moving_allowed);
  behaviour.stop_changed(false, now);
  behaviour.restore(stored, false, true, true);
  behaviour.go_on(now);
  EXPECT_TRUE(behaviour.view().moving_allowed);
}

TEST_F(BehaviourTest, UnknownModesAreRefused) {
  EXPECT_EQ(behaviour.request_mode("fly", now).reason(), Reason::mode_unknown);
  EXPECT_EQ(behaviour.request_mode("explore", now).reason(), Reason::mode_not_installed);
  EXPECT_EQ(behaviour.request_mode("", now).reason(), Reason::mode_unknown);
}

TEST_F(BehaviourTest, OptionsStateWhyAModeIsUnavailable) {
  const auto option = [&](std::string_view wanted) {
    for (const contract::ModeOption& o : behaviour.options(now))
      if (o.mode == wanted) return o.reason;
    return Reason::internal;
  };
  EXPECT_EQ(option("hold"), Reason::none);
  EXPECT_EQ(option("manual"), Reason::joystick_stale);
  EXPECT_EQ(option("waypoint"), Reason::goal_missing);
  behaviour.stop_changed(true, now);
  EXPECT_EQ(option("waypoint"), Reason::stopped);
}

TEST_F(BehaviourTest, IdleAndBlockedAreReportedOnce) {
  run(61s);
  EXPECT_THAT(codes(), testing::ElementsAre("idle"));
  notices.clear();
  ASSERT_TRUE(behaviour.request_goal({5, 1, 0}, now));
  behaviour.set_progress({.blocked = true});
  run(4s);
  EXPECT_TRUE(notices.empty());
  EXPECT_EQ(behaviour.view().goal_state, GoalState::blocked);
  behaviour.set_progress({.blocked = true, .reason = Reason::blocked});
  run(10s);
  EXPECT_THAT(codes(), testing::ElementsAre("blocked"));
}

TEST_F(BehaviourTest, ChangesAreReported) {
  const int before = changes;
  run(1s);
  EXPECT_EQ(changes, before);
  ASSERT_TRUE(behaviour.request_goal({5, 1, 0}, now));
  EXPECT_EQ(changes, before + 1);
  behaviour.stop_changed(true, now);
  EXPECT_EQ(changes, before + 2);
  behaviour.stop_changed(false, now);
  EXPECT_EQ(changes, before + 3);
}

/// A robot at the origin of the map that knows whether areas permit a place.
class AreasOfBehaviour : public BehaviourTest {
 protected:
  AreasOfBehaviour() {
    Behaviour::Inputs inputs{[this](Time) { return facts; }, [](const Eigen::Vector2d&) { return true; }, {}};
    inputs.body_permitted = [this](const nav::AreaSet& areas) { return areas.permits({at.x, at.y, 0}); };
    inputs.goal_permitted = [](const nav::AreaSet& areas, const Eigen::Vector3d& goal) {
      return areas.permits({goal.x(), goal.y(), 0});
    };
    robot.emplace(BehaviourParams{}, Decider::load(source_folder() + "/config/trees/robot.xml").value(), mux,
                  std::move(inputs), Behaviour::Outputs{[](const auto&...) {}, [this] { ++changes; }});
    robot->tick(now);
  }
  Reason add(const char* name, nav::AreaKind kind, std::vector<Eigen::Vector2d> corners) {
    const auto added = robot->add_area({.name = name, .kind = kind, .corners = std::move(corners)}, now);
    return added ? Reason::none : added.reason();
  }
  std::optional<Behaviour> robot{};
};

TEST_F(AreasOfBehaviour, AMalformedAreaAndOneThatForbidsTheRobotsPlaceAreRefused) {
  using enum nav::AreaKind;
  EXPECT_EQ(add("a", keep_in, {{1, 1}}), Reason::bad_argument);
  EXPECT_EQ(add("a", keep_out, {{-1, -1}, {1, 1}}), Reason::outside_area);
  EXPECT_EQ(add("a", keep_in, {{1, 1}, {2, 2}}), Reason::outside_area);
  EXPECT_TRUE(robot->areas().empty());
  EXPECT_EQ(add("a", keep_in, {{-1, -1}, {1, 1}}), Reason::none);
  EXPECT_EQ(add("b", keep_in, {{1, 1}, {2, 2}}), Reason::none) << "they are a union";
  EXPECT_EQ(add("c", prefer, {{5, 5}, {6, 6}}), Reason::none);
  EXPECT_EQ(robot->remove_area("d", now).reason(), Reason::bad_argument);
  EXPECT_EQ(robot->remove_area("c", now).reason(), Reason::none);
  EXPECT_EQ(robot->view().areas.size(), 2U);
}

TEST_F(AreasOfBehaviour, AreReportedAndStored) {
  const int before = changes;
  ASSERT_EQ(add("shaft", nav::AreaKind::keep_out, {{5, 5}, {6, 6}}), Reason::none);
  EXPECT_GT(changes, before);
  ASSERT_EQ(robot->view().areas.size(), 1U);
  EXPECT_EQ(robot->view().areas[0].name, "shaft");
  const StoredBehaviour stored = robot->stored();
  EXPECT_TRUE(stored.areas.find("shaft"));
  ASSERT_TRUE(robot->remove_area("shaft", now));
  robot->restore(stored, false, true);
  ASSERT_EQ(robot->view().areas.size(), 1U);
  EXPECT_EQ(robot->view().areas[0].name, "shaft");
}

TEST_F(AreasOfBehaviour, AGoalOutsideIsRefusedAlsoAStoredOne) {
  ASSERT_TRUE(robot->request_goal({7, 0, 0}, now));
  ASSERT_TRUE(robot->request_mode("hold", now));
  ASSERT_EQ(add("west", nav::AreaKind::keep_in, {{-5, -5}, {5, 5}}), Reason::none);
  EXPECT_EQ(robot->request_goal({8, 0, 0}, now).reason(), Reason::outside_area);
  EXPECT_EQ(robot->request_goal({4, 0, std::nan("")}, now).reason(), Reason::none);
  ASSERT_TRUE(robot->request_mode("hold", now));
  ASSERT_TRUE(robot->remove_area("west", now));
  ASSERT_TRUE(robot->request_goal({7, 0, 0}, now));
  robot->stop_changed(true, now);
  robot->stop_changed(false, now);
  ASSERT_EQ(add("west", nav::AreaKind::keep_in, {{-5, -5}, {5, 5}}), Reason::none);
  EXPECT_EQ(robot->request_mode("waypoint", now).reason(), Reason::outside_area);
}

}  // namespace
}  // namespace adit::agent
