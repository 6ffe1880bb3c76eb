// SPDX-License-Identifier: Apache-2.0
// The program `simulate` beside another one.
#include <gmock/gmock.h>
#include <signal.h>

#include "tests/live/process.hpp"

namespace adit::live {
namespace {

using testing::HasSubstr;

constexpr const char* kTwoRobots =
    "world: {boxes: [[-1, 9, -2, 2, -0.1, 0]]}\nduration: 5\nlink: lan\nlidar: planar\nrobots:\n"
    "  - {id: r1, platform: wheeled, pose: [0, 0, 0]}\n  - {id: r2, platform: wheeled, pose: [3, 0, 0]}\n"
    "basestations:\n  - {id: op1, pose: [0, 0]}\n";

class Simulate : public testing::Test {
 protected:
  std::vector<std::string> words(unsigned base, const std::string& length = "60") const {
    return {"simulate", scenario_, "--domain-base", std::to_string(base), "--for", length};
  }
  static bool ready(Process& process) { return process.wait_for_output("simulate: ready", Seconds(20)); }

  Folder folder_{};
  std::string scenario_{folder_.write("two.yaml", kTwoRobots)};
};

TEST_F(Simulate, RefusesADomainThatAnotherOneServes) {
  Process first(words(domain()));
  ASSERT_TRUE(ready(first)) << first.err();
  // Its domain of r1 is the first one's domain of r2.
  const Finished second = run(words(domain(1), "0.5"));
  EXPECT_EQ(second.exit_code, 2) << second.out;
  EXPECT_THAT(second.err, HasSubstr("domain " + std::to_string(domain(2))));
  EXPECT_THAT(second.err, HasSubstr("kill " + std::to_string(first.pid())));
  EXPECT_THAT(second.err, HasSubstr("--domain-base"));
  EXPECT_EQ(run(words(domain(2), "0.5")).exit_code, 0) << "domains of its own, also after a refused one";
  EXPECT_TRUE(first.running());
}

TEST_F(Simulate, ServesTheDomainsOfOneThatWasKilled) {
  Process first(words(domain()));
  ASSERT_TRUE(ready(first)) << first.err();
  first.signal(SIGKILL);
  first.wait(Seconds(5));
  const Finished second = run(words(domain(), "0.5"));
  EXPECT_EQ(second.exit_code, 0) << second.err;
}

}  // namespace
}  // namespace adit::live
