// SPDX-License-Identifier: Apache-2.0
// One agent and one station, live in one process, so that a thread sanitizer sees all of both: commands, a
// stick, a goal, planning, a stop.
#include <gmock/gmock.h>

#include <functional>

#include "tests/live/driver.hpp"

namespace adit::live {
namespace {

using namespace std::chrono_literals;

TEST(CrewLive, AnAgentAndAStationDriveAndStop) {
  const auto net = make_live_net();
  Robot robot(*net, {});
  PlainDriver driver(*net);
  Operator op(*net, "op1");
  const auto ask = [&](const std::string& line) {
    return op.ask(line).json.at("results").at(0).at("reason");
  };
  EXPECT_EQ(ask("take r1"), "none");
  ASSERT_TRUE(net->until([&] { return driver.told().count > 0; })) << "the driver is told zero";
  EXPECT_EQ(ask("drive r1 0.3 0 0 --for 1"), "none");
  EXPECT_GT(driver.told().moving, 5);
  const int before = driver.told().moving;
  EXPECT_EQ(ask("goto r1 3 0"), "none");
  // Watched for races only, the planner is too slow for its plans to be fresh.
  const auto drives = [&](const std::function<bool()>& moves) {
#if defined(__SANITIZE_THREAD__)
    net->pass(2s);
    return true;
#else
    return net->until(moves);
#endif
  };
  EXPECT_TRUE(drives([&] { return driver.told().moving > before + 10; })) << "the planner drives";
  EXPECT_EQ(ask("stop r1"), "none");
  EXPECT_TRUE(net->until([&] { return driver.told().last == 0.0; }, 1s));
  EXPECT_EQ(ask("goto r1 3 0"), "stopped");
  EXPECT_EQ(ask("reset r1"), "none");
  op.kill();
  op.start();
  EXPECT_EQ(ask("mode r1 waypoint"), "none") << "his robot is his, and goes on";
  EXPECT_TRUE(drives([&] { return driver.told().last != 0.0; }));
  robot.restart();
  EXPECT_TRUE(net->until([&] { return op.view("r1").holder.empty(); })) << "nothing is kept without a disk";
}

TEST(CrewLive, TheMapReachesTheStationAndAgainAfterItsRestart) {
  const auto net = make_live_net();
  agent::AgentParams params{};
  params.perception = PerceptionLevel::slam;
  Robot robot(*net, params);
  PlainDriver driver(*net);
  Operator op(*net, "op1");
  const auto seen = [&] { return op.ask("map status").json.at("m2").get<double>(); };
  EXPECT_TRUE(net->until([&] { return seen() > 1.0; }, 15s));
  op.kill();
  op.start();
  EXPECT_TRUE(net->until([&] { return seen() > 1.0; }, 15s)) << "a new process has nothing yet";
}

}  // namespace
}  // namespace adit::live
