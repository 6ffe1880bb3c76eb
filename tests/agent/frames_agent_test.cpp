// What operators see of the frames: poses and goals of the map, whatever the odometry frame is.
#include <gmock/gmock.h>

#include "tests/agent/agent_bench.hpp"

namespace adit::agent {
namespace {

using namespace radio;  // the command kinds

TEST(StartHeight, PlacesTheOdometryInTheMap) {
  AgentParams params;
  params.start = {4, 2, 0};
  params.start_height = 3.5;
  AgentBench bench(params);
  auto& op1 = bench.join("op1");
  bench.run(2s);
  EXPECT_FLOAT_EQ(op1.state.x(), 4.0F);
  EXPECT_FLOAT_EQ(op1.state.z(), 3.5F);
}

}  // namespace
}  // namespace adit::agent
