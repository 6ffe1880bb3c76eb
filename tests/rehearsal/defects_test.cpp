// Every rule, broken on purpose in the agent: the checker fires; without the defect, on the same scenario, it
// does not.
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

constexpr const char* head = R"(world: {boxes: [], floor: 0, ceiling: 3}
duration: 24
link: wifi
lidar: planar
robots:
  - {id: r1, platform: wheeled, pose: [0, 0, 0]}
basestations:
  - {id: op1, pose: [0, 3]}
  - {id: op2, pose: [0, -3]}
script:
  - {at: 2, by: op1, do: take r1}
)";

struct Broken {
  const char* defect;
  int rule;
  const char* script;  ///< further lines
  const char* rest;    ///< further keys
};

RunReport run(const Broken& broken, const std::string& defect) {
  return run_text(std::string(head) + broken.script + broken.rest, "defect.yaml", defect);
}

class Defects : public testing::TestWithParam<Broken> {};

TEST_P(Defects, TheRuleFires) {
  const RunReport report = run(GetParam(), GetParam().defect);
  std::string told;
  for (const std::string& line : report.complaints()) told += line + "\n";
  EXPECT_GT(report.rules.at(static_cast<std::size_t>(GetParam().rule - 1)).violations, 0U) << told;
}

TEST_P(Defects, NoRuleFiresWithoutTheDefect) {
  const RunReport report = run(GetParam(), "");
  for (const std::string& line : report.complaints()) ADD_FAILURE() << line;
}

constexpr const char* drive = "  - {at: 4, by: op1, do: drive r1 0.6 0 0 --for 8}\n";

INSTANTIATE_TEST_SUITE_P(
    Rules, Defects,
    testing::Values(
        // op1's goal is half a second on its way. Meanwhile op2 takes the robot, and gives it back.
        Broken{"accept_without_epoch", 1,
               "  - {at: 3.95, by: op1, do: goto r1 5 0}\n  - {at: 4, by: op2, do: take r1}\n"
               "  - {at: 4.2, by: op2, do: grant r1 op1}\n",
               "faults:\n  - {at: 3, degrade: [op1, r1], loss: 0, delay: 0.5, for: 4}\n"},
        Broken{"repeat_done_twice", 1,
               "  - {at: 4, by: op2, do: take r1}\n  - {at: 6, by: op1, do: take r1}\n",
               "random_script: {commands: 40, from: 7, to: 20, verbs: [take, release, take]}\n"
               "faults:\n  - {at: 1, degrade: [op1, r1], loss: 0.4, for: 20}\n  - {at: 1, degrade: [op2, "
               "r1], loss: 0.4, for: 20}\n"},
        Broken{"obey_stranger", 1, "  - {at: 4, by: op2, do: goto r1 5 0}\n", ""},
        Broken{"ignore_lock", 2, "  - {at: 3, by: op1, do: lock r1}\n  - {at: 5, by: op2, do: take r1}\n",
               ""},
        Broken{"silent_refusal", 3, "  - {at: 5, by: op2, do: lock r1}\n", ""},
        Broken{"stop_needs_holder", 4,
               "  - {at: 4, by: op1, do: goto r1 9 0}\n  - {at: 6, by: op2, do: stop r1}\n", ""},
        Broken{"joystick_clears_stop", 4,
               "  - {at: 4, by: op1, do: drive r1 0.6 0 0 --for 8}\n  - {at: 6, by: op2, do: stop r1}\n", ""},
        Broken{"two_sources", 5, "", "faults:\n  - {at: 4, stuck: [op1, r1], for: 6}\n"},
        Broken{"change_without_zero", 5,
               "  - {at: 4, by: op1, do: drive r1 0.8 0 0 --for 6}\n  - {at: 6, by: op1, do: goto r1 9 0}\n",
               ""},
        Broken{"no_zero_on_stale", 6, drive, "faults:\n  - {at: 7, cut: [op1, r1], for: 8}\n"},
        Broken{"move_on_reset", 7,
               "  - {at: 4, by: op1, do: goto r1 12 0}\n  - {at: 6, by: op1, do: stop r1}\n"
               "  - {at: 9, by: op1, do: reset r1}\n",
               ""},
        Broken{"manual_survives_handover", 7,
               "  - {at: 4, by: op1, do: drive r1 0.6 0 0 --for 8}\n  - {at: 6, by: op2, do: take r1}\n", ""},
        Broken{"enter_off_centre", 7, "  - {at: 6.03, by: op1, do: mode r1 manual}\n",
               "faults:\n  - {at: 4, stuck: [op1, r1], for: 6}\n"}),
    [](const auto& which) { return std::string(which.param.defect); });

TEST(Defects, UnknownNameIsRefused) {
  EXPECT_EQ(make_agent_factory("sleepy").reason(), Reason::bad_argument);
}

}  // namespace
}  // namespace adit::sim
