// SPDX-License-Identifier: Apache-2.0
// Robots and operators on machines of their own: addresses, thin links, cables pulled.
#include "tests/hosts/hosts.hpp"

#include <gmock/gmock.h>
#include <signal.h>

#include <nlohmann/json.hpp>

namespace adit::hosts {
namespace {

using live::eventually;
using live::Finished;
using live::Process;
using live::Seconds;
using Clock = std::chrono::steady_clock;

class HostsTest : public testing::Test {
 protected:
  void SetUp() override {
    static const std::string why = Hosts::refused();
    if (!why.empty()) GTEST_SKIP() << "no network namespaces here (they need root): " << why;
    hosts_ = std::make_unique<Hosts>();
    hosts_->add("robot", "10.77.0.1");
    hosts_->add("base", "10.77.0.2");
  }
  /// `peers` empty: by multicast.
  Process agent(const std::vector<std::string>& peers = {}) {
    std::string text = "name: r1\nplatform: wheeled\nrobot_domain: 1\nradio:\n  interfaces: [" +
                       hosts_->address("robot") + "]\n";
    if (!peers.empty()) {
      text += "  multicast: false\n  peers: [";
      for (const std::string& peer : peers) text += peer + (&peer == &peers.back() ? "]\n" : ", ");
    }
    Process process = hosts_->start("robot", {"robot_agent", "--config", folder_.write("r1.yaml", text)},
                                    folder_.environment());
    EXPECT_TRUE(process.wait_for_output("up on radio domain", Seconds(5))) << process.err();
    return process;
  }
  Process station(const std::vector<std::string>& peers = {}) {
    std::vector<std::string> words{"basestation", "--name", "op1", "--interface", hosts_->address("base")};
    for (const std::string& peer : peers) words.insert(words.end(), {"--peer", peer});
    words.emplace_back("--serve=1");
    Process process = hosts_->start("base", words, folder_.environment());
    // A command before the station is ready would start another one of that name, outside its host.
    EXPECT_TRUE(process.wait_for_output("ready", Seconds(10))) << process.err();
    return process;
  }
  /// A command of the operator, through his station's socket.
  Finished op(std::vector<std::string> words) {
    words.insert(words.begin(), {"basestation", "--name", "op1"});
    return live::run(words, folder_.environment());
  }
  nlohmann::json listed() {
    const auto list = nlohmann::json::parse(op({"--json", "list"}).out, nullptr, false);
    if (list.is_object())
      for (const auto& row : list.value("robots", nlohmann::json::array()))
        if (row.value("robot", "") == "r1") return row;
    return nlohmann::json::object();
  }
  bool present() { return !listed().value("lost", true); }
  /// Seconds until the station hears the robot; more than 10 s, stretched, when it did not.
  double until_present() {
    const auto begin = Clock::now();
    (void)eventually([&] { return present(); });
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }

  live::Folder folder_{};
  std::unique_ptr<Hosts> hosts_{};
};

TEST_F(HostsTest, FindEachOtherByMulticastOverAThinLink) {
  hosts_->shape("robot", 500);
  const Process base = station();
  const Process robot = agent();
  EXPECT_LT(until_present(), 3.0 * live::patience());
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"take", "r1"}, {"lock", "r1"}, {"stop", "r1"}, {"reset", "r1"}}) {
    const auto done = op(command);
    EXPECT_EQ(done.exit_code, 0) << command[0] << ": " << done.err;
  }
  EXPECT_TRUE(listed().value("mine", false));
}

TEST_F(HostsTest, FindEachOtherByAddressWithoutMulticast) {
  hosts_->shape("robot", 500);
  const Process base = station({"10.77.0.1"});
  const Process robot = agent({"10.77.0.2"});
  EXPECT_LT(until_present(), 3.0 * live::patience());
  EXPECT_EQ(op({"take", "r1"}).exit_code, 0);
}

TEST_F(HostsTest, ARobotBackUnderAnotherAddressIsFoundAgain) {
  const Process base = station();
  {
    Process robot = agent();
    ASSERT_LT(until_present(), 5.0 * live::patience());
    EXPECT_EQ(op({"take", "r1"}).exit_code, 0);
    robot.signal(SIGKILL);
    robot.wait(Seconds(5));
  }
  ASSERT_TRUE(eventually([&] { return listed().value("lost", false); }, Seconds(6)));
  hosts_->readdress("robot", "10.77.0.9");
  const Process back = agent();
  EXPECT_LT(until_present(), 3.0 * live::patience());
  EXPECT_EQ(op({"take", "r1"}).exit_code, 0);
  EXPECT_EQ(op({"stop", "r1"}).exit_code, 0);
}

TEST_F(HostsTest, ARobotBackUnderAnotherAddressFindsItsStationWithoutMulticast) {
  const Process base = station({"10.77.0.1"});
  {
    Process robot = agent({"10.77.0.2"});
    ASSERT_LT(until_present(), 5.0 * live::patience());
    robot.signal(SIGKILL);
    robot.wait(Seconds(5));
  }
  ASSERT_TRUE(eventually([&] { return listed().value("lost", false); }, Seconds(6)));
  hosts_->readdress("robot", "10.77.0.9");
  const Process back = agent({"10.77.0.2"});
  EXPECT_LT(until_present(), 3.0 * live::patience())
      << "the station's list has the old address: the robot asks it";
  EXPECT_EQ(op({"take", "r1"}).exit_code, 0);
}

TEST_F(HostsTest, CommandsWorkAgainAfterTheCableWasPulled) {
  hosts_->shape("robot", 500);
  const Process base = station();
  const Process robot = agent();
  ASSERT_LT(until_present(), 5.0 * live::patience());
  EXPECT_EQ(op({"take", "r1"}).exit_code, 0);
  for (const char* host : {"robot", "base"}) {
    hosts_->link(host, false);
    EXPECT_TRUE(eventually([&] { return listed().value("lost", false); }, Seconds(6))) << host;
    EXPECT_NE(op({"lock", "r1"}).exit_code, 0) << "nobody can have answered that";
    hosts_->link(host, true);
    EXPECT_LT(until_present(), 3.0 * live::patience()) << host;
    const auto locked = op({"lock", "r1"});
    EXPECT_EQ(locked.exit_code, 0) << host << ": " << locked.err;
    EXPECT_TRUE(listed().value("mine", false)) << "still the holder";
    EXPECT_EQ(op({"unlock", "r1"}).exit_code, 0);
  }
}

}  // namespace
}  // namespace adit::hosts
