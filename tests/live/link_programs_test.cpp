// SPDX-License-Identifier: Apache-2.0
// Both programs with --link: a profile that is none is one line; over one that is, commands pass.
#include <algorithm>

#include "tests/live/programs.hpp"

namespace adit::live {
namespace {

using testing::HasSubstr;

TEST_F(Programs, ALinkThatIsNoneIsOneLine) {
  for (const auto& [words, exit_code] : std::vector<std::pair<std::vector<std::string>, int>>{
           {{"robot_agent", "--config", "robots/r1.yaml", "--link", "string_and_tins"}, 2},
           {{"basestation", "--name", "op1", "--link", "string_and_tins", "list"}, 2}}) {
    const auto ended = run(words, folder_.environment());
    EXPECT_EQ(ended.exit_code, exit_code) << words.front() << ": " << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("string_and_tins"));
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  }
}

TEST_F(Programs, CommandsPassOverALinkThatIsGiven) {
  const Process robot = agent({"--link", "mesh_500k"});
  const auto station = [this](std::vector<std::string> words) {
    words.insert(words.begin(), {"--link", "mesh_500k"});
    return op("op1", std::move(words));
  };
  // Loss and latency apply to getting to know each other, too.
  ASSERT_TRUE(eventually([&] { return station({"take", "r1"}).exit_code == 0; }, Seconds(40)));
  EXPECT_TRUE(eventually([&] { return station({"lock", "r1"}).exit_code == 0; }, Seconds(20)));
  EXPECT_TRUE(eventually([&] { return listed("op1", "r1").value("locked", false); }));
  const auto status = json("op1", {"status"});
  EXPECT_EQ(status.value("link", ""), "mesh_500k");
  // 50 ms each way.
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(station({"stop", "r1"}).exit_code, 0);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(100));
}

}  // namespace
}  // namespace adit::live
