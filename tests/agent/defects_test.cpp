// Linked with adit::agent_defects: each rule can be broken on purpose, and is kept otherwise.
#include <gmock/gmock.h>

#include "tests/agent/command_bench.hpp"

namespace adit::agent {
namespace {

CommandBench with(Defect defect) {
  CommandParams params{};
  params.defects.active = defect;
  return CommandBench(params);
}

TEST(Defects, EveryOneHasAName) {
  for (const auto& [name, defect] : kDefectNames) EXPECT_EQ(defect_from_name(name), defect);
  EXPECT_FALSE(defect_from_name("fly"));
}

TEST(Defects, AcceptWithoutEpoch) {
  auto bench = with(Defect::accept_without_epoch);
  bench.say("op1", "take");
  Command c = bench.command("op1", "lock");
  c.epoch.counter += 7;
  EXPECT_TRUE(bench.send(c).accepted());
}

TEST(Defects, RepeatDoneTwice) {
  auto bench = with(Defect::repeat_done_twice);
  const Command take = bench.command("op1", "take");
  bench.send(take);
  bench.say("op2", "take");
  bench.send(take);
  EXPECT_EQ(bench.interface().authority().holder_name(), "op1");
}

TEST(Defects, ObeyStranger) {
  auto bench = with(Defect::obey_stranger);
  bench.say("op1", "take");
  EXPECT_TRUE(bench.say("op2", "mode hold").accepted());
  EXPECT_FALSE(bench.interface().handle(bench.stick("op2", {1, 0, 0}), bench.now));
}

TEST(Defects, IgnoreLock) {
  auto bench = with(Defect::ignore_lock);
  bench.say("op1", "take");
  bench.say("op1", "lock");
  EXPECT_TRUE(bench.say("op2", "take").accepted());
}

TEST(Defects, SilentRefusal) {
  auto bench = with(Defect::silent_refusal);
  EXPECT_FALSE(bench.interface().handle(bench.command("op1", "lock"), bench.now));
}

TEST(Defects, StopNeedsHolder) {
  auto bench = with(Defect::stop_needs_holder);
  EXPECT_FALSE(bench.say("op1", "stop").accepted());
}

TEST(Defects, JoystickClearsStop) {
  auto bench = with(Defect::joystick_clears_stop);
  bench.say("op1", "take");
  bench.say("op1", "stop");
  (void)bench.interface().handle(bench.stick("op1"), bench.now);
  EXPECT_FALSE(bench.interface().stops().any());
}

TEST(Defects, MoveOnReset) {
  auto bench = with(Defect::move_on_reset);
  bench.say("op1", "take");
  bench.say("op1", "stop");
  bench.say("op1", "reset");
  EXPECT_THAT(bench.requests.calls, testing::Contains("resume"));
}

}  // namespace
}  // namespace adit::agent
