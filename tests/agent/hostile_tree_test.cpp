// SPDX-License-Identifier: Apache-2.0
// Trees that contradict the mode table break no rule, even unchecked.
#include <gmock/gmock.h>

#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/behaviour/tree_check.hpp"
#include "tests/rehearsal/hostile_trees.hpp"

namespace adit::agent {
namespace {

struct LastMotion : NavigationInput {
  void accept(MuxKey, const Motion& motion, Time) override { last = motion; }
  Motion last{};
};

class HostileTree : public testing::TestWithParam<std::string> {
 protected:
  HostileTree() { step(200ms); }

  /// The 20 Hz beat, with stick and program sent along while they are streaming. Whether anything passed.
  bool step(Duration time) {
    bool moved = false;
    for (const Time end = now + time; now < end;) {
      now += 50ms;
      if (streaming) (void)behaviour.stick(value, now);
      if (program) behaviour.program({0.5, 0, 0}, now);
      behaviour.tick(now);
      mux.step(now);
      moved = moved || nav.last != Motion{Stand{}};
    }
    return moved;
  }
  void stop_and_reset() {
    behaviour.stop_changed(true, now);
    EXPECT_EQ(nav.last, Motion{Stand{}}) << "zero within the call";
    EXPECT_FALSE(step(2s)) << "moves while a stop is set";
    for (const char* mode : {"manual", "smart_joystick", "waypoint", "external"})
      EXPECT_FALSE(behaviour.request_mode(mode, now)) << mode;
    EXPECT_FALSE(behaviour.request_goal({5, 1, 0}, now));
    EXPECT_FALSE(step(1s)) << "moves while a stop is set";
    behaviour.stop_changed(false, now);
    EXPECT_FALSE(step(2s)) << "moves after a reset that nobody followed by a request";
  }

  LastMotion nav{};
  Mux mux{nav};
  Facts facts{.driver_alive = true, .localised = true, .terrain_fresh = true};
  Behaviour behaviour{{},
                      Decider::load_unchecked(GetParam()).value(),
                      mux,
                      {[this](Time) { return facts; }, [](const Eigen::Vector2d&) { return true; }, {}, {}},
                      {[](const auto&...) {}, [] {}}};
  Time now{Duration{1h}};
  bool streaming{}, program{};
  Twist2 value{};
};

INSTANTIATE_TEST_SUITE_P(Trees, HostileTree, testing::ValuesIn(hostile_trees()),
                         [](const auto& each) { return tree_name(each.param); });

TEST_P(HostileTree, IsRefusedWithFileAndLine) {
  const auto checked = check_tree(GetParam());
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.reason(), Reason::tree_refused);
  EXPECT_THAT(checked.error().text,
              testing::MatchesRegex(".*" + tree_name(GetParam()) + "\\.xml:[0-9]+: .*"));
}

TEST_P(HostileTree, MovesNothingUnasked) {
  streaming = program = true;
  EXPECT_FALSE(step(1s));
  value = {0.5, 0, 0};
  EXPECT_FALSE(step(1s));
  for (const char* mode : {"manual", "smart_joystick"})
    EXPECT_FALSE(behaviour.request_mode(mode, now)) << "the stick is pushed";
  EXPECT_FALSE(step(1s));
}

TEST_P(HostileTree, MovesNothingThroughAStop) {
  for (const char* mode : {"manual", "smart_joystick", "external"}) {
    streaming = program = true;
    value = {};
    step(200ms);
    (void)behaviour.request_mode(mode, now);
    value = {0.5, 0, 0};
    step(500ms);
    stop_and_reset();
  }
  (void)behaviour.request_goal({5, 1, 0}, now);
  step(500ms);
  stop_and_reset();
}

TEST_P(HostileTree, ManualModesEndWithoutAStick) {
  for (const char* mode : {"manual", "smart_joystick"}) {
    streaming = true;
    value = {};
    step(200ms);
    (void)behaviour.request_mode(mode, now);
    value = {0.5, 0, 0};
    step(500ms);
    streaming = false;
    step(350ms);
    EXPECT_FALSE(step(1s));
    EXPECT_EQ(behaviour.view().mode, "hold");
    streaming = true;
    EXPECT_FALSE(step(1s)) << "a stick that comes back pushed moves the robot";
  }
}

TEST_P(HostileTree, ManualModesEndWithTheirHolder) {
  for (const char* mode : {"manual", "smart_joystick"}) {
    streaming = true;
    value = {};
    step(200ms);
    (void)behaviour.request_mode(mode, now);
    value = {0.5, 0, 0};
    step(500ms);
    behaviour.holder_changed(now);
    EXPECT_FALSE(step(1s));
  }
}

TEST_P(HostileTree, ExternalEndsWithItsProgram) {
  program = true;
  step(200ms);
  (void)behaviour.request_mode("external", now);
  step(500ms);
  program = false;
  step(600ms);
  EXPECT_FALSE(step(1s));
  EXPECT_EQ(behaviour.view().mode, "hold");
  program = true;
  EXPECT_FALSE(step(1s)) << "a program that comes back moves the robot";
}

TEST_P(HostileTree, PassesNothingWhileSensorsAreSilent) {
  (void)behaviour.request_goal({5, 1, 0}, now);
  step(500ms);
  for (bool Facts::*fact : {&Facts::driver_alive, &Facts::localised, &Facts::terrain_fresh}) {
    facts.*fact = false;
    EXPECT_FALSE(step(1s));
    facts.*fact = true;
  }
}

}  // namespace
}  // namespace adit::agent
