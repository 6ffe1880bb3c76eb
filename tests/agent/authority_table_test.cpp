// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/agent/command_bench.hpp"
#include "tests/authority_cases.hpp"

namespace adit::agent {
namespace {

using authority_cases::Case;
using authority_cases::Told;

void play(CommandBench& bench, const authority_cases::Line& line) {
  if (!line.by.empty()) {
    bench.say(line.by, line.line);
  } else if (line.line.starts_with("kill ")) {
    bench.kill(line.line.substr(5));
  } else if (line.line.starts_with("start ")) {
    bench.start(line.line.substr(6));
  } else {
    ASSERT_TRUE(line.line.starts_with("wait ")) << line.line;
    bench.wait(std::chrono::seconds(std::stoi(line.line.substr(5))));
  }
}

class AuthorityTable : public testing::TestWithParam<Case> {};

TEST_P(AuthorityTable, Case) {
  const Case& c = GetParam();
  CommandParams params{};
  params.lock_lease = std::chrono::seconds(authority_cases::kLease);
  CommandBench bench(params);
  for (const auto& line : c.given) play(bench, line);
  bench.notices.clear();
  const Answer answer = bench.say(c.asked.by, c.asked.line);

  EXPECT_EQ(name(answer.reason), name(c.reason)) << answer.text;
  EXPECT_EQ(answer.holder, c.holder) << "the answer names who holds";
  EXPECT_EQ(answer.epoch, bench.interface().authority().epoch());
  EXPECT_TRUE(answer.accepted() || !answer.text.empty());
  EXPECT_EQ(bench.interface().authority().holder_name(), c.holder);
  EXPECT_EQ(bench.interface().authority().locked(), c.locked);
  std::vector<std::string> stops;
  for (const Party& stopper : bench.interface().stops().all()) stops.push_back(stopper.name);
  EXPECT_THAT(stops, testing::UnorderedElementsAreArray(c.stops));
  std::vector<Told> reported;
  for (const Notice& n : bench.notices) reported.push_back({n.operator_name, n.code});
  EXPECT_THAT(reported, testing::UnorderedElementsAreArray(c.told));
}

INSTANTIATE_TEST_SUITE_P(Rules, AuthorityTable, testing::ValuesIn(authority_cases::all()),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace adit::agent
