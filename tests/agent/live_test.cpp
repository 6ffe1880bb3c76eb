// The agent as a process over Fast DDS, on loopback.
#include <gmock/gmock.h>
#include <signal.h>

#include <atomic>
#include <fstream>

#include "core/exec/live_runtime.hpp"
#include "core/wire/fastdds/fastdds_wire.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "tests/live/process.hpp"

namespace adit::agent {
namespace {

/// Counts the commands that a driver gets.
class CountingDriver {
 public:
  explicit CountingDriver(unsigned domain) {
    wire::FastDdsParams params{};
    params.domain = domain;
    params.name = "driver";
    wire_ = wire::open_fastdds(params).value();
    reader_ = wire::make_reader(*wire_, wire::topics::cmd_vel, *strand_,
                                [this](const geometry_msgs::msg::Twist& t, const wire::SampleInfo&) {
                                  if (t.linear().x() != 0.0 || t.angular().z() != 0.0) moved = true;
                                  ++count;
                                })
                  .value();
  }
  ~CountingDriver() {
    reader_.reset();
    strand_.reset();
  }
  bool hears(int more) {
    const int wanted = count + more;
    return live::eventually([&] { return count >= wanted; });
  }
  std::atomic<int> count{0};
  std::atomic<bool> moved{false};

 private:
  LiveRuntime runtime_{};
  std::shared_ptr<Executor> strand_{runtime_.strand("driver")};
  std::unique_ptr<wire::Wire> wire_{};
  std::unique_ptr<wire::RawReader> reader_{};
};

std::vector<pid_t> children_of(pid_t pid) {
  const std::string id = std::to_string(pid);
  std::ifstream file("/proc/" + id + "/task/" + id + "/children");
  std::vector<pid_t> all;
  for (pid_t child{}; file >> child;) all.push_back(child);
  return all;
}

class LiveAgent : public testing::Test {
 protected:
  std::vector<std::string> command(std::vector<std::string> more = {}) {
    std::vector<std::string> words{"robot_agent",
                                   "--config",
                                   "robots/r1.yaml",
                                   "--domain",
                                   std::to_string(live::domain(0)),
                                   "--robot-domain",
                                   std::to_string(live::domain(1))};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  live::Folder folder{};
};

TEST_F(LiveAgent, ParentSendsZeroWhenItsAgentDiesAndStartsItAgain) {
  CountingDriver driver(live::domain(1));
  live::Process parent(command({"--supervised"}), folder.environment());
  ASSERT_TRUE(driver.hears(40)) << parent.err();
  const auto first = children_of(parent.pid());
  ASSERT_EQ(first.size(), 1u);
  ::kill(first[0], SIGKILL);
  EXPECT_TRUE(driver.hears(5));
  EXPECT_TRUE(live::eventually([&] {
    const auto next = children_of(parent.pid());
    return next.size() == 1 && next[0] != first[0];
  }));
  EXPECT_TRUE(driver.hears(40));
  EXPECT_FALSE(driver.moved);
  parent.signal(SIGTERM);
  EXPECT_EQ(parent.wait(live::Seconds(10)).exit_code, 0);
  EXPECT_TRUE(live::eventually([&] { return children_of(parent.pid()).empty(); }));
}

TEST_F(LiveAgent, ConsoleAnswersAndCtrlCIsClean) {
  live::Process agent(command(), folder.environment());
  ASSERT_TRUE(live::eventually([&] {
    return live::run({"robot_agent", "console", "status", "--name", "r1"}, folder.environment())
               .out.find("held by nobody") != std::string::npos;
  })) << agent.err();
  const auto unlocked = live::run({"robot_agent", "console", "unlock", "--name", "r1"}, folder.environment());
  EXPECT_EQ(unlocked.out, "there was no lock\n");
  const auto second = live::run(command(), folder.environment());
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.err, testing::HasSubstr("runs on this machine already"));
  agent.signal(SIGINT);
  EXPECT_EQ(agent.wait(live::Seconds(10)).exit_code, 0);
}

TEST_F(LiveAgent, WrongUsageIsOneLineAndExitTwo) {
  const auto bad = [&](std::vector<std::string> words, const char* message) {
    const auto done = live::run(std::move(words), folder.environment());
    EXPECT_EQ(done.exit_code, 2) << done.err;
    EXPECT_THAT(done.err, testing::HasSubstr(message));
  };
  bad({"robot_agent"}, "--config");
  bad({"robot_agent", "--config", "robots/r9.yaml"}, "r9.yaml");
  bad({"robot_agent", "--fly"}, "--fly");
  bad(command({"--name", "no good"}), "name");
  bad({"robot_agent", "--config", folder.write("r.yaml", "name: r1\nplatform: wheeled\ncolour: red\n")},
      ":3");
  const auto help = live::run({"robot_agent", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, testing::HasSubstr("Examples"));
}

}  // namespace
}  // namespace adit::agent
