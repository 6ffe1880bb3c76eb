// SPDX-License-Identifier: Apache-2.0
// Example 1, the driver, with an agent and a station as in docs/tutorial.md.
#include <signal.h>

#include "tests/live/programs.hpp"

namespace adit::live {
namespace {

class ExampleDriver : public Programs {
 protected:
  bool soon(std::vector<std::string> words) {
    return eventually([&] { return op("op1", words).exit_code == 0; });
  }
  double x() {
    const auto pose = listed("op1", "r1").value("pose", nlohmann::json::array());
    return pose.empty() ? 99.0 : pose[0].get<double>();
  }
};

TEST_F(ExampleDriver, DrivesToAGoalAndStopsWhenItsAgentDies) {
  Process driver({"example_driver", std::to_string(domain(1))});
  ASSERT_TRUE(driver.wait_for_output("ready", Seconds(10))) << driver.err();
  Process robot = agent();
  ASSERT_TRUE(soon({"take", "r1"}));
  ASSERT_TRUE(soon({"goto", "r1", "1.5", "0", "--wait"})) << robot.err();
  ASSERT_TRUE(soon({"goto", "r1", "-3", "0"}));
  ASSERT_TRUE(eventually([&] { return x() < 1.0; }, Seconds(20))) << "it drives, and has 4 m to go";
  robot.signal(SIGKILL);
  EXPECT_TRUE(driver.wait_for_output("/cmd_vel is silent, stopping", Seconds(5))) << driver.out();
  driver.signal(SIGTERM);
  EXPECT_EQ(driver.wait(Seconds(5)).exit_code, 0);
}

TEST_F(ExampleDriver, RefusesADomainThatIsNone) {
  EXPECT_EQ(run({"example_driver", "one"}).exit_code, 2);
  EXPECT_EQ(run({"example_driver"}).exit_code, 2);
}

}  // namespace
}  // namespace adit::live
