// SPDX-License-Identifier: Apache-2.0
// Staircases that robots find on their way, as findings of the station.
#include <gtest/gtest.h>

#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

/// A legged robot drives towards six steps of 20 cm and back.
std::string towards_stairs(const std::string& more, int duration = 30) {
  return "world: {generate: stairs, seed: 1}\nduration: " + std::to_string(duration) +
         "\nlink: wifi\nlidar: full\nperception: odometry\n"
         "robots:\n  - {id: r1, platform: legged, pose: [2, 2.5, 0]}\n"
         "basestations:\n  - {id: op1, pose: [0, 0]}\n"
         "script:\n  - {at: 2, by: op1, do: take r1}\n  - {at: 3, by: op1, do: goto r1 6.5 2.5}\n" +
         more;
}

void expect_found(const RunReport& report) {
  EXPECT_TRUE(report.ok()) << (report.complaints().empty() ? "" : report.complaints().front());
}

TEST(StairsRun, AFlightIsFoundOnce) {
  expect_found(
      run_text(towards_stairs("expect:\n  - {at: 28, by_operator: op1, findings: 1}\n"), "stairs.yaml"));
}

TEST(StairsRun, RestartsOfRobotAndStationMakeNoSecondOne) {
  expect_found(
      run_text(towards_stairs("  - {at: 20, by: op1, do: take r1}\n  - {at: 21, by: op1, do: goto r1 3 2.5}\n"
                              "  - {at: 32, by: op1, do: goto r1 6.5 2.5}\n"
                              "faults:\n  - {at: 15, crash: r1}\n  - {at: 17, crash: op1}\n"
                              "  - {at: 33, crash: r1/stairs}\n  - {at: 35, hang: r1/stairs}\n"
                              "expect:\n  - {at: 48, by_operator: op1, findings: 1}\n",
                              50),
               "stairs.yaml"));
}

}  // namespace
}  // namespace adit::sim
