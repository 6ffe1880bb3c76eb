// SPDX-License-Identifier: Apache-2.0
// A robot's agent is killed under its holder's hands, and comes back with what its disk kept.
#include <signal.h>

#include <fstream>

#include "tests/live/programs.hpp"

namespace adit::live {
namespace {

using testing::HasSubstr;

class Restart : public Programs {
 protected:
  pid_t child() const {
    const std::string id = std::to_string(parent_->pid());
    std::ifstream file("/proc/" + id + "/task/" + id + "/children");
    pid_t pid = 0;
    file >> pid;
    return pid;
  }
  void start() { parent_ = std::make_unique<Process>(words(), folder_.environment()); }
  /// Sends SIGKILL and waits until another agent runs.
  void kill_agent() {
    const pid_t old = child();
    ASSERT_GT(old, 0);
    told_before_ = driver_.told();
    ::kill(old, SIGKILL);
    ASSERT_TRUE(eventually([&] { return child() > 0 && child() != old; })) << parent_->err();
  }
  bool op1_again(const std::vector<std::string>& command) {
    return eventually([&] { return op("op1", command).exit_code == 0; });
  }
  nlohmann::json row() { return listed("op1", "r1"); }
  std::vector<std::string> words() const {
    return {"robot_agent", "--supervised",           "--config",       "robots/r1.yaml",
            "--domain",    std::to_string(domain()), "--robot-domain", std::to_string(domain(1))};
  }

  PlainDriver driver_{*net_};
  PlainDriver::Told told_before_{};
  std::unique_ptr<Process> parent_{};
};

TEST_F(Restart, HolderLockStopAndGoalAreBackAndNothingMoved) {
  start();
  ASSERT_TRUE(op1_again({"take", "r1"})) << parent_->err();
  ASSERT_EQ(op("op1", {"lock", "r1"}).exit_code, 0);
  ASSERT_TRUE(op1_again({"goto", "r1", "50", "0"}));
  ASSERT_TRUE(eventually([&] { return driver_.told().last > 0.1; }));
  ASSERT_EQ(op("op2", {"stop", "r1"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] { return driver_.told().last == 0.0; }));
  kill_agent();

  EXPECT_TRUE(
      eventually([&] { return row().value("mine", false) && !row().value("lost", true); }, Seconds(5)));
  EXPECT_TRUE(row().value("locked", false));
  const auto refused = op("op2", {"take", "r1"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("op1"));
  const auto reset = op("op1", {"reset", "r1"});
  EXPECT_EQ(reset.exit_code, 1);
  EXPECT_THAT(reset.err, HasSubstr("op2")) << "whose stop it still is";
  EXPECT_THAT(json("op1", {"status"}).dump(), HasSubstr("restarted"));
  EXPECT_EQ(driver_.told().moving, told_before_.moving) << "nothing moved by itself";

  ASSERT_EQ(op("op1", {"reset", "r1", "--override"}).exit_code, 0);
  ASSERT_TRUE(op1_again({"mode", "r1", "waypoint"}));
  EXPECT_TRUE(eventually([&] { return driver_.told().last > 0.1; })) << "the goal was kept";
}

TEST_F(Restart, AnAutonomousModeGoesOnByItself) {
  start();
  ASSERT_TRUE(op1_again({"take", "r1"})) << parent_->err();
  ASSERT_TRUE(op1_again({"goto", "r1", "80", "0"}));
  ASSERT_TRUE(eventually([&] { return driver_.told().last > 0.1; }));
  kill_agent();
  EXPECT_TRUE(eventually([&] { return driver_.told().last == 0.0; })) << "its parent sends zero";
  EXPECT_TRUE(eventually([&] { return driver_.told().last > 0.1; }));
  EXPECT_TRUE(op1_again({"mode", "r1", "hold"})) << "under the new epoch";
}

TEST_F(Restart, ATornStateIsHoldWithoutAHolder) {
  start();
  ASSERT_TRUE(op1_again({"take", "r1"})) << parent_->err();
  ASSERT_TRUE(op1_again({"goto", "r1", "80", "0"}));
  ASSERT_TRUE(eventually([&] { return driver_.told().last > 0.1; }));
  parent_->signal(SIGTERM);
  ASSERT_EQ(parent_->wait(Seconds(10)).exit_code, 0);
  const std::string state = folder_.environment().at("XDG_STATE_HOME") + "/adit/robot-r1/state";
  ASSERT_GT(std::filesystem::file_size(state), 30u);
  std::filesystem::resize_file(state, 30);
  const auto before = driver_.told();
  start();
  EXPECT_TRUE(
      eventually([&] { return json("op1", {"status"}).dump().find("state_lost") != std::string::npos; }));
  EXPECT_EQ(row().value("holder", "?"), "");
  EXPECT_EQ(driver_.told().moving, before.moving);
}

}  // namespace
}  // namespace adit::live
