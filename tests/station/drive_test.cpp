// SPDX-License-Identifier: Apache-2.0
// Driving: what the robot hears of the stick, and how it ends.
#include <algorithm>

#include "tests/station/fake_robot.hpp"

namespace adit::station {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;

class DriveTest : public StationTest {
 protected:
  DriveTest() {
    add("r1");
    start();
    run_for(6s);
    EXPECT_EQ(execute("take r1").exit_code, 0);
    run_for(200ms);
  }
  FakeRobot& r1() { return *robots_[0]; }
  long pushed() {
    return std::count_if(r1().sticks().begin(), r1().sticks().end(),
                         [](const FakeRobot::HeardStick& s) { return s.sample.vx() != 0.0F; });
  }
  bool ends_in_zero() { return !r1().sticks().empty() && r1().sticks().back().sample.vx() == 0.0F; }
};

TEST_F(DriveTest, ZerosThenModeThenTheValueThenZeros) {
  const Duration before = scheduler_.elapsed();
  const Outcome outcome = execute("drive r1 0.5 0 -0.25 --for 2");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_NEAR(seconds(scheduler_.elapsed() - before), 2.0 + 0.15 + 0.3, 0.2);
  EXPECT_NEAR(static_cast<double>(pushed()), 40.0, 2.0) << "20 Hz for 2 s";
  const auto& sticks = r1().sticks();
  EXPECT_EQ(sticks.front().sample.vx(), 0.0F);
  EXPECT_LT(sticks.front().at, r1().commands().back().at) << "the stick is there before the mode is asked";
  EXPECT_EQ(r1().commands().back().command.words().front(), "manual");
  EXPECT_TRUE(ends_in_zero());
  run_for(10ms);  // the last one is under way
  const std::size_t count = sticks.size();
  run_for(2s);
  EXPECT_EQ(sticks.size(), count) << "it let go";
}

TEST_F(DriveTest, SaysWhatTheRobotClips) {
  const auto drive = [this](const std::string& velocity) {
    return execute("drive r1 " + velocity + " --for 0.2").text;
  };
  r1().describe(2.0F, 1.5F, false);
  run_for(1s);
  EXPECT_EQ(drive("2 0 -1.5"), "r1: drove for 0.2 s\n");
  EXPECT_EQ(drive("5 0 0"), "r1: drove for 0.2 s; limited to what the robot can do: 2.0 m/s\n");
  EXPECT_EQ(drive("0 0.5 -3"),
            "r1: drove for 0.2 s; limited to what the robot can do: it cannot move sideways, 1.5 rad/s\n");
  r1().describe(2.0F, 1.5F, true);
  run_for(1s);
  EXPECT_EQ(drive("0 1 0"), "r1: drove for 0.2 s\n");
  EXPECT_THAT(drive("1.9 1.9 0"), HasSubstr("2.0 m/s"));
}

TEST_F(DriveTest, SamplesEchoTheRobotsLastStampAndRise) {
  execute("drive r1 0.5 0 0");
  std::uint64_t last = 0;
  for (const auto& stick : r1().sticks()) {
    EXPECT_GT(stick.sample.seq(), last);
    last = stick.sample.seq();
    const double age = seconds(stick.at + 1000s) - static_cast<double>(stick.sample.echo()) * 1e-9;
    EXPECT_GE(age, 0.0);
    EXPECT_LT(age, 0.2);
    EXPECT_EQ(stick.sample.epoch().counter(), r1().epoch);
  }
}

TEST_F(DriveTest, ARefusedModeMovesNothing) {
  r1().answering = [](const radio::Command&) { return Reason::driver_silent; };
  const Outcome outcome = execute("drive r1 0.5 0 0");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("[driver_silent]"));
  EXPECT_EQ(pushed(), 0);
}

TEST_F(DriveTest, WhoDoesNotHoldTheRobotStreamsNothing) {
  r1().holder = "op2";
  r1().holder_id = {4};
  ++r1().epoch;
  r1().publish();
  run_for(100ms);
  r1().answering = [](const radio::Command&) { return Reason::not_holder; };
  EXPECT_EQ(execute("drive r1 0.5 0 0").exit_code, 1);
  EXPECT_TRUE(r1().sticks().empty());
}

TEST_F(DriveTest, ARobotThatHasNotHeardTheStickIsAskedAgain) {
  int asked = 0;
  r1().answering = [&](const radio::Command&) -> std::optional<Reason> {
    return ++asked < 3 ? Reason::joystick_stale : Reason::none;
  };
  EXPECT_EQ(execute("drive r1 0.5 0 0").exit_code, 0);
  EXPECT_EQ(asked, 3);
}

TEST_F(DriveTest, InSmartJoystickItStaysInThatMode) {
  EXPECT_EQ(execute("mode r1 smart_joystick").exit_code, 0);
  run_for(5s);
  EXPECT_GT(r1().sticks().back().at, scheduler_.elapsed() - 100ms) << "the stick stays centred";
  const std::size_t commands = r1().commands().size();
  EXPECT_EQ(execute("drive r1 0.5 0 0").exit_code, 0);
  EXPECT_EQ(r1().commands().size(), commands) << "no mode was asked for";
  EXPECT_GT(pushed(), 15);
  run_for(5s);
  EXPECT_GT(r1().sticks().back().at, scheduler_.elapsed() - 100ms);
  EXPECT_TRUE(ends_in_zero());
}

TEST_F(DriveTest, TheCentredStickEndsWhenTheRobotLeavesTheMode) {
  execute("mode r1 manual");
  execute("mode r1 hold");
  run_for(1s);
  const std::size_t count = r1().sticks().size();
  run_for(2s);
  EXPECT_EQ(r1().sticks().size(), count);
}

TEST_F(DriveTest, OwnStopEndsItWithZero) {
  begin("drive r1 0.5 0 0 --for 30");
  run_for(1s);
  EXPECT_GT(pushed(), 5);
  const Duration before = scheduler_.elapsed();
  EXPECT_EQ(execute("stop r1").exit_code, 0);
  run_for(1s);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].exit_code, 1);
  EXPECT_THAT(late_[0].error, HasSubstr("[stopped]"));
  for (const auto& stick : r1().sticks()) EXPECT_TRUE(stick.at <= before + 10ms || stick.sample.vx() == 0.0F);
}

TEST_F(DriveTest, TakenByAnotherItEnds) {
  begin("drive r1 0.5 0 0 --for 30");
  run_for(1s);
  r1().holder = "op2";
  r1().holder_id = {4};
  ++r1().epoch;
  r1().behaviour.mode("hold");
  r1().publish();
  run_for(1s);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_THAT(late_[0].error, HasSubstr("op2"));
  EXPECT_TRUE(ends_in_zero());
}

TEST_F(DriveTest, ARefusedStreamEndsIt) {
  begin("drive r1 0.5 0 0 --for 30");
  run_for(1s);
  r1().refuse_stream("op1", kId, Reason::identity_mismatch);
  run_for(1s);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_THAT(late_[0].error, HasSubstr("[identity_mismatch]"));
}

TEST_F(DriveTest, CancelledItSendsZeroAndLetsGo) {
  const std::uint64_t handle = begin("drive r1 0.5 0 0 --for 30");
  run_for(1s);
  strand_->post([&] { op_->cancel(handle); });
  run_for(1s);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_EQ(late_[0].exit_code, 1);
  EXPECT_TRUE(ends_in_zero());
  EXPECT_LT(r1().sticks().back().at, scheduler_.elapsed() - 500ms);
}

TEST_F(DriveTest, ANewDriveTakesTheOldOnesPlace) {
  begin("drive r1 0.5 0 0 --for 30");
  run_for(1s);
  EXPECT_EQ(execute("drive r1 -0.25 0 0").exit_code, 0);
  ASSERT_EQ(late_.size(), 1U);
  EXPECT_THAT(late_[0].error, HasSubstr("another command took its place"));
  run_for(3s);
  EXPECT_TRUE(ends_in_zero());
  EXPECT_LT(r1().sticks().back().at, scheduler_.elapsed() - 2s);
}

TEST_F(DriveTest, ARefusedGotoLeavesTheDriveAsItWas) {
  begin("drive r1 0.5 0 0 --for 30");
  run_for(1s);
  r1().answering = [](const radio::Command&) { return Reason::goal_unreachable; };
  for (const char* line : {"goto r1 4 5 --wait", "goto r1 4 5", "home r1", "mode r1 waypoint"}) {
    EXPECT_EQ(execute(line).exit_code, 1);
    run_for(500ms);
    EXPECT_FLOAT_EQ(r1().sticks().back().sample.vx(), 0.5F) << line;
  }
  EXPECT_TRUE(late_.empty());
}

TEST_F(DriveTest, AnAcceptedGotoEndsTheDrive) {
  for (const char* line : {"goto r1 4 5 --wait", "goto r1 4 5", "mode r1 waypoint"}) {
    late_.clear();
    begin("drive r1 0.5 0 0 --for 30");
    run_for(1s);
    begin(line);
    run_for(1s);
    EXPECT_THAT(late_, Contains(Field(&Outcome::error, HasSubstr("another command took its place")))) << line;
    EXPECT_TRUE(ends_in_zero()) << line;
  }
}

TEST_F(DriveTest, HoldEndsTheDriveBeforeTheRobotAnswers) {
  begin("drive r1 0.5 0 0 --for 30");
  run_for(1s);
  r1().answering = [](const radio::Command&) { return std::nullopt; };
  begin("mode r1 hold");
  run_for(100ms);
  EXPECT_TRUE(ends_in_zero());
}

TEST_F(DriveTest, ADriveTypedAfterAGotoIsNotEndedByItsAnswer) {
  std::size_t asked = 0;
  r1().answering = [&](const radio::Command& command) -> std::optional<Reason> {
    if (command.kind() == radio::CMD_GOTO && ++asked < 5) return std::nullopt;
    return Reason::none;
  };
  begin("goto r1 4 5");
  begin("drive r1 0.5 0 0 --for 2");
  run_for(4s);
  ASSERT_EQ(late_.size(), 2U);
  EXPECT_THAT(late_[1].text, HasSubstr("drove for 2.0 s"));
}

TEST_F(DriveTest, ALiveStickThatIsNotRenewedIsZero) {
  std::uint64_t handle = 0;
  std::optional<Outcome> ended;
  strand_->post([&] { handle = op_->teleop("r1", [&](const Outcome& outcome) { ended = outcome; }); });
  run_for(1s);
  EXPECT_EQ(r1().behaviour.mode(), "manual");
  strand_->post([&] { op_->stick(handle, {0.3, 0.0, 0.0}); });
  run_for(150ms);
  EXPECT_FLOAT_EQ(r1().sticks().back().sample.vx(), 0.3F);
  run_for(400ms);
  EXPECT_TRUE(ends_in_zero());
  EXPECT_FALSE(ended);
  strand_->post([&] { op_->cancel(handle); });
  run_for(1s);
  EXPECT_TRUE(ended);
}

class LiveStick : public DriveTest {
 protected:
  LiveStick() {
    strand_->post([&] { handle_ = op_->teleop("r1", [](const Outcome&) {}); });
    run_for(1s);
    EXPECT_EQ(r1().behaviour.mode(), "manual");
  }
  void push(double vx) {
    strand_->post([&, vx] { op_->stick(handle_, {vx, 0.0, 0.0}); });
    pushed_at_[static_cast<float>(vx)] = scheduler_.elapsed();
  }
  /// From a push to the robot's first sample of that value.
  std::optional<Duration> delay_of(float vx) const {
    for (const FakeRobot::HeardStick& stick : robots_[0]->sticks())
      if (stick.sample.vx() == vx) return stick.at - pushed_at_.at(vx);
    return std::nullopt;
  }
  std::uint64_t handle_{};
  std::map<float, Duration> pushed_at_{};
};

TEST_F(LiveStick, GoesOutWhenItComesAndCostsNoMoreSamples) {
  for (const Duration phase : {0ms, 3ms, 17ms, 31ms, 49ms}) {
    run_for(phase);
    const std::size_t before = r1().sticks().size();
    const Duration jitter[] = {0ms, 4ms, -6ms, 9ms, -2ms};
    Duration late{};
    for (int i = 0; i < 40; ++i) {
      const auto vx = static_cast<float>(0.001 * (i + 1) + 0.1 * static_cast<double>(phase / 1ms));
      push(vx);
      run_for(50ms + jitter[i % 5] - late);
      late = jitter[i % 5];
      ASSERT_TRUE(delay_of(vx)) << vx;
      EXPECT_LE(*delay_of(vx), 5ms) << vx << " phase " << phase / 1ms;
    }
    EXPECT_NEAR(static_cast<double>(r1().sticks().size() - before), 40.0, 1.0);
  }
}

TEST_F(LiveStick, KeepsTheRateHoweverOftenItIsRenewed) {
  const std::size_t before = r1().sticks().size();
  for (int i = 0; i < 400; ++i) {
    push(0.1 + 0.001 * i);
    run_for(5ms);
  }
  EXPECT_LE(r1().sticks().size() - before, 44U) << "20 a second for 2 s";
  EXPECT_GE(r1().sticks().size() - before, 38U);
  run_for(50ms);
  EXPECT_FLOAT_EQ(r1().sticks().back().sample.vx(), 0.499F) << "the newest value is not lost";
}

TEST_F(LiveStick, AZeroWaitsForNothingAndBuysNoRate) {
  push(0.3);
  run_for(10ms);
  push(0.0);
  run_for(5ms);
  EXPECT_TRUE(ends_in_zero());
  const std::size_t before = r1().sticks().size();
  for (int i = 0; i < 400; ++i) {
    push(i % 2 == 0 ? 0.3 : 0.0);
    run_for(5ms);
  }
  EXPECT_LE(r1().sticks().size() - before, 44U);
}

TEST_F(LiveStick, IsRepeatedWhenARenewalIsMissing) {
  push(0.3);
  run_for(200ms);
  EXPECT_GE(pushed(), 3) << "the robot lets go after 300 ms without a sample";
}

}  // namespace
}  // namespace adit::station
