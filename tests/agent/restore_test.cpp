// SPDX-License-Identifier: Apache-2.0
// An agent that dies and comes back on the same disk (rules 1, 2, 4 and 7).
#include <gmock/gmock.h>

#include "core/store/memory_disk.hpp"
#include "core/store/sections.hpp"
#include "robot_agent/state/restored.hpp"
#include "tests/agent/agent_bench.hpp"
#include "tests/agent/only_zero.hpp"

namespace adit::agent {
namespace {

using namespace radio;  // the command kinds
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class Restore : public testing::Test {
 protected:
  void SetUp() override { begin(true); }
  void begin(bool resume, std::uint64_t boot = 0) {
    AgentParams params;
    params.boot = boot;
    params.disk = disk;
    params.resume_after_restart = resume;
    bench = std::make_unique<AgentBench>(params);
    op1 = &bench->join("op1");
    op2 = &bench->join("op2");
    bench->run(1500ms);
  }
  /// The process dies, and another one is started half a second later.
  void crash() {
    bench->stop_agent();
    bench->command = {};  // its parent sends zero
    bench->run(500ms);
    op1->notices.clear();
    op2->notices.clear();
    bench->commands.clear();
    bench->start_agent();
  }
  void take_lock_and_go() {
    ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
    ASSERT_EQ(bench->ask(*op1, CMD_LOCK), Reason::none);
    ASSERT_EQ(bench->ask(*op1, CMD_GOTO, "", 30, 0), Reason::none);
  }
  std::string notice(const AgentBench::Operator& op, const std::string& code) {
    for (const auto& n : op.notices)
      if (n.code() == code) return n.text();
    return {};
  }

  std::shared_ptr<store::MemoryDisk> disk{std::make_shared<store::MemoryDisk>()};
  std::unique_ptr<AgentBench> bench{};
  AgentBench::Operator *op1{}, *op2{};
};

TEST_F(Restore, HolderLockAndGoalComeBackUnderANewEpoch) {
  take_lock_and_go();
  const auto before = op1->authority.epoch();
  const auto goal = op1->behaviour.goal_id();
  crash();
  bench->run(2s);
  EXPECT_EQ(op1->authority.holder(), "op1");
  EXPECT_TRUE(op1->authority.locked());
  EXPECT_NE(op1->authority.epoch().start(), before.start());
  EXPECT_EQ(op1->authority.epoch().counter(), before.counter() + 1);
  EXPECT_EQ(op1->behaviour.goal_id(), goal);
  EXPECT_EQ(bench->ask(*op2, CMD_TAKE), Reason::locked);
  EXPECT_EQ(bench->ask(*op1, CMD_UNLOCK), Reason::none) << "the holder goes on with the new epoch";
}

TEST_F(Restore, AForgerWhoSpeaksFirstAfterAKillIsNotTheHolder) {
  take_lock_and_go();
  AgentBench::Operator& forger = bench->join("op3");
  bench->run(1s);
  forger.beat = {};  // no presence: only the holder's name and id in its commands
  forger.name = "op1";
  forger.id = op1->id;
  forger.seq = 100;
  op1->beat = {};
  crash();
  bench->run(100ms);
  forger.authority = op1->authority;
  EXPECT_EQ(bench->ask(forger, CMD_RELEASE), Reason::identity_mismatch);
  EXPECT_EQ(bench->ask(*op1, CMD_UNLOCK), Reason::none) << "the real one is still the holder";
}

TEST_F(Restore, AreasSurviveAndStillBind) {
  ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
  ASSERT_EQ(bench->ask(*op1, CMD_AREA_ADD, "shaft", 20, 25), Reason::none);
  ASSERT_EQ(op1->behaviour.areas().size(), 1U);
  crash();
  bench->run(2s);
  ASSERT_EQ(op1->behaviour.areas().size(), 1U);
  EXPECT_EQ(op1->behaviour.areas()[0].name(), "shaft");
  EXPECT_THAT(notice(*op1, "restarted"), HasSubstr("1 area"));
  EXPECT_EQ(bench->ask(*op1, CMD_GOTO, "", 22, 0), Reason::outside_area);
  EXPECT_EQ(bench->ask(*op1, CMD_GOTO, "", 10, 0), Reason::none);
}

TEST_F(Restore, TheOldEpochNoLongerCounts) {
  take_lock_and_go();
  const auto before = op1->authority;
  crash();
  bench->run(1s);
  op1->authority = before;
  EXPECT_EQ(bench->ask(*op1, CMD_UNLOCK), Reason::stale_epoch);
}

TEST_F(Restore, AnAutonomousModeGoesOnAfterZero) {
  take_lock_and_go();
  bench->run(1s);
  ASSERT_GT(bench->command.vx, 0.1);
  crash();
  bench->run(60ms);
  EXPECT_THAT(bench->commands, only_zero()) << "zero until the conditions were looked at anew";
  bench->run(2s);
  EXPECT_EQ(op1->behaviour.mode(), "waypoint");
  EXPECT_GT(bench->command.vx, 0.1);
  EXPECT_THAT(notice(*op1, "restarted"), HasSubstr("held by op1, locked; was in waypoint, goal 1 kept"));
  EXPECT_THAT(notice(*op2, "restarted"), HasSubstr("held by op1"));
}

TEST_F(Restore, AnAutonomousModeWaitsForItsConditions) {
  take_lock_and_go();
  bench->lidar_alive = false;
  crash();
  bench->run(2s);
  EXPECT_EQ(op1->behaviour.mode(), "waypoint");
  EXPECT_FALSE(op1->behaviour.moving_allowed());
  EXPECT_THAT(bench->commands, only_zero());
  bench->lidar_alive = true;
  bench->run(2s);
  EXPECT_GT(bench->command.vx, 0.1);
}

TEST_F(Restore, HoldAfterRestartKeepsTheGoal) {
  begin(false);
  take_lock_and_go();
  crash();
  bench->run(2s);
  EXPECT_EQ(op1->behaviour.mode(), "hold");
  EXPECT_EQ(op1->behaviour.goal_state(), radio::GOAL_KEPT);
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_EQ(bench->ask(*op1, CMD_MODE, "waypoint"), Reason::none);
  bench->run(1s);
  EXPECT_GT(bench->command.vx, 0.1);
}

TEST_F(Restore, AfterARestartOfTheComputerItHolds) {
  begin(true, 1);
  take_lock_and_go();
  begin(true, 2);
  bench->commands.clear();
  bench->run(2s);
  EXPECT_EQ(op1->authority.holder(), "op1");
  EXPECT_EQ(op1->behaviour.mode(), "hold") << "odometry began anew";
  EXPECT_EQ(op1->behaviour.goal_state(), radio::GOAL_KEPT);
  EXPECT_THAT(bench->commands, only_zero());
}

TEST_F(Restore, AStartPoseReplacesTheStoredPlaceAndHolds) {
  take_lock_and_go();
  bench->run(1s);
  ASSERT_GT(bench->command.vx, 0.1);
  bench->params().start = {-3.0, 1.0, 0.0};
  bench->params().start_given = true;
  crash();
  bench->run(2s);
  EXPECT_NEAR(op1->state.x(), bench->pose.x - 3.0, 0.01);
  EXPECT_NEAR(op1->state.y(), bench->pose.y + 1.0, 0.01);
  EXPECT_EQ(op1->authority.holder(), "op1");
  EXPECT_EQ(op1->behaviour.mode(), "hold");
  EXPECT_EQ(op1->behaviour.goal_state(), radio::GOAL_KEPT);
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_THAT(notice(*op1, "restarted"), HasSubstr("its start says where it is"));
}

TEST_F(Restore, AStartPoseSurvivesADeathBeforeTheFirstReport) {
  take_lock_and_go();
  bench->run(1s);
  bench->params().start = {-3.0, 1.0, 0.0};
  bench->params().start_given = true;
  crash();
  bench->params().start_given = false;  // As its parent restarts it.
  bench->params().start = {};
  crash();
  bench->run(2s);
  EXPECT_NEAR(op1->state.x(), bench->pose.x - 3.0, 0.01);
  EXPECT_NEAR(op1->state.y(), bench->pose.y + 1.0, 0.01);
  EXPECT_EQ(op1->behaviour.mode(), "hold");
  EXPECT_THAT(bench->commands, only_zero());
}

TEST_F(Restore, AStartPoseThatCannotBeStoredIsRefused) {
  take_lock_and_go();
  bench->run(1s);
  bench->stop_agent();
  bench->params().start = {-3.0, 1.0, 0.0};
  bench->params().start_given = true;
  disk->set_full(true);
  EXPECT_THAT([&] { bench->start_agent(); },
              testing::ThrowsMessage<std::runtime_error>(
                  testing::AllOf(HasSubstr("cannot replace the stored place: "), HasSubstr("--state"))));
  disk->set_full(false);
  bench->params().start_given = false;
  crash();
  bench->run(2s);
  // It drives on to its goal, and its last report is up to 0.2 s old.
  EXPECT_NEAR(op1->state.x(), bench->pose.x, 0.5) << "the former place is still stored";
  EXPECT_EQ(op1->authority.holder(), "op1");
}

TEST_F(Restore, AManualModeFallsToHold) {
  ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
  bench->stream(*op1, 0, 300ms);
  bench->send(*op1, CMD_MODE, "manual");
  bench->stream(*op1, 0, 200ms);
  bench->stream(*op1, 0.5, 1s);
  ASSERT_EQ(op1->behaviour.mode(), "manual");
  ASSERT_GT(bench->command.vx, 0.1);
  crash();
  bench->stream(*op1, 0.5, 2s);  // the stick is still pushed
  EXPECT_EQ(op1->behaviour.mode(), "hold");
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_EQ(op1->authority.holder(), "op1");
}

TEST_F(Restore, AStopSurvivesAndNothingMovesUntilItsStopperIsHeard) {
  take_lock_and_go();
  bench->run(500ms);
  ASSERT_EQ(bench->ask(*op2, CMD_STOP), Reason::none);
  crash();
  bench->run(3s);
  EXPECT_TRUE(op1->behaviour.stopped());
  ASSERT_EQ(op1->authority.stops().size(), 1u);
  EXPECT_EQ(op1->authority.stops()[0].station(), "op2");
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_EQ(bench->ask(*op1, CMD_RESET), Reason::stop_of_another);
  EXPECT_EQ(bench->ask(*op1, CMD_RESET, "", 0, 0, true), Reason::none);
  bench->run(2s);
  EXPECT_EQ(op1->behaviour.mode(), "hold") << "a reset moves nothing";
  EXPECT_EQ(op1->behaviour.goal_state(), radio::GOAL_KEPT);
}

TEST_F(Restore, ARepeatOverTheRestartGetsItsFirstAnswerAndHasNoSecondEffect) {
  take_lock_and_go();
  const radio::Command first = bench->last_command;
  ASSERT_EQ(bench->ask(*op1, CMD_MODE, "hold"), Reason::none);
  crash();
  bench->run(1s);
  op1->answers.clear();
  (void)op1->command.write(first);
  bench->run(300ms);
  ASSERT_EQ(op1->answers.size(), 1u);
  EXPECT_TRUE(op1->answers[0].accepted());
  EXPECT_EQ(op1->answers[0].seq(), first.seq());
  EXPECT_EQ(op1->answers[0].epoch(), op1->authority.epoch()) << "what is in force, not what was";
  bench->run(1s);
  EXPECT_EQ(op1->behaviour.mode(), "hold");
}

TEST_F(Restore, ANumberBelowThoseRememberedIsTooOld) {
  ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
  const radio::Command first = bench->last_command;
  for (int i = 0; i < 12; ++i) ASSERT_EQ(bench->ask(*op1, i % 2 == 0 ? CMD_LOCK : CMD_UNLOCK), Reason::none);
  ASSERT_EQ(bench->ask(*op1, CMD_RELEASE), Reason::none);
  crash();
  bench->run(1s);
  op1->answers.clear();
  (void)op1->command.write(first);
  bench->run(300ms);
  ASSERT_EQ(op1->answers.size(), 1u);
  EXPECT_EQ(static_cast<Reason>(op1->answers[0].reason()), Reason::stale_sequence);
  EXPECT_EQ(op1->authority.holder(), "") << "not taken a second time";
}

TEST_F(Restore, AnUnacknowledgedCommandMayBeLost) {
  ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
  // Dies within the write: neither acknowledged nor done.
  bench->send(*op2, CMD_TAKE);
  bench->run(2ms);
  const std::size_t answers = op2->answers.size();
  crash();
  bench->run(1s);
  EXPECT_EQ(op2->answers.size(), answers);
  EXPECT_EQ(op1->authority.holder(), "op1");
}

TEST_F(Restore, EveryAcknowledgedTakeSurvivesADeathAtOnce) {
  for (int i = 0; i < 6; ++i) {
    AgentBench::Operator& op = i % 2 == 0 ? *op1 : *op2;
    const std::uint64_t seq = bench->send(op, CMD_TAKE);
    const auto answered = [&] {
      const auto& last = op.answers;
      return !last.empty() && last.back().seq() == seq && last.back().station_id() == op.id;
    };
    for (int ms = 0; ms < 300 && !answered(); ++ms) bench->run(1ms);
    ASSERT_TRUE(answered() && op.answers.back().accepted());
    crash();
    bench->run(1s);
    ASSERT_EQ(op.authority.holder(), op.name) << "acknowledged, and lost: " << i;
  }
}

TEST_F(Restore, AStopIsZeroAtOnceWhateverTheDiskDoes) {
  take_lock_and_go();
  bench->run(1s);
  ASSERT_GT(bench->command.vx, 0.1);
  disk->set_full(true);
  bench->send(*op2, CMD_STOP);
  bench->run(2ms);
  EXPECT_EQ(bench->command, Twist2{}) << "before it is on disk";
}

TEST_F(Restore, AFullDiskIsReportedAndCommandsAreStillExecuted) {
  const auto store_is_healthy = [&] {
    for (const auto& part : op1->health.components())
      if (part.name() == "store") return part.healthy();
    return false;
  };
  bench->run(2s);
  EXPECT_TRUE(store_is_healthy());
  disk->set_full(true);
  EXPECT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
  EXPECT_EQ(bench->ask(*op1, CMD_GOTO, "", 30, 0), Reason::none);
  EXPECT_THAT(op2->notice_codes(), Contains("store_failing"));
  EXPECT_EQ(std::count(op2->notices.begin(), op2->notices.end(), op2->notices.front()), 1);
  EXPECT_FALSE(store_is_healthy());
  crash();
  bench->run(2s);
  EXPECT_EQ(op1->authority.holder(), "") << "the state of before the full disk would be a guess";
  EXPECT_EQ(op1->behaviour.mode(), "hold");
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_THAT(op1->notice_codes(), Contains("state_lost"));
}

// Rule 7: a stop before the loss must not be lost with it.
TEST_F(Restore, AfterALostStateTheRobotIsStoppedUntilAReset) {
  ASSERT_EQ(bench->ask(*op2, CMD_STOP), Reason::none);
  disk->set_full(true);
  ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);  // The state can no longer be written.
  crash();
  bench->run(2s);
  ASSERT_THAT(op1->notice_codes(), Contains("state_lost"));
  EXPECT_TRUE(op1->behaviour.stopped());
  disk->set_full(false);
  EXPECT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
  EXPECT_EQ(bench->ask(*op1, CMD_GOTO, "", 30, 0), Reason::stopped);
  bench->run(1s);
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_EQ(bench->ask(*op1, CMD_RESET, "", 0, 0, true), Reason::none);
  EXPECT_EQ(bench->ask(*op1, CMD_GOTO, "", 30, 0), Reason::none);
}

TEST_F(Restore, ACorruptStateIsHoldWithoutHolder) {
  take_lock_and_go();
  for (const store::Bytes& junk : {store::Bytes{}, store::Bytes(300, 0), store::Bytes(300, 'j')}) {
    bench->stop_agent();
    disk->plant("state", junk);
    crash();
    bench->run(1s);
    EXPECT_EQ(op1->authority.holder(), "");
    EXPECT_FALSE(op1->authority.locked());
    EXPECT_EQ(op1->behaviour.mode(), "hold");
    EXPECT_THAT(bench->commands, only_zero());
    EXPECT_THAT(notice(*op1, "state_lost"), HasSubstr("its state was lost"));
    EXPECT_THAT(op1->notice_codes(), Not(Contains("restarted")));
  }
}

TEST_F(Restore, APowerCutAtAnyMomentLeavesTheOldOrTheNewHolder) {
  for (std::uint64_t step = 0; step < 400; step += 23) {
    disk = std::make_shared<store::MemoryDisk>(step + 1);
    begin(true);
    ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
    disk->cut_power_after(step);
    bench->send(*op2, CMD_TAKE);
    bench->run(20ms);
    bench->stop_agent();
    disk->cut_power();
    disk->power_up();
    crash();
    bench->run(1s);
    EXPECT_THAT(op1->authority.holder(), testing::AnyOf("op1", "op2")) << "step " << step;
    EXPECT_THAT(op1->notice_codes(), Contains("restarted")) << "step " << step;
  }
}

TEST_F(Restore, WithoutADiskItIsAFirstStartEachTime) {
  disk.reset();
  begin(true);
  take_lock_and_go();
  crash();
  bench->run(1s);
  EXPECT_EQ(op1->authority.holder(), "");
  EXPECT_THAT(op1->notice_codes(), Not(Contains("state_lost")));
}

TEST_F(Restore, ACommandWithAnOverlongStationNameCostsNothingOverARestart) {
  take_lock_and_go();
  ASSERT_EQ(bench->ask(*op2, CMD_STOP), Reason::none);
  AgentBench::Operator& stranger = bench->join("op3");
  bench->run(1s);
  stranger.name = "no name";
  EXPECT_EQ(bench->ask(stranger, CMD_STOP), Reason::bad_argument);
  stranger.name = std::string(40, 'x');
  EXPECT_EQ(bench->ask(stranger, CMD_TAKE), Reason::bad_argument);
  ASSERT_EQ(bench->ask(*op2, CMD_STOP), Reason::none);  // accepted, so the answers are written again
  crash();
  bench->run(1s);
  EXPECT_EQ(op1->authority.holder(), "op1");
  EXPECT_TRUE(op1->authority.locked());
  EXPECT_EQ(op1->authority.stops().size(), 1u);
  EXPECT_THAT(op1->notice_codes(), Not(Contains("state_lost")));
}

TEST_F(Restore, DamagedStopsAreReportedAndHoldTheRobot) {
  take_lock_and_go();
  bench->stop_agent();
  store::Bytes file = *disk->read("state").value();
  auto list = store::unpack_sections(std::span(file).subspan(24));
  ASSERT_TRUE(list.readable);
  std::erase_if(list.good, [](const store::Section& s) { return store::tag_text(s.tag) == "STOP"; });
  disk->plant("state", store::encode_envelope(kSnapshotFormat, 99, store::pack_sections(list.good)));
  crash();
  bench->run(3s);
  EXPECT_EQ(op1->authority.holder(), "op1") << "it was not damaged";
  EXPECT_TRUE(op1->authority.locked());
  EXPECT_THAT(notice(*op1, "state_damaged"), HasSubstr("r1 holds: its state was damaged (lost: stops)"));
  EXPECT_THAT(notice(*op2, "state_damaged"), HasSubstr("stops"));
  EXPECT_EQ(op1->behaviour.mode(), "hold");
  EXPECT_TRUE(op1->behaviour.stopped()) << "somebody may have stopped it";
  EXPECT_THAT(bench->commands, only_zero());
  EXPECT_TRUE(disk->read("state.damaged").value());
  EXPECT_EQ(bench->ask(*op1, CMD_RESET, "", 0, 0, true), Reason::none);
  bench->run(1s);
  EXPECT_THAT(bench->commands, only_zero()) << "a reset moves nothing";
  EXPECT_EQ(bench->ask(*op1, CMD_MODE, "waypoint"), Reason::none);
  bench->run(1s);
  EXPECT_GT(bench->command.vx, 0.1) << "the goal was not damaged";
}

TEST_F(Restore, AQuestionIsNotWritten) {
  take_lock_and_go();
  ASSERT_EQ(bench->ask(*op2, CMD_STOP), Reason::none);
  bench->run(1s);  // it stands: its place is not written either
  const auto before = disk->steps();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(bench->ask(*op2, CMD_QUERY), Reason::none);
  EXPECT_EQ(disk->steps(), before) << "no write, no sync";
}

TEST_F(Restore, ARepeatedTakeHasNoEffectAfterARestart) {
  ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
  ASSERT_EQ(bench->ask(*op1, CMD_TAKE), Reason::none);
  const radio::Command last = bench->last_command;
  crash();
  bench->run(1s);
  ASSERT_EQ(bench->ask(*op2, CMD_TAKE), Reason::none);
  op1->answers.clear();
  (void)op1->command.write(last);
  bench->run(300ms);
  ASSERT_EQ(op1->answers.size(), 1u);
  EXPECT_TRUE(op1->answers[0].accepted()) << "its first answer";
  EXPECT_EQ(op1->authority.holder(), "op2");
}

TEST_F(Restore, TheRobotsIdentityStays) {
  const auto id = op1->capabilities.id();
  crash();
  bench->run(1s);
  EXPECT_EQ(op1->capabilities.id(), id);
}

}  // namespace
}  // namespace adit::agent
