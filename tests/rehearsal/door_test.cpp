// SPDX-License-Identifier: Apache-2.0
// Through the doors of a real building's map, whose jambs are neither straight nor opposite each other.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

/// One robot from one place to another on the map geb079, within 30 s.
RunReport drive(const std::string& platform, const std::string& from, const std::string& to,
                std::uint64_t seed) {
  return run_text("world: {map: geb079.bt}\nduration: 34\nseed: " + std::to_string(seed) +
                      "\nlink: wifi\nlidar: full\nrobots:\n  - {id: r1, platform: " + platform + ", pose: [" +
                      from + ", 0]}\nbasestations:\n  - {id: op1, pose: [6, 0]}\nscript:\n" +
                      "  - {at: 2, by: op1, do: take r1}\n  - {at: 3, by: op1, do: goto r1 " + to +
                      "}\nexpect:\n  - {by: 33, robot: r1, near: [" + to.substr(0, to.find(' ')) + "," +
                      to.substr(to.find(' ')) + ", 0.5]}\n  - {always: no_collision}\n",
                  "door.yaml");
}

TEST(Door, ATrackedRobotPassesTheDoorThatLeavesTenCentimetresASide) {
  for (std::uint64_t seed = 1; seed <= seeds(1, 3); ++seed)
    for (const std::string& line : drive("tracked", "6, 0", "14 0", seed).complaints())
      ADD_FAILURE() << "seed " << seed << ": " << line;
}

}  // namespace
}  // namespace adit::sim
