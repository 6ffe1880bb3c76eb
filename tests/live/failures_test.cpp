// An agent that is killed, and components that crash and hang, in the programs as they are shipped. How long
// it takes, fifty times each: bench_failures.
#include <gmock/gmock.h>

#include <filesystem>
#include <set>

#include "tests/live/failure_lab.hpp"

namespace adit::live {
namespace {

/// Files of shared memory that a process has open.
void add_shared_memory(pid_t process, std::set<std::string>& names) {
  std::error_code gone;
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/fd", gone)) {
    const auto target = std::filesystem::read_symlink(entry.path(), gone).string();
    if (target.starts_with("/dev/shm/fastrtps_")) names.insert(target);
  }
}

class Killed : public testing::TestWithParam<const char*> {};

TEST_P(Killed, ZeroAtTheDriverAtOnceAndBackWithItsHolder) {
  FailureLab lab;
  ASSERT_TRUE(lab.ready()) << lab.err();
  ASSERT_TRUE(lab.enter(GetParam()));
  const auto killed = lab.kill_agent();
  ASSERT_TRUE(killed.zero) << lab.err();
  EXPECT_LT(*killed.zero, 300.0);
  ASSERT_TRUE(killed.back) << lab.err();
  EXPECT_LT(*killed.back, 2000.0);
  EXPECT_EQ(killed.moved, 0);
}
INSTANTIATE_TEST_SUITE_P(Modes, Killed, testing::Values("hold", "manual", "smart_joystick", "waypoint"));

TEST(Components, ACrashIsBackSoonAndAHangIsFoundWithinASecond) {
  FailureLab lab;
  ASSERT_TRUE(lab.ready()) << lab.err();
  for (const char* component : {"planner", "sensors", "command"}) {
    const auto crashed = lab.crash(component);
    ASSERT_TRUE(crashed.told && crashed.back) << component << ": " << lab.err();
    EXPECT_LT(*crashed.back, 500.0) << component;
  }
  const pid_t before = lab.agent();
  const auto hung = lab.hang("planner");
  ASSERT_TRUE(hung.told && hung.back) << lab.err();
  EXPECT_LT(*hung.told, 1500.0);
  EXPECT_EQ(lab.agent(), before) << "the process goes on without that thread";
  EXPECT_THAT(lab.console("health"), testing::HasSubstr("hung 1"));
}

TEST(Components, AHungCommandStrandEndsTheAgentWhichComesBack) {
  FailureLab lab;
  ASSERT_TRUE(lab.ready()) << lab.err();
  ASSERT_TRUE(lab.enter("waypoint"));
  const pid_t before = lab.agent();
  const auto hung = lab.hang("command");
  ASSERT_TRUE(hung.told && hung.back) << lab.err();
  EXPECT_LT(*hung.told, 1500.0);
  EXPECT_NE(lab.agent(), before);
}

TEST(Components, AHungAgentEndsWithItsParentAndLeavesNothing) {
  std::set<std::string> used;
  {
    FailureLab lab;
    ASSERT_TRUE(lab.ready()) << lab.err();
    ASSERT_TRUE(lab.hang("sensors").told);
    add_shared_memory(lab.agent(), used);
    ASSERT_TRUE(lab.kill_agent().back);
    add_shared_memory(lab.agent(), used);
    ASSERT_TRUE(lab.hang("planner").told);
    EXPECT_EQ(lab.end(), 0);
    for (const auto& entry : std::filesystem::directory_iterator(lab.folder().path() + "/adit"))
      EXPECT_FALSE(entry.is_socket()) << entry.path();
  }
  EXPECT_GE(used.size(), 2u);
  for (const auto& name : used) EXPECT_FALSE(std::filesystem::exists(name)) << "left behind: " << name;
}

}  // namespace
}  // namespace adit::live
