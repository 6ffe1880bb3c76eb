// SPDX-License-Identifier: Apache-2.0
// An agent that is killed, and components that crash and hang, in the programs as they are shipped. How long
// it takes, fifty times each: bench_failures.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "tests/live/failure_lab.hpp"

namespace adit::live {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

class Killed : public testing::TestWithParam<const char*> {};

TEST_P(Killed, ZeroAtTheDriverAtOnceAndBackWithItsHolder) {
  double zero = kNever, back = kNever;  // the shortest, ms
  for (int i = 0; i < max_measurements() && (zero >= 300.0 || back >= 2000.0); ++i) {
    FailureLab lab;
    ASSERT_TRUE(lab.ready()) << lab.err();
    ASSERT_TRUE(lab.enter(GetParam()));
    const auto killed = lab.kill_agent();
    ASSERT_TRUE(killed.zero && killed.back) << lab.err();
    zero = std::min(zero, *killed.zero);
    back = std::min(back, *killed.back);
    EXPECT_EQ(killed.moved, 0);
  }
  EXPECT_LT(zero, 300.0);
  EXPECT_LT(back, 2000.0);
}
INSTANTIATE_TEST_SUITE_P(Modes, Killed, testing::Values("hold", "manual", "smart_joystick", "waypoint"));

TEST(Components, ACrashIsBackSoonAndAHangIsFoundWithinASecond) {
  FailureLab lab;
  ASSERT_TRUE(lab.ready()) << lab.err();
  for (const std::string component : {"planner", "router", "sensors", "command"}) {
    double back = kNever;  // the shortest, ms
    for (int i = 0; i < max_measurements() && back >= 500.0; ++i) {
      if (i > 0) {
        lab.console("restart " + component);  // resets the count of attempts
        ASSERT_TRUE(lab.ready()) << lab.err();
      }
      const auto crashed = lab.crash(component);
      ASSERT_TRUE(crashed.told && crashed.back) << component << ": " << lab.err();
      back = std::min(back, *crashed.back);
    }
    EXPECT_LT(back, 500.0) << component;
  }
  double found = kNever;  // the shortest, ms
  for (int i = 0; i < max_measurements() && found >= 1500.0; ++i) {
    if (i > 0) {
      ASSERT_TRUE(lab.fresh_agent() && lab.ready()) << lab.err();  // a second hang would end it
    }
    const pid_t before = lab.agent();
    const auto hung = lab.hang("planner");
    ASSERT_TRUE(hung.told && hung.back) << lab.err();
    found = std::min(found, *hung.told);
    EXPECT_EQ(lab.agent(), before) << "the process goes on without that thread";
    EXPECT_THAT(lab.console("health"), testing::HasSubstr("hung 1"));
  }
  EXPECT_LT(found, 1500.0);
}

TEST(Components, AHungCommandStrandEndsTheAgentWhichComesBack) {
  double found = kNever;  // the shortest, ms
  for (int i = 0; i < max_measurements() && found >= 1500.0; ++i) {
    FailureLab lab;
    ASSERT_TRUE(lab.ready()) << lab.err();
    ASSERT_TRUE(lab.enter("waypoint")) << lab.err() << lab.console("health");
    const pid_t before = lab.agent();
    const auto hung = lab.hang("command");
    ASSERT_TRUE(hung.told && hung.back) << lab.err();
    found = std::min(found, *hung.told);
    EXPECT_NE(lab.agent(), before);
  }
  EXPECT_LT(found, 1500.0);
}

TEST(Components, AHungAgentEndsWithItsParentAndLeavesNothing) {
  FailureLab lab;
  ASSERT_TRUE(lab.ready()) << lab.err();
  ASSERT_TRUE(lab.hang("sensors").told);
  ASSERT_TRUE(lab.kill_agent().back);
  ASSERT_TRUE(lab.hang("planner").told);
  EXPECT_EQ(lab.end(), 0);
  for (const auto& entry : std::filesystem::directory_iterator(lab.folder().path() + "/adit"))
    EXPECT_FALSE(entry.is_socket()) << entry.path();
}

TEST(Memory, StaysBoundedWhileSensorsHangAndLargeCloudsArrive) {
  // ADIT_HUNG_SECONDS: how long clouds of the size of a lidar with 64 rings arrive, s. Otherwise they are the
  // largest that a socket of Linux's default size holds: of larger ones nearly none arrives on a busy
  // machine. 50 of these are twice the growth below.
  const char* seconds = std::getenv("ADIT_HUNG_SECONDS");
  const Duration time = seconds ? from_seconds(std::stod(seconds)) : 6s;
  const std::size_t cloud = seconds ? 1'600'000 : 300'000;  // bytes
  FailureLab lab;
  ASSERT_TRUE(lab.ready()) << lab.err();
  const auto hung = lab.stay_hung("sensors", cloud, time);
  ASSERT_TRUE(hung) << lab.err();
  std::printf("resident %.1f MB, growth %.1f MB, %d clouds\n", hung->megabytes, hung->growth, hung->clouds);
  EXPECT_LT(hung->megabytes, 200.0);
  EXPECT_LT(hung->growth, 8.0);
  EXPECT_GE(hung->clouds, 50) << "too few arrive to show anything";
}

}  // namespace
}  // namespace adit::live
