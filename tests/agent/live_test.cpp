// SPDX-License-Identifier: Apache-2.0
// The agent as a process over Fast DDS, on loopback.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <set>

#include "core/exec/live_runtime.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
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
    reader_ = wire::make_reader(*wire_, wire::topics::kCmdVel, *strand_,
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
  std::unique_ptr<wire::Participant> wire_{};
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

long entries(pid_t pid, const char* folder) {
  std::error_code gone;  // counts as none
  const std::filesystem::directory_iterator all("/proc/" + std::to_string(pid) + "/" + folder, gone);
  return gone ? 0 : std::distance(begin(all), end(all));
}

/// Files in shared memory that the process has open.
long shared_files(pid_t pid) {
  long count = 0;
  std::error_code gone;
  for (const auto& fd : std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/fd", gone))
    count += std::filesystem::read_symlink(fd.path(), gone).string().starts_with("/dev/shm/") ? 1 : 0;
  return count;
}

TEST_F(LiveAgent, RestartsLeaveNothingBehind) {
  live::Process parent(command({"--supervised", "--good-run", "0"}), folder.environment());
  pid_t before = -1;
  const auto restarted = [&] {
    return live::eventually([&] {
      const auto child = children_of(parent.pid());
      if (child.size() != 1 || child[0] == before) return false;
      const auto health =
          live::run({"robot_agent", "console", "health", "--name", "r1"}, folder.environment());
      if (health.out.find("command    up") == std::string::npos) return false;
      before = child[0];
      return true;
    });
  };
  const auto restart = [&](int times) {
    for (int i = 0; i < times; ++i) {
      ::kill(before, SIGKILL);
      ASSERT_TRUE(restarted()) << parent.err();
    }
  };
  ASSERT_TRUE(restarted()) << parent.err();
  restart(2);
  const long files = entries(parent.pid(), "fd"), threads = entries(parent.pid(), "task");
  ASSERT_GT(files, 0);
  restart(4);
  EXPECT_TRUE(live::eventually([&] { return entries(parent.pid(), "fd") <= files; }))
      << entries(parent.pid(), "fd") << " files, " << files << " before four restarts";
  EXPECT_EQ(entries(parent.pid(), "task"), threads);
  EXPECT_EQ(shared_files(before), 0) << "who is killed leaves them behind";
}

TEST_F(LiveAgent, ATooSmallMemoryLimitNamesTheMinimumWhichWorks) {
  const auto refused = live::run(command({"--memory-limit", "15"}), folder.environment());
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  const std::size_t at = refused.err.find("at least ");
  ASSERT_NE(at, std::string::npos) << refused.err;
  const std::string least =
      refused.err.substr(at + 9, refused.err.find_first_not_of("0123456789", at + 9) - at - 9);
  EXPECT_LT(std::stoi(least), 100);
  live::Process parent(command({"--supervised", "--memory-limit", least}), folder.environment());
  const auto health = [&] {
    return live::run({"robot_agent", "console", "health", "--name", "r1"}, folder.environment()).out;
  };
  ASSERT_TRUE(live::eventually([&] { return health().find("command    up") != std::string::npos; }));
  const auto child = children_of(parent.pid());
  const auto bounded = [&] {
    std::ifstream limits("/proc/" + std::to_string(child.at(0)) + "/limits");
    for (std::string line; std::getline(limits, line);)
      if (line.starts_with("Max data size")) return line.find("unlimited") == std::string::npos;
    return false;
  };
  EXPECT_TRUE(live::eventually(bounded));
  EXPECT_THAT(health(), testing::HasSubstr("command    up"));
  EXPECT_EQ(children_of(parent.pid()), child) << parent.err();
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
