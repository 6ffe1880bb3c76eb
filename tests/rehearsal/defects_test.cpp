// SPDX-License-Identifier: Apache-2.0
// Each defect of sim/defects is found by a rehearsal of 10 s: a rule is reported as broken, or an expectation
// fails. The same scenario and seed pass without the defect.
#include <algorithm>
#include <set>

#include "core/exec/virtual_runtime.hpp"
#include "core/store/memory_disk.hpp"
#include "robot_agent/state/restored.hpp"
#include "sim/defects/defect.hpp"
#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

/// A scenario that finds a defect. op1 holds r1 from 1.5 s on; op2 is there, too.
struct Broken {
  const char* defect;
  int rule;  ///< That is reported; 0: an expectation fails
  int seed;
  const char* script;     ///< Further lines
  const char* rest{""};   ///< Further keys
  const char* robot{""};  ///< Further keys of r1, and further robots
  const char* boxes{"[]"};
};

RunReport run(const Broken& broken, const std::string& defect) {
  const std::string text = "world: {boxes: " + std::string(broken.boxes) +
                           ", floor: 0, ceiling: 3}\nduration: 10\nlink: wifi\nlidar: planar\nseed: " +
                           std::to_string(broken.seed) +
                           "\nrobots:\n  - {id: r1, platform: wheeled, pose: [0, 0, 0]" + broken.robot +
                           "}\nbasestations:\n  - {id: op1, pose: [0, 3]}\n  - {id: op2, pose: [0, -3]}\n"
                           "script:\n  - {at: 1.5, by: op1, do: take r1}\n" +
                           broken.script + broken.rest;
  return run_text(text, "defect.yaml", defect);
}

std::string complaints(const RunReport& report) {
  std::string text;
  for (const std::string& line : report.complaints()) text += line + "\n";
  return text;
}

constexpr const char* kDrive = "  - {at: 3, by: op1, do: drive r1 0.6 0 0 --for 6}\n";
constexpr const char* kGo = "  - {at: 3, by: op1, do: goto r1 9 0}\n";
constexpr const char* kLock = "  - {at: 3, by: op1, do: lock r1}\n";
constexpr const char* kCrash = "faults:\n  - {at: 4.5, crash: r1}\n";

const std::vector<Broken>& table() {
  static const std::vector<Broken> all{
      // op1's goal is half a second on its way. Meanwhile op2 takes the robot, and gives it back.
      {"accept_without_epoch", 1, 1,
       "  - {at: 3.95, by: op1, do: goto r1 5 0}\n  - {at: 4, by: op2, do: take r1}\n"
       "  - {at: 4.2, by: op2, do: grant r1 op1}\n",
       "faults:\n  - {at: 3, degrade: [op1, r1], loss: 0, delay: 0.5, for: 4}\n"},
      {"repeat_done_twice", 1, 1, "  - {at: 3, by: op2, do: take r1}\n  - {at: 4, by: op1, do: take r1}\n",
       "random_script: {commands: 30, from: 4.5, to: 9, verbs: [take, release, take]}\n"
       "faults:\n  - {at: 1, degrade: [op1, r1], loss: 0.4, for: 9}\n  - {at: 1, degrade: [op2, r1], loss: "
       "0.4, for: 9}\n"},
      {"obey_stranger", 1, 1, "  - {at: 4, by: op2, do: goto r1 5 0}\n"},
      {"accept_stale_joystick", 1, 1, kDrive,
       "faults:\n  - {at: 4, degrade: [op1, r1], loss: 0, delay: 0.4, for: 6}\n"},
      {"epoch_kept_at_restart", 1, 1, "", kCrash},
      {"both_namesakes_obey", 1, 1, "  - {at: 6, by: op2, do: take r1}\n",
       "faults:\n  - {at: 3, twin: r1, for: 6}\n"},
      {"kind_by_position", 2, 1, kLock},
      {"ignore_lock", 2, 1, "  - {at: 3, by: op1, do: lock r1}\n  - {at: 5, by: op2, do: take r1}\n"},
      {"silent_refusal", 3, 1, "  - {at: 5, by: op2, do: lock r1}\n"},
      {"stop_needs_holder", 4, 1,
       "  - {at: 3, by: op1, do: goto r1 9 0}\n  - {at: 5, by: op2, do: stop r1}\n"},
      {"joystick_clears_stop", 4, 1,
       "  - {at: 3, by: op1, do: drive r1 0.6 0 0 --for 6}\n  - {at: 5, by: op2, do: stop r1}\n"},
      {"drives_through_stop", 4, 1,
       "  - {at: 3, by: op1, do: goto r1 9 0}\n  - {at: 5, by: op2, do: stop r1}\n"},
      {"two_sources", 5, 1, "", "faults:\n  - {at: 4, stuck: [op1, r1], for: 3}\n"},
      // The stick hangs, so that it is not centred before the goal is given.
      {"change_without_zero", 5, 1,
       "  - {at: 3, by: op1, do: drive r1 0.8 0 0 --for 5}\n  - {at: 5, by: op1, do: goto r1 9 0}\n",
       "faults:\n  - {at: 4, stuck: [op1, r1], for: 3}\n"},
      {"no_zero_on_stale", 6, 1, kDrive, "faults:\n  - {at: 5, cut: [op1, r1], for: 4}\n"},
      {"age_at_handling", 6, 1, kGo, "faults:\n  - {at: 5, sensor_silent: r1, sensor: lidar, for: 3}\n"},
      {"zero_of_other_type", 6, 1, kDrive, kCrash, ", cmd_vel: twist_stamped"},
      {"odometry_jump_accepted", 7, 1, kGo, "faults:\n  - {at: 6, odometry_reset: r1}\n"},
      {"move_on_reset", 7, 1,
       "  - {at: 3, by: op1, do: goto r1 12 0}\n  - {at: 5, by: op1, do: stop r1}\n"
       "  - {at: 7, by: op1, do: reset r1}\n"},
      {"manual_survives_handover", 7, 1,
       "  - {at: 3, by: op1, do: drive r1 0.6 0 0 --for 6}\n  - {at: 5, by: op2, do: take r1}\n"},
      {"enter_off_centre", 7, 1, "  - {at: 6.03, by: op1, do: mode r1 manual}\n",
       "faults:\n  - {at: 4, stuck: [op1, r1], for: 5}\n"},
      {"follows_nobody", 8, 1, "  - {at: 3, by: op1, do: mode r1 convoy_follow}\n"},
      {"yields_unasked", 8, 1, "  - {at: 3, by: op1, do: mode r1 get_out}\n"},
      // r1 stands in a corridor of 1.2 m with a pocket, and r2 wants to pass.
      {"yield_wakes_stopped", 8, 1,
       "  - {at: 2, by: op1, do: take r2}\n  - {at: 2.2, by: op1, do: yield r1 on}\n"
       "  - {at: 2.4, by: op1, do: stop r1}\n  - {at: 2.8, by: op1, do: mode r1 hold}\n"
       "  - {at: 3, by: op1, do: goto r2 8 0}\n  - {at: 6, by: op1, do: reset r1}\n",
       "odometry: {noise: 0}\n", "}\n  - {id: r2, platform: wheeled, pose: [-5, 0, 0]",
       "[[-7, -6.7, -0.9, 0.9, 0, 3], [-7, 1, 0.6, 0.9, 0, 3], [3, 12, 0.6, 0.9, 0, 3], "
       "[-7, 12, -0.9, -0.6, 0, 3], [0.7, 1, 0.9, 2.4, 0, 3], [3, 3.3, 0.9, 2.4, 0, 3], "
       "[0.7, 3.3, 2.4, 2.7, 0, 3], [12, 12.3, -0.9, 0.9, 0, 3]]"},
      {"fence_soft", 10, 1,
       "  - {at: 2, by: op1, do: area r1 add wall keep_out 4 -2 5 2}\n  - {at: 3, by: op1, do: goto r1 8 "
       "0}\n",
       "odometry: {noise: 0}\n"},
      {"sigma_not_kept", 10, 1,
       "  - {at: 2, by: op1, do: area r1 add hall keep_in -4 -4 3 4}\n"
       "  - {at: 2.2, by: op1, do: area r1 add gallery keep_in 2 -1.2 12 1.2}\n  - {at: 3, by: op1, do: goto "
       "r1 8 0}\n",
       "odometry: {noise: 0}\n"},
      // Driven over the border by hand; its way back to the near side of the area leads through it.
      {"area_ends_outside", 10, 1,
       "  - {at: 2, by: op1, do: area r1 add pit keep_out 1 -3 6 3}\n"
       "  - {at: 2.5, by: op1, do: drive r1 0.8 0 0 --for 1.3}\n  - {at: 5, by: op1, do: goto r1 7.5 0}\n",
       "odometry: {noise: 0}\n"},
      {"sigma_small", 11, 1, ""},
      {"lock_forgotten", 9, 1, kLock, kCrash},
      {"acknowledged_lost", 9, 1, kGo, kCrash},
      {"state_lost_whole", 9, 1, kLock, kCrash},
      // No station hears of the finding before the agent is restarted.
      {"findings_deleted_at_start", 0, 1, "",
       "faults:\n  - {at: 2.5, cut: [op1, r1], for: 3}\n  - {at: 2.5, cut: [op2, r1], for: 3}\n"
       "  - {at: 3, finds: person, robot: r1}\n  - {at: 4, crash: r1}\n"
       "expect:\n  - {at: 9.9, by_operator: op1, findings: 1}\n"},
      // The lidar is silent when the charge passes the last threshold: a return is refused then.
      {"return_forgotten", 0, 1, "  - {at: 2, by: op1, do: goto r1 1.5 0}\n",
       "faults:\n  - {at: 3.2, sensor_silent: r1, sensor: lidar, for: 1.5}\n"
       "expect:\n  - {at: 9.9, robot: r1, near: [0, 0, 0.6]}\n",
       ", battery: {warning: 0.57, low: 0.55, last: 0.5, at_last: return, charge: 0.58, drain: 0.02}"},
  };
  return all;
}

class Defects : public testing::TestWithParam<Broken> {};

TEST_P(Defects, IsFound) {
  const Broken& broken = GetParam();
  const RunReport report = run(broken, broken.defect);
  if (broken.rule == 0) {
    for (const RuleResult& rule : report.rules) EXPECT_EQ(rule.violations, 0U) << complaints(report);
    EXPECT_FALSE(report.ok());
    return;
  }
  const auto found = std::find_if(report.rules.begin(), report.rules.end(),
                                  [&](const RuleResult& rule) { return rule.number == broken.rule; });
  ASSERT_NE(found, report.rules.end());
  EXPECT_GT(found->violations, 0U) << complaints(report);
}

TEST_P(Defects, NothingIsFoundWithoutIt) { EXPECT_EQ(complaints(run(GetParam(), "")), ""); }

INSTANTIATE_TEST_SUITE_P(Rules, Defects, testing::ValuesIn(table()),
                         [](const auto& which) { return std::string(which.param.defect); });

TEST(Defects, EachIsFoundByAScenario) {
  std::set<std::string_view> found{"blind_planner", "blind_and_unwatched"};  // monitor_test.cpp
  for (const Broken& broken : table()) found.insert(broken.defect);
  for (const Defect& defect : defects()) EXPECT_TRUE(found.contains(defect.name)) << defect.name;
}

/// The decoration of a robot that has a disk.
struct Decorated {
  explicit Decorated(const char* defect) : decoration(find_defect(defect)->decorate(subject)) {}
  VirtualScheduler scheduler{1};
  std::unique_ptr<Runtime> machine{scheduler.machine("r1", 0s)};
  Platform platform{};
  std::shared_ptr<store::Disk> disk{std::make_shared<store::MemoryDisk>()};
  Subject subject{"r1", platform, *machine, disk};
  Decoration decoration;
};

TEST(Defects, AForgottenReturnLeavesTheChargeAsItIs) {
  const Decorated robot("return_forgotten");
  EXPECT_FALSE(robot.decoration.wires);
}

TEST(Defects, CompletelyLostStateHasItsFormerLength) {
  const Decorated robot("state_lost_whole");
  agent::Snapshot snapshot{};
  snapshot.boot = 7;
  const auto bytes = store::encode_envelope(agent::kSnapshotFormat, 1, agent::encode(snapshot));
  ASSERT_TRUE(robot.disk->replace(agent::kStateFile, bytes));
  const auto read = robot.decoration.disk->read(agent::kStateFile, 1 << 20);
  ASSERT_TRUE(read && *read);
  EXPECT_EQ((*read)->size(), bytes.size());
  EXPECT_EQ(store::decode_envelope(agent::kSnapshotFormat, **read).found, store::LoadStatus::corrupt);
  EXPECT_TRUE(agent::restore_state(robot.decoration.disk).lost);
}

TEST(Defects, UnknownNameIsRefused) {
  EXPECT_EQ(make_agent_factory("sleepy").reason(), Reason::bad_argument);
}

}  // namespace
}  // namespace adit::sim
