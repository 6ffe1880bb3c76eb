// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/behaviour/mode_table.hpp"

#include <gmock/gmock.h>

#include <string>

namespace adit::agent {
namespace {

const Facts kAllMet{false, true, true, true, true, true,
                    true,  true, true, true, true, {"in_convoy", "leader_known", "order_agrees"}};

struct Row {
  const char* mode;
  const char* broken;
  void (*spoil)(Facts&);
  Reason reason;
};

class ModeConditions : public testing::TestWithParam<Row> {};

TEST_P(ModeConditions, EntryIsRefusedWithTheReason) {
  const Row& row = GetParam();
  Facts facts = kAllMet;
  row.spoil(facts);
  EXPECT_EQ(name(entry_refusal(*ModeTable::shipped().find(row.mode), facts)), name(row.reason));
  EXPECT_EQ(entry_refusal(*ModeTable::shipped().find(row.mode), kAllMet), Reason::none);
}

void stop(Facts& f) { f.stopped = true; }
void no_driver(Facts& f) { f.driver_alive = false; }
void lost(Facts& f) { f.localised = false; }
void blind(Facts& f) { f.terrain_fresh = false; }
void no_stick(Facts& f) { f.stick_fresh = f.stick_present = f.stick_centred = false; }
void pushed(Facts& f) { f.stick_centred = false; }
void no_goal(Facts& f) { f.goal_known = false; }
void silent(Facts& f) { f.program_fresh = false; }
void walled(Facts& f) { f.goal_free = false; }
void alone(Facts& f) { std::erase(f.also, "in_convoy"); }
void leaderless(Facts& f) { std::erase(f.also, "leader_known"); }
void disordered(Facts& f) { std::erase(f.also, "order_agrees"); }
void unmapped(Facts& f) { f.map_fresh = false; }

INSTANTIATE_TEST_SUITE_P(Table, ModeConditions,
                         testing::Values(Row{"hold", "stop", stop, Reason::none},
                                         Row{"hold", "driver", no_driver, Reason::none},
                                         Row{"manual", "stop", stop, Reason::stopped},
                                         Row{"manual", "driver", no_driver, Reason::driver_silent},
                                         Row{"manual", "localisation", lost, Reason::none},
                                         Row{"manual", "terrain", blind, Reason::none},
                                         Row{"manual", "stick", no_stick, Reason::joystick_stale},
                                         Row{"manual", "pushed", pushed, Reason::stick_not_centred},
                                         Row{"smart_joystick", "stop", stop, Reason::stopped},
                                         Row{"smart_joystick", "driver", no_driver, Reason::driver_silent},
                                         Row{"smart_joystick", "localisation", lost, Reason::no_localisation},
                                         Row{"smart_joystick", "terrain", blind, Reason::terrain_stale},
                                         Row{"smart_joystick", "stick", no_stick, Reason::joystick_stale},
                                         Row{"smart_joystick", "pushed", pushed, Reason::stick_not_centred},
                                         Row{"external", "stop", stop, Reason::stopped},
                                         Row{"external", "driver", no_driver, Reason::driver_silent},
                                         Row{"external", "localisation", lost, Reason::none},
                                         Row{"external", "terrain", blind, Reason::none},
                                         Row{"external", "program", silent, Reason::program_silent},
                                         Row{"convoy_follow", "stop", stop, Reason::stopped},
                                         Row{"convoy_follow", "alone", alone, Reason::not_in_convoy},
                                         Row{"convoy_follow", "leader", leaderless, Reason::leader_unknown},
                                         Row{"convoy_follow", "order", disordered, Reason::order_differs},
                                         Row{"explore", "stop", stop, Reason::stopped},
                                         Row{"explore", "terrain", blind, Reason::terrain_stale},
                                         Row{"explore", "map", unmapped, Reason::map_stale},
                                         Row{"waypoint", "stop", stop, Reason::stopped},
                                         Row{"waypoint", "driver", no_driver, Reason::driver_silent},
                                         Row{"waypoint", "localisation", lost, Reason::no_localisation},
                                         Row{"waypoint", "terrain", blind, Reason::terrain_stale},
                                         Row{"waypoint", "stick", no_stick, Reason::none},
                                         Row{"waypoint", "goal", no_goal, Reason::goal_missing},
                                         Row{"waypoint", "walled", walled, Reason::goal_unreachable}),
                         [](const auto& each) {
                           return std::string(each.param.mode) + "_" + each.param.broken;
                         });

TEST(ModeTable, HoldIsFirstAndUnconditional) {
  EXPECT_EQ(ModeTable::shipped().hold().name, "hold");
  EXPECT_TRUE(ModeTable::shipped().hold().conditions.empty());
  EXPECT_EQ(entry_refusal(ModeTable::shipped().hold(), Facts{}), Reason::none);
}

TEST(ModeTable, EveryConditionOfARowIsALeaf) {
  for (const ModeRow& row : ModeTable::shipped().rows())
    for (const Condition& c : row.conditions)
      EXPECT_THAT(ModeTable::shipped().conditions(),
                  testing::Contains(testing::Field(&Condition::leaf, c.leaf)));
}

}  // namespace
}  // namespace adit::agent
