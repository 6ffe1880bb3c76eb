// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/live/driver.hpp"
#include "tests/live/process.hpp"

namespace adit::live {

/// robot_agent and stations as processes, a driver and foreign participants in the test.
class Programs : public testing::Test {
 protected:
  ~Programs() override {
    for (const auto& name : used_) cli({"--name", name, "down", "--leave"});
  }
  Process agent(std::vector<std::string> more = {}, const std::string& config = "robots/r1.yaml") {
    std::vector<std::string> words{"robot_agent",
                                   "--config",
                                   config,
                                   "--domain",
                                   std::to_string(domain()),
                                   "--robot-domain",
                                   std::to_string(domain(1))};
    words.insert(words.end(), more.begin(), more.end());
    return Process(words, folder_.environment());
  }
  /// A station as a child of the test, so that it can be killed. It is ready: a command before that would
  /// start another one of that name.
  Process station(const std::string& name) {
    Process process({"basestation", "--name", name, "--domain", std::to_string(domain()), "--serve=1"},
                    folder_.environment());
    EXPECT_TRUE(process.wait_for_output("ready", Seconds(10))) << process.err();
    return process;
  }
  Finished cli(std::vector<std::string> words) {
    words.insert(words.begin(), {"basestation", "--domain", std::to_string(domain())});
    return run(words, folder_.environment(), Seconds(30));
  }
  Finished op(const std::string& name, std::vector<std::string> words) {
    used_.insert(name);
    words.insert(words.begin(), {"--name", name});
    return cli(std::move(words));
  }
  nlohmann::json json(const std::string& name, std::vector<std::string> words) {
    words.insert(words.begin(), "--json");
    return nlohmann::json::parse(op(name, std::move(words)).out, nullptr, false);
  }
  /// What that operator's list says of the robot; null when it is not there.
  nlohmann::json listed(const std::string& name, const std::string& robot) {
    const auto list = json(name, {"list"});
    if (list.is_object())
      for (const auto& row : list.value("robots", nlohmann::json::array()))
        if (row.value("robot", "") == robot) return row;
    return {};
  }

  Folder folder_{};
  std::unique_ptr<Net> net_{make_live_net()};
  std::set<std::string> used_{};
};

}  // namespace adit::live
