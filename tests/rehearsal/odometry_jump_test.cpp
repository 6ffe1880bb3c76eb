// SPDX-License-Identifier: Apache-2.0
// A driver whose odometry begins again at zero, in rehearsal (rule 7).
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

constexpr const char* kJumpScenario = R"(world: {boxes: [], floor: 0, ceiling: 3}
duration: 20
link: wifi
lidar: planar
robots:
  - {id: r1, platform: wheeled, pose: [2, 1, 0.5]}
basestations:
  - {id: op1, pose: [0, 3]}
script:
  - {at: 2, by: op1, do: take r1}
  - {at: 3, by: op1, do: goto r1 14 8}
)";

RunReport run_jump(const std::string& rest) {
  const RunReport report = run_text(kJumpScenario + rest, "jump.yaml");
  for (const RuleResult& rule : report.rules) EXPECT_EQ(rule.violations, 0U) << rule.title;
  return report;
}

constexpr const char* kStands = R"(expect:
  - {at: 8, robot: r1, mode: hold}
  - {at: 19, robot: r1, mode: hold, stopped: false, holder: op1}
)";

TEST(OdometryReset, EndsInHold) {
  EXPECT_EQ(run_jump(std::string("faults:\n  - {at: 7, odometry_reset: r1}\n") + kStands).complaints(),
            std::vector<std::string>{});
  EXPECT_FALSE(run_jump(kStands).ok()) << "the fault makes no difference";
}

TEST(OdometryReset, OfADriverThatRestartsElsewhereInItsFrameEndsInHold) {
  const char* faults = "faults:\n  - {at: 7, driver_restart: r1, origin: [30, -4, 2]}\n";
  EXPECT_EQ(run_jump(std::string(faults) + kStands).complaints(), std::vector<std::string>{});
}

TEST(OdometryReset, WhileTheDriverIsSilentEndsInHold) {
  const char* faults = R"(faults:
  - {at: 7, sensor_silent: r1, sensor: odometry, for: 5}
  - {at: 9, odometry_reset: r1}
)";
  EXPECT_EQ(run_jump(std::string(faults) + "expect:\n  - {at: 19, robot: r1, mode: hold}\n").complaints(),
            std::vector<std::string>{});
}

TEST(OdometryReset, WhileTheAgentIsAwayEndsInHold) {
  // By then it drove farther than it can drive before it receives zero: see MotionBound.
  const char* faults = R"(faults:
  - {at: 8, crash: r1}
  - {at: 8.2, odometry_reset: r1}
expect:
  - {at: 9, robot: r1, mode: hold}
  - {at: 19, robot: r1, mode: hold, stopped: false, holder: op1}
)";
  EXPECT_EQ(run_jump(faults).complaints(), std::vector<std::string>{});
}

TEST(OdometryReset, AnAgentThatComesBackAloneGoesOn) {
  EXPECT_EQ(run_jump("faults:\n  - {at: 7, crash: r1}\nexpect:\n  - {by: 20, robot: r1, near: [14, 8, 1]}\n")
                .complaints(),
            std::vector<std::string>{});
}

}  // namespace
}  // namespace adit::sim
