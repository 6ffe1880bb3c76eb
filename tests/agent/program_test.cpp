// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "robot_agent/program/console.hpp"
#include "robot_agent/program/parent.hpp"
#include "robot_agent/program/robot_config.hpp"
#include "robot_agent/program/service.hpp"
#include "tests/folders/folders.hpp"
#include "tests/live/process.hpp"

namespace adit::agent {
namespace {

using testing::HasSubstr;

TEST(RobotConfig, TheShippedOnesLoad) {
  for (const char* name : {"r1", "r2", "r3"}) {
    const auto config = load_robot_config(source_folder() + "/config/robots/" + name + ".yaml");
    ASSERT_TRUE(config) << config.error().text;
    EXPECT_EQ(config->name, name);
    EXPECT_TRUE(config->radio.interfaces.empty());
    EXPECT_EQ(config->lock_lease, 300s);
  }
}

TEST(RobotConfig, ATreeBesideTheFileComesFirst) {
  const live::Folder folder;
  const std::string tree = folder.write("oak.xml", "<root/>");
  const auto config =
      load_robot_config(folder.write("r.yaml", "name: r1\nplatform: wheeled\ntree: oak.xml\n"));
  ASSERT_TRUE(config) << config.error().text;
  EXPECT_EQ(config->tree, tree);
}

TEST(RobotConfig, AMissingTreeIsLeftToTheAgent) {
  const live::Folder folder;
  const auto config =
      load_robot_config(folder.write("r.yaml", "name: r1\nplatform: wheeled\ntree: oak.xml\n"));
  ASSERT_TRUE(config) << config.error().text;
  EXPECT_EQ(config->tree, "oak.xml");
}

TEST(RobotConfig, StateIsStoredInTheNamedOrTheDefaultFolder) {
  const live::Folder folder;
  const auto state = [&](const std::string& line) {
    return state_folder(
        load_robot_config(folder.write("r.yaml", "name: r1\nplatform: wheeled\n" + line)).value());
  };
  EXPECT_EQ(state("state: /data/r1\n"), "/data/r1");
  EXPECT_EQ(state("state: none\n"), "");
  ::setenv("XDG_STATE_HOME", "/somewhere", 1);
  EXPECT_EQ(state(""), "/somewhere/adit/robot-r1");
  ::unsetenv("XDG_STATE_HOME");
  EXPECT_THAT(state(""), HasSubstr("/adit/robot-r1"));
}

TEST(RobotConfig, TheRobotDomainIsOnLoopbackAndTheNamedInterfaces) {
  const live::Folder folder;
  const auto addresses = [&](const std::string& line) {
    const auto config = load_robot_config(folder.write("r.yaml", "name: r1\nplatform: wheeled\n" + line));
    EXPECT_TRUE(config) << config.error().text;
    return addresses_of(config->robot_interfaces);
  };
  EXPECT_THAT(addresses("").value(), testing::ElementsAre("127.0.0.1"));
  EXPECT_THAT(addresses("robot_interfaces: []\n").value(), testing::ElementsAre("127.0.0.1"));
  EXPECT_THAT(addresses("robot_interfaces: [lo]\n").value(), testing::ElementsAre("127.0.0.1"));
  const auto unknown = addresses("robot_interfaces:\n  - lo\n  - nosuch0\n");
  ASSERT_FALSE(unknown) << "another machine's file is read, but its robot domain is not opened";
  EXPECT_THAT(unknown.error().text, testing::AllOf(HasSubstr("r.yaml:"), HasSubstr("'nosuch0'")));
  EXPECT_THAT(addresses("robot_interfaces: [10.0.0.1]\n").error().text, HasSubstr("'10.0.0.1'"));
}

TEST(RobotConfig, TheRobotDomainIsOnEveryAddressOfAnInterface) {
  ifaddrs* all = nullptr;
  ASSERT_EQ(::getifaddrs(&all), 0);
  for (const ifaddrs* at = all; at != nullptr; at = at->ifa_next) {
    if (at->ifa_addr == nullptr || at->ifa_addr->sa_family != AF_INET) continue;
    if ((at->ifa_flags & IFF_RUNNING) == 0) continue;
    char text[INET_ADDRSTRLEN]{};
    (void)::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(at->ifa_addr)->sin_addr, text,
                      sizeof text);
    const auto addresses = addresses_of({{at->ifa_name}, "r.yaml:3"});
    ASSERT_TRUE(addresses) << addresses.error().text;
    EXPECT_THAT(*addresses, testing::AllOf(testing::Contains("127.0.0.1"), testing::Contains(text)));
  }
  ::freeifaddrs(all);
}

TEST(RobotConfig, TheStartHasAHeight) {
  const live::Folder folder;
  const auto height = [&](const std::string& line) {
    return load_robot_config(folder.write("r.yaml", "name: r1\nplatform: wheeled\n" + line))
        .value()
        .start_height;
  };
  EXPECT_EQ(height(""), std::nullopt);
  EXPECT_EQ(height("start_height: -3.5\n"), -3.5);
}

struct BadFile {
  const char* name;
  const char* text;
  const char* message;
};
class BadRobotFile : public testing::TestWithParam<BadFile> {};

TEST_P(BadRobotFile, IsOneLineWithPlace) {
  const live::Folder folder;
  const auto config = load_robot_config(folder.write("r.yaml", GetParam().text));
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().text, HasSubstr(GetParam().message));
  EXPECT_THAT(config.error().text, testing::Not(HasSubstr("\n")));
}

INSTANTIATE_TEST_SUITE_P(
    Config, BadRobotFile,
    testing::Values(
        BadFile{"unknown_key", "name: r1\nplatform: wheeled\ncolour: red\n", "r.yaml:3"},
        BadFile{"missing_name", "platform: wheeled\n", "name"},
        BadFile{"bad_name", "name: r 1\nplatform: wheeled\n", "r.yaml:1"},
        BadFile{"name_all", "name: all\nplatform: wheeled\n", "not 'all'"},
        BadFile{"short_pose", "name: r1\nplatform: wheeled\npose: [1, 2]\n", "r.yaml:3"},
        BadFile{"unknown_platform", "name: r1\nplatform: hovercraft\n",
                "no 'hovercraft' in config/platforms; there are: aerial, car, legged, tracked, wheeled"},
        BadFile{"radio_key", "name: r1\nplatform: wheeled\nradio: {domian: 3}\n", "domian"},
        BadFile{"domain_range", "name: r1\nplatform: wheeled\nrobot_domain: 500\n", "r.yaml:3"},
        BadFile{"interfaces", "name: r1\nplatform: wheeled\nrobot_interfaces: [a b]\n", "r.yaml:3"},
        BadFile{"start_height", "name: r1\nplatform: wheeled\nstart_height: high\n", "r.yaml:3"},
        BadFile{"lease", "name: r1\nplatform: wheeled\nlock_lease: -1\n", "r.yaml:3"},
        BadFile{"link_loss", "name: r1\nplatform: wheeled\non_link_loss: cry\n", "r.yaml:3"},
        BadFile{"link_loss_after", "name: r1\nplatform: wheeled\nlink_loss_after: 0\n", "r.yaml:3"},
        BadFile{"battery", "name: r1\nplatform: wheeled\nbattery: {warning: 0.1}\n", "r.yaml:3"},
        BadFile{"at_last", "name: r1\nplatform: wheeled\nbattery: {at_last: fly}\n", "r.yaml:3"},
        BadFile{"after_restart", "name: r1\nplatform: wheeled\nafter_restart: go\n", "r.yaml:3"},
        BadFile{"memory", "name: r1\nplatform: wheeled\nmemory_limit: -1\n", "r.yaml:3"},
        BadFile{"log", "name: r1\nplatform: wheeled\nlog: loud\n", "r.yaml:3"}),
    [](const auto& each) { return each.param.name; });

class ConsoleTest : public testing::Test {
 protected:
  ConsoleTest() { ::setenv("XDG_RUNTIME_DIR", folder.path().c_str(), 1); }
  live::Folder folder{};
};

TEST_F(ConsoleTest, LineInAnswerOut) {
  auto console =
      Console::open("r1", [](const std::string& line, auto answer) { answer("got " + line + "\n"); });
  ASSERT_TRUE(console) << console.error().text;
  const auto answer = ask_console("r1", "unlock");
  ASSERT_TRUE(answer) << answer.error().text;
  EXPECT_EQ(*answer, "got unlock\n");
}

TEST_F(ConsoleTest, ARefusalIsAnErrorAndSoIsNoAnswer) {
  auto console = Console::open("r1", [](const std::string& line, auto answer) {
    if (line != "health") answer("refused: store is no component of the agent\n");
  });
  ASSERT_TRUE(console) << console.error().text;
  const auto refused = ask_console("r1", "restart store");
  ASSERT_FALSE(refused) << *refused;
  EXPECT_EQ(refused.error().text, "r1 refused: store is no component of the agent");
  EXPECT_NE(refused.reason(), Reason::no_answer);
  const auto silent = ask_console("r1", "health");
  ASSERT_FALSE(silent) << *silent;
  EXPECT_EQ(silent.reason(), Reason::no_answer);
}

TEST_F(ConsoleTest, OneAgentPerName) {
  const auto first = Console::open("r1", [](const auto&, auto) {});
  ASSERT_TRUE(first);
  EXPECT_EQ(Console::open("r1", [](const auto&, auto) {}).reason(), Reason::in_use);
  EXPECT_TRUE(Console::open("r2", [](const auto&, auto) {}));
}

TEST_F(ConsoleTest, AMissingAgentAndAnOpenFolderAreErrors) {
  EXPECT_EQ(ask_console("r9", "status").reason(), Reason::no_answer);
  ::chmod((folder.path() + "/adit").c_str(), 0755);
  EXPECT_EQ(ask_console("r9", "status").reason(), Reason::cannot_write);
}

class ParentTest : public testing::Test {
 protected:
  ParentTest() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGTERM);
    sigaddset(&set, SIGINT);
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
  }
  ParentParams shell(const std::string& script) {
    ParentParams params{};
    params.program = "/bin/sh";
    params.command = {"sh", "-c", script};
    params.first_restart = 150ms;
    return params;
  }
  live::Folder folder{};
  int zeros{}, prepared{};
};

TEST_F(ParentTest, KillsAChildThatFallsSilentAndRestartsIt) {
  const std::string mark = folder.path() + "/mark";
  ParentParams params =
      shell("if [ -e " + mark + " ]; then exit 0; fi; touch " + mark + "; echo -n 1 >&3; exec sleep 60");
  params.pulse = 300ms;
  Parent parent(
      params, [] {}, [&] { ++zeros; });
  const auto started = std::chrono::steady_clock::now();
  EXPECT_EQ(parent.run(), 0);
  EXPECT_LT(std::chrono::steady_clock::now() - started, 30s);  // not the 60 s of its sleep
  EXPECT_GE(zeros, 1);
}

TEST_F(ParentTest, KillsAChildThatNeverCommands) {
  const std::string mark = folder.path() + "/mark";
  ParentParams params = shell("if [ -e " + mark + " ]; then exit 0; fi; touch " + mark + "; exec sleep 60");
  params.start = 300ms;
  Parent parent(
      params, [] {}, [&] { ++zeros; });
  EXPECT_EQ(parent.run(), 0);
  EXPECT_GE(zeros, 5);
}

TEST_F(ParentTest, AChildThatPulsesIsLeftAlone) {
  ParentParams params = shell("for i in 1 2 3 4 5 6 7 8; do echo -n 1 >&3; sleep 0.1; done; exit 0");
  params.pulse = 500ms;
  Parent parent(
      params, [] {}, [] {});
  EXPECT_EQ(parent.run(), 0);
}

TEST(Service, NotifiesTheServiceManager) {
  const live::Folder folder;
  const std::string path = folder.path() + "/notify";
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_TRUE(Service(path).notify("WATCHDOG=1"));
  char got[32]{};
  EXPECT_EQ(::recv(fd, got, sizeof got, MSG_DONTWAIT), 10);
  EXPECT_STREQ(got, "WATCHDOG=1");
  ::close(fd);
}

TEST(Service, AMissingServiceManagerIsNoError) {
  EXPECT_FALSE(Service("").notify("READY=1"));
  EXPECT_FALSE(Service("/nowhere/at/all").notify("READY=1"));
  EXPECT_FALSE(Service("relative").notify("READY=1"));
  EXPECT_FALSE(Service(std::string(200, '/')).notify("READY=1"));
}

TEST_F(ParentTest, SendsZeroWhileNoChildCommandsAndRestarts) {
  // The first child dies; the second reports that it commands, and ends by itself.
  const std::string mark = folder.path() + "/mark";
  Parent parent(
      shell("if [ -e " + mark + " ]; then echo -n 1 >&3; exit 0; else touch " + mark +
            "; echo -n 1 >&3; exit 7; fi"),
      [&] { ++prepared; }, [&] { ++zeros; });
  EXPECT_EQ(parent.run(), 0);
  EXPECT_EQ(prepared, 1);
  EXPECT_GE(zeros, 3);  // at the death, and every 50 ms of the pause
}

TEST_F(ParentTest, PassesTheFirstArgumentsUntilAChildHasReported) {
  const std::string log = folder.path() + "/log";
  ParentParams params = shell("echo \"$@.\" >> " + log + "; case $(wc -l < " + log +
                              ") in 1) exit 7;; 2) echo -n 1 >&3; exit 7;; esac");
  params.command.push_back("sh");
  params.at_first = {"first"};
  Parent parent(
      params, [] {}, [] {});
  EXPECT_EQ(parent.run(), 0);
  std::ifstream file(log);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "first.\nfirst.\n.\n");
}

TEST_F(ParentTest, WrongUsageIsNotRestarted) {
  Parent parent(
      shell("exit 2"), [] {}, [&] { ++zeros; });
  EXPECT_EQ(parent.run(), 2);
  EXPECT_GE(zeros, 1);
}

TEST_F(ParentTest, SignalIsPassedOn) {
  Parent parent(
      shell("kill -TERM $PPID; exec tail -f /dev/null"), [] {}, [&] { ++zeros; });
  EXPECT_EQ(parent.run(), 0);
}

}  // namespace
}  // namespace adit::agent
