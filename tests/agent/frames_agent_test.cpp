// SPDX-License-Identifier: Apache-2.0
// What operators see of the frames: poses and goals of the map, whatever the odometry frame is.
#include <gmock/gmock.h>

#include "core/store/memory_disk.hpp"
#include "tests/agent/agent_bench.hpp"
#include "tests/agent/only_zero.hpp"

namespace adit::agent {
namespace {

using namespace radio;  // the command kinds
using testing::AnyOf;
using testing::ElementsAre;

class FramesRun : public testing::Test {
 protected:
  static constexpr double kTolerance = 0.25;  // m, of a goal
  static constexpr double kPeriod = 0.05;     // s, of the velocities

  void begin(AgentParams params = {}) {
    params.platform.max_speed = 1.5;
    params.disk = disk;
    limits = params.platform;
    bench = std::make_unique<AgentBench>(params);
    op1 = &bench->join("op1");
    bench->run(1500ms);
    ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
  }
  /// The place of the odometry frame in the map, from which SLAM computes a correction.
  MapFrame map_frame() {
    MapFrame frame{};
    bench->agent().map_frame(bench->strand(), [&](const Result<MapFrame>& found) {
      if (found) frame = *found;
    });
    bench->run(20ms);
    return frame;
  }
  /// Sends a correction to `T_map_odom` that was computed from that place; `completions` has what it ends
  /// with.
  void send(const Pose2& T_map_odom, MapFrame computed_from) {
    computed_from.T_map_odom = Pose3::level(T_map_odom, 0);
    bench->agent().correct_map(bench->strand(), computed_from, [this](const Result<MapFrame>& done) {
      completions.push_back(done.reason());
    });
  }
  Reason correct(const Pose2& T_map_odom, const MapFrame& computed_from) {
    completions.clear();
    send(T_map_odom, computed_from);
    bench->run(20ms);
    return completions.size() == 1 ? completions.front() : Reason::no_answer;
  }
  Reason correct(const Pose2& T_map_odom) { return correct(T_map_odom, map_frame()); }
  /// Largest differences between two velocities in a row, from the first motion to the last one. At its goal
  /// a robot is sent zero at once, whatever the map does.
  struct Steps {
    double speed{}, turn{};
  };
  Steps steps() const {
    const auto moves = [](const Twist2& velocity) { return !velocity.zero(); };
    const auto& all = bench->commands;
    const auto first = std::find_if(all.begin(), all.end(), moves);
    const auto end = std::find_if(all.rbegin(), all.rend(), moves).base();
    Steps most{};
    for (auto next = first + 1; next < end; ++next) {
      const Twist2 &a = *(next - 1), &b = *next;
      most.speed = std::max(most.speed, std::fabs(b.vx - a.vx));
      most.turn = std::max(most.turn, std::fabs(b.wz - a.wz));
    }
    return most;
  }
  /// A goto to (12, 4); after 4 s the map is corrected so.
  Steps run_to_goal(const std::optional<Pose2>& correction) {
    begin();
    bench->commands.clear();
    EXPECT_EQ(bench->ask(*op1, CMD_GOTO, "", 12, 4), Reason::none);
    bench->run(4s);
    EXPECT_GT(bench->command.vx, 0.5);
    EXPECT_LT(bench->pose.x, 8.0);
    if (correction) {
      EXPECT_EQ(correct(*correction), Reason::none);
    }
    bench->run(20s);
    EXPECT_EQ(op1->behaviour.goal_state(), radio::GOAL_REACHED);
    return steps();
  }

  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  Platform limits{};
  std::vector<Reason> completions{};
  std::unique_ptr<AgentBench> bench{};
  AgentBench::Operator* op1{};
};

TEST_F(FramesRun, ACorrectionInTheMiddleOfAGotoIsNoStepOfTheVelocity) {
  const Steps plain = run_to_goal({});
  const Pose2 plain_end = bench->pose;
  EXPECT_NEAR(plain_end.y, 4, kTolerance);

  disk = std::make_shared<store::MemoryDisk>();
  const Steps corrected = run_to_goal(Pose2{0, -0.5, 0});
  EXPECT_LE(corrected.speed, limits.max_acceleration * kPeriod * 1.01);
  EXPECT_LE(corrected.turn, limits.max_turn_acceleration * kPeriod * 1.01);
  constexpr double kNoise = 0.01;  // m/s, rad/s
  EXPECT_LE(corrected.speed, plain.speed + kNoise);
  EXPECT_LE(corrected.turn, plain.turn + kNoise);

  EXPECT_NEAR(std::hypot(bench->pose.x - 12, bench->pose.y - 4.5), 0, kTolerance + 0.02)
      << "in the odometry frame";
  EXPECT_NEAR(std::hypot(op1->state.x() - 12, op1->state.y() - 4), 0, kTolerance + 0.02) << "in the map";
  EXPECT_EQ(op1->behaviour.goal()[1], 4) << "operators see the goal where they gave it";
}

TEST_F(FramesRun, TheRouterLeadsToTheCorrectedGoalToo) {
  AgentParams params;
  params.platform.router = "graph";
  begin(params);
  ASSERT_EQ(bench->ask(*op1, CMD_GOTO, "", 6, 0), Reason::none);
  bench->run(3500ms);  // The goal is the next place of the route.
  ASSERT_LT(bench->pose.x, 5.5);
  bench->commands.clear();
  ASSERT_EQ(correct({0.3, -0.4, 0}), Reason::none);
  bench->run(15s);
  EXPECT_EQ(op1->behaviour.goal_state(), radio::GOAL_REACHED);
  EXPECT_NEAR(std::hypot(bench->pose.x - 5.7, bench->pose.y - 0.4), 0, kTolerance + 0.02);
  EXPECT_LE(steps().speed, limits.max_acceleration * kPeriod * 1.01);
}

TEST_F(FramesRun, ACorrectionMovesNoRobot) {
  begin();
  ASSERT_EQ(bench->ask(*op1, CMD_GOTO, "", 2, 0), Reason::none);
  bench->run(10s);
  ASSERT_EQ(op1->behaviour.goal_state(), radio::GOAL_REACHED);
  bench->commands.clear();
  ASSERT_EQ(correct({5, 3, 1}), Reason::none);
  bench->run(5s);
  EXPECT_THAT(bench->commands, only_zero()) << "at its goal";
  ASSERT_EQ(bench->ask(*op1, CMD_MODE, "hold"), Reason::none);
  ASSERT_EQ(correct({-5, 3, 1}), Reason::none);
  bench->run(5s);
  EXPECT_THAT(bench->commands, only_zero()) << "in hold";
}

TEST_F(FramesRun, TelemetryShowsThePoseInTheMap) {
  AgentParams params;
  params.start = {4, 2, 0};
  begin(params);
  EXPECT_FLOAT_EQ(op1->state.x(), 4.0F);
  ASSERT_EQ(correct({4.5, 2, 0.5}), Reason::none);
  bench->run(1s);
  EXPECT_FLOAT_EQ(op1->state.x(), 4.5F);
  EXPECT_FLOAT_EQ(op1->state.yaw(), 0.5F);
}

TEST_F(FramesRun, ACorrectionSurvivesARestart) {
  begin();
  ASSERT_EQ(correct({0.5, -0.25, 0}), Reason::none);
  bench->run(500ms);
  bench->stop_agent();
  bench->start_agent();
  bench->run(2s);
  EXPECT_FLOAT_EQ(op1->state.x(), 0.5F);
  EXPECT_FLOAT_EQ(op1->state.y(), -0.25F);
}

TEST_F(FramesRun, AnOperatorsPoseReplacesACorrection) {
  begin();
  ASSERT_EQ(correct({5, 5, 0}), Reason::none);
  ASSERT_EQ(bench->ask(*op1, CMD_POSE, "", 1, 2), Reason::none);
  bench->run(500ms);
  EXPECT_FLOAT_EQ(op1->state.x(), 1.0F);
  EXPECT_FLOAT_EQ(op1->state.y(), 2.0F);
}

TEST_F(FramesRun, ACorrectionOfAFrameThatEndedIsRefused) {
  begin();
  ASSERT_EQ(bench->ask(*op1, CMD_GOTO, "", 20, 0), Reason::none);
  bench->run(4s);
  ASSERT_EQ(correct({0, 1, 0}), Reason::none);
  bench->run(500ms);
  const MapFrame ended = map_frame();
  const double before = bench->pose.x;
  bench->pose = {};
  bench->run(300ms);
  EXPECT_EQ(correct({0, 9, 0}, ended), Reason::odometry_jumped);
  EXPECT_NEAR(op1->state.x(), before, 0.4) << "it is taken to be where it was";
  EXPECT_NEAR(op1->state.y(), 1, 0.1);
  EXPECT_EQ(op1->behaviour.mode(), "hold");
}

TEST_F(FramesRun, ACorrectionComputedBeforeARestartIsRefused) {
  begin();
  const MapFrame first = map_frame();
  ASSERT_EQ(correct({0.5, -0.25, 0}, first), Reason::none);
  bench->run(500ms);
  const MapFrame last = map_frame();
  bench->stop_agent();
  bench->start_agent();
  bench->run(2s);
  for (const MapFrame& before : {first, last})
    EXPECT_EQ(correct({9, 9, 0}, before), Reason::sample_stale) << before.map_epoch;
  EXPECT_FLOAT_EQ(op1->state.x(), 0.5F);
  EXPECT_EQ(correct({0.75, 0, 0}), Reason::none);
}

TEST_F(FramesRun, ACrashGivesNoEpochToTwoPlaces) {
  begin();
  const MapFrame first = map_frame();
  send({0.5, -0.25, 0}, first);
  bench->run(1ms);  // Before the next beat.
  ASSERT_THAT(completions, ElementsAre(Reason::none));
  MapFrame last = first;
  ++last.map_epoch;
  ASSERT_TRUE(bench->agent().inject("command", ComponentFault::crash));
  bench->run(3s);
  EXPECT_NEAR(map_frame().T_map_odom.position.x(), 0.5, 1e-9);
  EXPECT_EQ(correct({9, 9, 0}, first), Reason::sample_stale);
  EXPECT_EQ(correct({9, 9, 0}, last), Reason::sample_stale);
}

TEST_F(FramesRun, ACorrectionCompletesOnceWhenTheComponentCrashes) {
  begin();
  const MapFrame frame = map_frame();
  send({1, 0, 0}, frame);
  ASSERT_TRUE(bench->agent().inject("command", ComponentFault::crash));
  send({2, 0, 0}, frame);
  bench->run(1ms);  // The next instance does not exist yet.
  send({3, 0, 0}, frame);
  bench->run(10s);
  ASSERT_EQ(completions.size(), 3u);
  EXPECT_THAT(completions.back(), AnyOf(Reason::cancelled, Reason::no_answer, Reason::sample_stale));
}

TEST_F(FramesRun, ACorrectionCompletesOnceWhenTheComponentHangs) {
  begin();
  const MapFrame frame = map_frame();
  ASSERT_TRUE(bench->agent().inject("command", ComponentFault::hang));
  bench->run(1ms);
  send({1, 0, 0}, frame);
  bench->run(10s);
  EXPECT_THAT(completions, ElementsAre(AnyOf(Reason::cancelled, Reason::no_answer)));
}

TEST_F(FramesRun, ACorrectionCompletesOnceWhenTheAgentEnds) {
  begin();
  send({1, 0, 0}, map_frame());
  bench->stop_agent();
  bench->run(10s);
  EXPECT_THAT(completions, ElementsAre(Reason::cancelled));
}

TEST_F(FramesRun, OfManyCorrectionsAtOnceEachCompletesOnce) {
  begin();
  const MapFrame frame = map_frame();
  for (int n = 0; n < 20; ++n) send({0.1 * n, 0, 0}, frame);
  bench->run(10s);
  EXPECT_EQ(completions.size(), 20u);
  EXPECT_EQ(std::count(completions.begin(), completions.end(), Reason::none), 1);
}

TEST_F(FramesRun, HomeIsWhereTheRobotStartedInTheMap) {
  AgentParams params;
  params.start = {4, 2, 0};
  begin(params);
  ASSERT_EQ(bench->ask(*op1, CMD_GOTO, "", 8, 2), Reason::none);
  bench->run(8s);
  ASSERT_EQ(correct({4, 2.5, 0}), Reason::none);  // The odometry has drifted by half a metre.
  ASSERT_EQ(bench->ask(*op1, CMD_HOME), Reason::none);
  bench->run(15s);
  EXPECT_NEAR(std::hypot(op1->state.x() - 4, op1->state.y() - 2), 0, kTolerance + 0.02);
  EXPECT_NEAR(bench->pose.y, -0.5, kTolerance + 0.02);
}

TEST(StartHeight, PlacesTheOdometryInTheMap) {
  AgentParams params;
  params.start = {4, 2, 0};
  params.start_height = 3.5;
  AgentBench bench(params);
  auto& op1 = bench.join("op1");
  bench.run(2s);
  EXPECT_FLOAT_EQ(op1.state.x(), 4.0F);
  EXPECT_FLOAT_EQ(op1.state.z(), 3.5F);
}

}  // namespace
}  // namespace adit::agent
