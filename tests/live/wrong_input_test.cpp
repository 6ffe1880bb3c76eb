// SPDX-License-Identifier: Apache-2.0
// Wrong input to every program: one line that says what to do, and a non-zero exit.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "tests/live/process.hpp"

namespace adit::live {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Wrong {
  const char* name{};
  const char* file{};  ///< Written to the folder first.
  const char* text{};
  std::vector<std::string> command{};   ///< FILE is that file, RADIO and INNER are domains
  std::vector<const char*> expected{};  ///< Parts of standard error.
};

class WrongInput : public testing::TestWithParam<Wrong> {};

TEST_P(WrongInput, IsOneLineAndNonZeroExit) {
  const Folder folder;
  const auto& wrong = GetParam();
  const std::string file = *wrong.file != 0 ? folder.write(wrong.file, wrong.text) : "";
  auto command = wrong.command;
  for (auto& word : command) {
    if (word == "FILE") word = file;
    if (word == "RADIO") word = std::to_string(domain());
    if (word == "INNER") word = std::to_string(domain(1));
  }
  const auto ended = run(command, folder.environment());
  EXPECT_GT(ended.exit_code, 0);
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_LT(ended.err.size(), 400U) << ended.err;
  for (const char* text : wrong.expected) EXPECT_THAT(ended.err, HasSubstr(text));
}

const char* const kScenario =
    "world: {boxes: [[5, 6, -1, 1, 0, 1]], floor: 0}\nduration: 5\nlink: lan\n"
    "robots:\n  - {id: r1, platform: wheeled, pose: [0, 0, 0]}\nbasestations:\n  - {id: op1, pose: [0, 0]}\n";
const std::string kWithColour = std::string(kScenario) + "colour: red\n";

INSTANTIATE_TEST_SUITE_P(
    Programs, WrongInput,
    testing::Values(
        Wrong{"robot_key",
              "r.yaml",
              "name: r1\nplatform: wheeled\ncolour: red\n",
              {"robot_agent", "--config", "FILE"},
              {"r.yaml:3", "colour"}},
        Wrong{"robot_platform",
              "r.yaml",
              "name: r1\nplatform: hovercraft\n",
              {"robot_agent", "--config", "FILE"},
              {"hovercraft"}},
        Wrong{"link_key",
              "l.yaml",
              "name: l\nbandwidth: 1e6\nlatency: 0.1\nloss: 0\ncolour: red\n",
              {"basestation", "--link", "FILE", "list"},
              {"l.yaml:5", "colour"}},
        Wrong{"scenario_key", "s.yaml", kWithColour.c_str(), {"rehearse", "FILE"}, {"s.yaml:8", "colour"}},
        Wrong{
            "scenario_key_live", "s.yaml", kWithColour.c_str(), {"simulate", "FILE"}, {"s.yaml:8", "colour"}},
        Wrong{
            "scenario_map",
            "s.yaml",
            "world: {map: nowhere.bt}\nduration: 5\nlink: lan\nrobots:\n"
            "  - {id: r1, platform: wheeled, pose: [0, 0, 0]}\nbasestations:\n  - {id: op1, pose: [0, 0]}\n",
            {"rehearse", "FILE"},
            {"nowhere.bt"}},
        Wrong{"tree_broken",
              "t.xml",
              "<root BTCPP_format=\"4\">\n  <BehaviorTree ID=\"A\">\n    <Sequence>\n",
              {"tree", "check", "FILE"},
              {"t.xml"}},
        Wrong{"interface",
              "r.yaml",
              "name: r1\nplatform: wheeled\nradio: {interfaces: [10.255.255.1]}\n",
              {"robot_agent", "--config", "FILE"},
              {"10.255.255.1"}},
        Wrong{"robot_interface",
              "r.yaml",
              "name: r1\nplatform: wheeled\nrobot_interfaces: [nosuch0]\n",
              {"robot_agent", "--config", "FILE"},
              {"r.yaml:3", "nosuch0"}},
        Wrong{"robot_pose",
              "",
              "",
              {"robot_agent", "--config", "r1.yaml", "--pose", "nan", "0", "0"},
              {"--pose", "a number", "'nan'"}},
        Wrong{"robot_domain",
              "",
              "",
              {"robot_agent", "--config", "r1.yaml", "--domain", "300"},
              {"--domain", "0 to 232", "'300'"}},
        Wrong{"memory_limit",
              "",
              "",
              {"robot_agent", "--config", "r1.yaml", "--memory-limit", "nan"},
              {"--memory-limit", "'nan'"}},
        Wrong{"robot_all",
              "r.yaml",
              "name: all\nplatform: wheeled\n",
              {"robot_agent", "--config", "FILE"},
              {"r.yaml:1", "not 'all'"}},
        Wrong{"seed",
              "",
              "",
              {"rehearse", "s.yaml", "--seed", "x"},
              {"--seed: expected a whole number, 0 or more, not 'x'"}},
        Wrong{"negative_seed", "", "", {"rehearse", "s.yaml", "--seed", "-1"}, {"--seed", "0 or more"}},
        Wrong{"seeds",
              "",
              "",
              {"rehearse", "s.yaml", "--seeds", "x"},
              {"--seeds: expected A..B, two whole numbers as in 1..200, not 'x'"}},
        Wrong{"seeds_order",
              "",
              "",
              {"rehearse", "s.yaml", "--seeds", "5..1"},
              {"--seeds: expected A..B with A not above B"}},
        Wrong{"seeds_many",
              "",
              "",
              {"rehearse", "s.yaml", "--seeds", "1..9000000"},
              {"--seeds: expected at most 1000000 seeds"}},
        Wrong{"seed_live",
              "",
              "",
              {"simulate", "s.yaml", "--seed", "1.5"},
              {"--seed: expected a whole number"}},
        Wrong{"time_live",
              "",
              "",
              {"simulate", "s.yaml", "--for", "nan"},
              {"--for: expected a number, 0.1 to 86400, not 'nan'"}},
        Wrong{"huge_seed",
              "",
              "",
              {"rehearse", "s.yaml", "--seed", "99999999999999999999"},
              {"--seed", "'9999"}},
        Wrong{"no_option", "", "", {"simulate", "--nonsense"}, {"no option --nonsense"}},
        Wrong{"no_command", "", "", {"tree"}, {"a command is missing; commands are check, draw, run"}},
        Wrong{"unknown_command",
              "",
              "",
              {"tree", "climb"},
              {"unexpected 'climb'; commands are check, draw, run"}},
        Wrong{"ticks",
              "",
              "",
              {"tree", "run", "t.xml", "--ticks", "many"},
              {"--ticks: expected a whole number, 1 to 1000000"}},
        Wrong{"station_place",
              "",
              "",
              {"basestation", "--at", "nan", "0", "0", "list"},
              {"--at: expected a number"}},
        Wrong{"station_domain",
              "",
              "",
              {"basestation", "--domain", "x", "list"},
              {"--domain: expected a whole number, 0 to 232, not 'x'"}},
        Wrong{"operator_name", "", "", {"basestation", "--name", "a/b", "list"}, {"--name"}}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(WrongInputToStations, UnknownRobot) {
  const Folder folder;
  const std::vector<std::string> station{"basestation", "--domain", std::to_string(domain())};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.begin(), station.begin(), station.end());
    return run(words, folder.environment());
  };
  (void)with({"up"});
  const auto ended = with({"take", "r9"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_THAT(ended.err, AllOf(HasSubstr("r9"), HasSubstr("known robots")));
  (void)with({"down"});
}

TEST(WrongInputToStations, NameInUse) {
  const Folder folder;
  const std::vector<std::string> serve{"basestation", "--domain", std::to_string(domain()), "--serve=-1"};
  Process first(serve, folder.environment());
  // The second station starts only once the first one has its name.
  const std::string socket = folder.environment().at("XDG_RUNTIME_DIR") + "/adit/op1.sock";
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(socket); })) << first.err();
  const auto second = run(serve, folder.environment(), Seconds(10));
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_EQ(std::count(second.err.begin(), second.err.end(), '\n'), 1) << second.err;
  EXPECT_THAT(second.err, AllOf(HasSubstr("op1"), HasSubstr("running already")));
  EXPECT_TRUE(first.running());
}

}  // namespace
}  // namespace adit::live
