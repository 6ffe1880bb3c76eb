// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/modes/explore.hpp"

#include <gmock/gmock.h>

#include "robot_agent/behaviour/behaviour.hpp"
#include "tests/folders/folders.hpp"

namespace adit::agent {
namespace {

using contract::ExplorationPhase;

struct ExploreNavigation : NavigationInput {
  void accept(MuxKey, const Motion& motion, Time) override { last = motion; }
  Motion last{};
};

/// A behaviour whose explorer answers what the test says.
class ExploreModeTest : public testing::Test {
 protected:
  void run(Duration time) {
    for (const Time end = now + time; now < end;) {
      now += 50ms;
      behaviour.tick(now);
      mux.step(now);
    }
  }
  void see(nav::ExploreState state, std::optional<Eigen::Vector3d> goal = std::nullopt) {
    answer = {
        .state = state, .goal = goal, .frontiers = goal ? 3u : 0u, .volume = 100, .open = goal ? 100.0 : 0.0};
    run(500ms);
  }
  Eigen::Vector2d target() const {
    const auto* go = std::get_if<GoTo>(&nav.last);
    return go ? Eigen::Vector2d(go->goal.head<2>()) : Eigen::Vector2d(-1, -1);
  }
  ExplorationPhase phase() const { return behaviour.view().exploration.phase; }
  Behaviour::Inputs inputs() {
    Behaviour::Inputs in{[this](Time) { return facts; }, [](const Eigen::Vector2d&) { return true; }};
    in.pose = [this] { return std::optional(at); };
    in.explore = [this](const NextPlaceQuery& asked, auto done) {
      blocks += asked.blocked;
      begun += asked.begins;
      area = asked.area;
      if (refusal == Reason::none)
        done(answer);
      else
        done({refusal, "its area was removed"});
    };
    in.holder_heard = [this] { return heard; };
    in.home = Eigen::Vector2d(1, 2);
    return in;
  }

  Facts facts{.driver_alive = true, .localised = true, .terrain_fresh = true, .map_fresh = true};
  ExploreNavigation nav{};
  Mux mux{nav};
  std::vector<Notice> notices{};
  Pose2 at{5, 5, 0};
  bool heard{true};
  int blocks{}, begun{};
  nav::ExploreStep answer{};
  std::string area{};
  Reason refusal{Reason::none};
  Behaviour behaviour{
      {},
      Decider::load(source_folder() + "/config/trees/robot.xml").value(),
      mux,
      inputs(),
      {[this](Severity severity, const std::string& code, Reason reason, const std::string& text) {
         notices.push_back({{}, severity, code, reason, text});
       },
       [] {}}};
  Time now{Duration{1h}};
};

TEST_F(ExploreModeTest, DrivesFromPlaceToPlaceAndHoldsWhenNothingIsLeft) {
  ASSERT_TRUE(behaviour.request_explore({}, now));
  EXPECT_EQ(phase(), ExplorationPhase::starting);
  see(nav::ExploreState::exploring, Eigen::Vector3d(8, 5, 0));
  EXPECT_EQ(target(), Eigen::Vector2d(8, 5));
  EXPECT_EQ(phase(), ExplorationPhase::exploring);
  EXPECT_FLOAT_EQ(behaviour.view().exploration.share, 0.5f);
  see(nav::ExploreState::exploring, Eigen::Vector3d(40, 5, 0));
  EXPECT_EQ(target(), Eigen::Vector2d(40, 5));
  EXPECT_EQ(phase(), ExplorationPhase::travelling);
  see(nav::ExploreState::done);
  EXPECT_EQ(phase(), ExplorationPhase::done);
  EXPECT_EQ(behaviour.view().mode, "hold");
  EXPECT_EQ(nav.last, Motion{Stand{}});
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0].code, "explored");
  EXPECT_EQ(begun, 1) << "only the first question begins an exploration";
}

TEST_F(ExploreModeTest, WithoutAnyViewpointItIsNeverDone) {
  ASSERT_TRUE(behaviour.request_explore({.after = AfterExploring::home}, now));
  see(nav::ExploreState::no_viewpoint);
  EXPECT_EQ(phase(), ExplorationPhase::ended);
  EXPECT_EQ(behaviour.view().exploration.reason, Reason::no_viewpoint);
  EXPECT_EQ(behaviour.view().mode, "hold");
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0].reason, Reason::no_viewpoint);
}

TEST_F(ExploreModeTest, DrivesHomeBeforeItHolds) {
  ASSERT_TRUE(behaviour.request_explore({.after = AfterExploring::home}, now));
  see(nav::ExploreState::exploring, Eigen::Vector3d(8, 5, 0));
  see(nav::ExploreState::done);
  EXPECT_EQ(phase(), ExplorationPhase::reporting);
  EXPECT_EQ(target(), Eigen::Vector2d(1, 2));
  behaviour.set_progress({.arrived = true});
  run(100ms);
  EXPECT_EQ(phase(), ExplorationPhase::done);
  EXPECT_EQ(behaviour.view().mode, "hold");
}

TEST_F(ExploreModeTest, ReportsWhereItsHolderWasHeardLast) {
  ASSERT_TRUE(behaviour.request_explore({}, now));
  see(nav::ExploreState::exploring, Eigen::Vector3d(8, 5, 0));
  heard = false;
  at = {20, 5, 0};
  see(nav::ExploreState::done);
  EXPECT_EQ(phase(), ExplorationPhase::reporting);
  EXPECT_EQ(target(), Eigen::Vector2d(5, 5));
  heard = true;
  run(100ms);
  EXPECT_EQ(phase(), ExplorationPhase::done);
}

TEST_F(ExploreModeTest, AStopInterruptsItAndOnlyARequestGoesOn) {
  ASSERT_TRUE(behaviour.request_explore({.after = AfterExploring::home}, now));
  see(nav::ExploreState::exploring, Eigen::Vector3d(8, 5, 0));
  behaviour.stop_changed(true, now);
  behaviour.stop_changed(false, now);
  run(1s);
  EXPECT_EQ(behaviour.view().mode, "hold");
  EXPECT_EQ(nav.last, Motion{Stand{}});
  ASSERT_TRUE(behaviour.request_mode("explore", now));
  see(nav::ExploreState::exploring, Eigen::Vector3d(9, 5, 0));
  EXPECT_EQ(target(), Eigen::Vector2d(9, 5));
  see(nav::ExploreState::done);
  EXPECT_EQ(target(), Eigen::Vector2d(1, 2)) << "it still drives home afterwards";
  EXPECT_EQ(begun, 1);
}

TEST_F(ExploreModeTest, AGoalThatNavigationGaveUpIsReportedToTheExplorer) {
  ASSERT_TRUE(behaviour.request_explore({}, now));
  see(nav::ExploreState::exploring, Eigen::Vector3d(8, 5, 0));
  behaviour.set_progress({.blocked = true});
  run(10s);
  EXPECT_EQ(blocks, 0) << "it still tries";
  behaviour.set_progress({.blocked = true, .recovery = nav::RecoveryState::give_up});
  run(1s);
  EXPECT_EQ(blocks, 1);
}

TEST_F(ExploreModeTest, EndsWhenItsTimeIsOver) {
  ASSERT_TRUE(behaviour.request_explore({.after = AfterExploring::wait, .limit = 3.0}, now));
  see(nav::ExploreState::exploring, Eigen::Vector3d(8, 5, 0));
  run(2s);
  EXPECT_EQ(phase(), ExplorationPhase::exploring);
  run(1s);
  EXPECT_EQ(phase(), ExplorationPhase::ended);
  EXPECT_EQ(behaviour.view().mode, "hold");
}

TEST_F(ExploreModeTest, GoesOnAfterARestart) {
  ASSERT_TRUE(behaviour.request_explore({.after = AfterExploring::home}, now));
  see(nav::ExploreState::exploring, Eigen::Vector3d(8, 5, 0));
  const StoredBehaviour stored = behaviour.stored();
  behaviour.restore(stored, false, true);
  see(nav::ExploreState::exploring, Eigen::Vector3d(9, 5, 0));
  EXPECT_EQ(target(), Eigen::Vector2d(9, 5));
  see(nav::ExploreState::done);
  EXPECT_EQ(target(), Eigen::Vector2d(1, 2));
  behaviour.set_progress({.arrived = true});
  run(100ms);
  const StoredBehaviour done = behaviour.stored();
  behaviour.restore(done, false, true);
  run(1s);
  EXPECT_EQ(phase(), ExplorationPhase::done);
}

TEST_F(ExploreModeTest, AnAreaToExploreMustExistAndLeaveRoom) {
  using enum nav::AreaKind;
  const auto add = [this](const char* name, nav::AreaKind kind, std::vector<Eigen::Vector2d> corners) {
    ASSERT_TRUE(behaviour.add_area({.name = name, .kind = kind, .corners = std::move(corners)}, now));
  };
  EXPECT_EQ(behaviour.request_explore({.area = "west"}, now).reason(), Reason::bad_argument);
  add("west", prefer, {{0, 0}, {10, 10}});
  add("shaft", keep_out, {{20, 0}, {30, 10}});
  add("in_shaft", prefer, {{22, 2}, {28, 8}});
  EXPECT_EQ(behaviour.request_explore({.area = "shaft"}, now).reason(), Reason::outside_area);
  EXPECT_EQ(behaviour.request_explore({.area = "in_shaft"}, now).reason(), Reason::outside_area);
  ASSERT_TRUE(behaviour.request_explore({.area = "west"}, now));
  see(nav::ExploreState::exploring, Eigen::Vector3d(8, 5, 0));
  EXPECT_EQ(area, "west");
}

TEST_F(ExploreModeTest, TheAreaToExploreSurvivesARestartAndEndsTheExplorationWhenItIsRemoved) {
  ASSERT_TRUE(behaviour.add_area(
      {.name = "west", .kind = nav::AreaKind::prefer, .corners = {{0, 0}, {10, 10}}}, now));
  ASSERT_TRUE(behaviour.request_explore({.after = AfterExploring::wait, .area = "west"}, now));
  see(nav::ExploreState::exploring, Eigen::Vector3d(8, 5, 0));
  const StoredBehaviour stored = behaviour.stored();
  ASSERT_TRUE(behaviour.request_explore({}, now));
  behaviour.restore(stored, false, true);
  area.clear();
  run(1s);
  EXPECT_EQ(area, "west");
  refusal = Reason::outside_area;
  run(1s);
  EXPECT_EQ(phase(), ExplorationPhase::ended);
  EXPECT_EQ(behaviour.view().exploration.reason, Reason::outside_area);
  EXPECT_EQ(behaviour.view().mode, "hold");
}

}  // namespace
}  // namespace adit::agent
