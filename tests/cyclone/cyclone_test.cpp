// SPDX-License-Identifier: Apache-2.0
// An agent among programs of another vendor's DDS that use ROS 2 types alone.
#include <signal.h>

#include "tests/live/programs.hpp"

namespace adit::live {
namespace {

using testing::HasSubstr;

class Cyclone : public Programs {
 protected:
  Process driver() { return Process({"ros_driver", std::to_string(domain(1))}); }
  Process planner(const char* x, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"ros_planner", std::to_string(domain(1)), x};
    words.insert(words.end(), more.begin(), more.end());
    return Process(words);
  }
  bool soon(std::vector<std::string> words) {
    return eventually([&] { return op("op1", words).exit_code == 0; });
  }
  double x() {
    const auto row = listed("op1", "r1");
    const auto pose = row.value("pose", nlohmann::json::array());
    return pose.empty() ? 0.0 : pose[0].get<double>();
  }
};

TEST_F(Cyclone, ADriverTakesTheSimulatorsPlace) {
  const Process ros = driver();
  const Process robot = agent();
  ASSERT_TRUE(soon({"take", "r1"}));
  ASSERT_TRUE(soon({"goto", "r1", "1.5", "0"}));
  EXPECT_TRUE(eventually([&] { return std::abs(x() - 1.5) < 0.35; }, Seconds(20))) << x();
}

TEST_F(Cyclone, APlannerFromOutsideSteersInAModeOfItsOwn) {
  const Process ros = driver();
  const Process robot = agent();
  ASSERT_TRUE(soon({"take", "r1"}));
  ASSERT_TRUE(eventually([&] { return listed("op1", "r1").value("mode", "") == "hold"; }));
  const auto refused = op("op1", {"mode", "r1", "external"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.out + refused.err, HasSubstr("program"));
  {
    const Process outside = planner("1.2");
    ASSERT_TRUE(soon({"mode", "r1", "external"}));
    EXPECT_TRUE(eventually([&] { return std::abs(x() - 1.2) < 0.1; }, Seconds(20))) << x();
  }
  EXPECT_TRUE(eventually([&] { return listed("op1", "r1").value("mode", "") == "hold"; }))
      << "its program is gone";
}

TEST_F(Cyclone, ASecondWriterOfCmdVelIsTold) {
  const Process ros = driver();
  Process robot = agent();
  ASSERT_TRUE(soon({"take", "r1"}));
  const Process rival = planner("0", {"rt/cmd_vel"});
  EXPECT_TRUE(robot.wait_for_output("rival_writer", Seconds(20)));
  EXPECT_TRUE(eventually([&] {
    return json("op1", {"status"}).dump().find("rival_writer") != std::string::npos;
  })) << json("op1", {"status"}).dump();
}

}  // namespace
}  // namespace adit::live
