// SPDX-License-Identifier: Apache-2.0
// Drives in a real building, geb079, whose floors, walls and furniture are as lidars saw them.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

// A floor that shows behind furniture, and rings that drift while tracks turn, are no drops beside the door.
TEST(Building, ATrackedRobotPassesADoorThatLeavesNineCentimetresASide) {
  const std::string places[][3] = {{"[12.932, -0.126, -2.4479]", "7.47 -0.39", "[7.47, -0.39, 0.5]"},
                                   {"[12.869, 0.051, 2.3525]", "8.77 -0.63", "[8.77, -0.63, 0.5]"}};
  const std::uint64_t seeds[] = {7, 11};
  for (std::size_t n = 0; n < 2; ++n) {
    const auto& [start, goal, near] = places[n];
    const RunReport report = run_text(
        "world: {map: geb079.bt}\nduration: 60\nlink: mesh_500k\nlidar: full\nrobots:\n  - {id: r1, "
        "platform: "
        "tracked, pose: " +
            start + "}\nbasestations:\n  - {id: op1, pose: [13, 0]}\nseed: " + std::to_string(seeds[n]) +
            "\nscript:\n  - {at: 3, by: op1, do: take r1}\n  - {at: 4, by: op1, do: goto r1 " + goal +
            "}\nexpect:\n  - {by: 55, robot: r1, near: " + near + "}\n  - {always: no_collision}\n",
        "building.yaml");
    for (const std::string& line : report.complaints()) ADD_FAILURE() << "seed " << seeds[n] << ": " << line;
  }
}

}  // namespace
}  // namespace adit::sim
