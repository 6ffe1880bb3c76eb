// SPDX-License-Identifier: Apache-2.0
// What the station answers to the queries of the tabs, for tests.
#pragma once
#include <string>

#include "basestation/model/json.hpp"
#include "basestation/model/stairs.hpp"
#include "tests/gui/window_fixture.hpp"

namespace adit::gui {

inline station::HealthReport health_of_ten() {
  station::HealthReport report;
  for (int i = 1; i <= 9; ++i) {
    station::RobotHealth robot{.robot = "r" + std::to_string(i)};
    for (const char* name : {"agent", "command", "planner", "router", "sensors", "map"})
      robot.components.push_back({.name = name, .state = PartState::up, .healthy = true, .automatic = true});
    if (i == 2) robot.components[3] = {.name = "router", .state = PartState::waiting, .restarts = 1};
    if (i == 3) robot.components[5] = {.name = "map", .state = PartState::starting, .automatic = true};
    if (i == 4)
      robot.components[2] = {.name = "planner",
                             .state = PartState::failed,
                             .restarts = 3,
                             .text = "an exception: the costmap has no cell at the robot"};
    if (i == 9)
      robot.components[2] = {.name = "planner",
                             .state = PartState::hung,
                             .automatic = true,
                             .silent_for = 4.2F,
                             .restarts = 2,
                             .hung = 2,
                             .text = "did not return from a callback"};
    if (i == 8) robot.components.resize(3);
    if (i == 5) robot.components.clear();
    report.robots.push_back(std::move(robot));
  }
  return report;
}

inline station::NetworkReport network_of_ten() {
  station::NetworkReport report;
  report.sender = station::SenderReport{.link = "mesh_500k", .bandwidth = 5e5, .queue = 0.02};
  report.agents.push_back({.agent = "op1", .total_out = 4200, .total_in = 38000});
  for (int i = 1; i <= 9; ++i) {
    const std::string name = "r" + std::to_string(i);
    report.agents.push_back({.agent = name,
                             .total_out = 6100.0F * static_cast<float>(i),
                             .classes_out = {{"discovery", 200.0},
                                             {"state", 1100.0 * i},
                                             {"status", 300.0 * i},
                                             {"bulk", 4200.0 * i}},
                             .hears = {{"op1", 0.02}, {"op2", 0.04 * i}}});
    report.links.push_back({.agent = name,
                            .age = 0.4,
                            .lost_from = 0.01 * i,
                            .lost_to = 0.02,
                            .round_trip = 0.031,
                            .bytes_from = 5900.0 * i,
                            .bytes_to = 480.0,
                            .signal = -60.0 - i,
                            .sender = station::SenderReport{.link = "mesh_500k",
                                                            .bandwidth = 5e5,
                                                            .queue = 0.004 * i,
                                                            .state_rate = 10.0,
                                                            .dropped = {{"bulk", i > 7 ? 12U : 0U}}}});
  }
  report.links[2].sender->link.clear();
  report.links[3].lost_to = 1.0;
  report.links[4].age = 47.0;
  report.links[5].sender.reset();
  report.links[8].sender->queue = 0.9;
  return report;
}

inline station::FoundReport some_findings() {
  station::FoundReport report;
  report.findings = {{.number = 2,
                      .robot = "r3",
                      .id = "2",
                      .kind = "person",
                      .importance = 9,
                      .position = {12, 4, 0.2},
                      .text = "sits at the wall, moves",
                      .age = 75.0},
                     {.number = 1,
                      .robot = "r1",
                      .id = "1",
                      .kind = "artifact",
                      .importance = 5,
                      .position = {3, 1, 0},
                      .text = "a red backpack",
                      .age = 740.0,
                      .verdict = station::Verdict::confirmed,
                      .note = "collected by the second crew"},
                     {.number = 3,
                      .robot = "r4",
                      .id = "3",
                      .kind = "gas",
                      .importance = 3,
                      .position = {16, -2, 0},
                      .text = "CO 40 ppm",
                      .verdict = station::Verdict::rejected}};
  report.at_robots = {{.robot = "r4", .stored = 4, .here = 1}, {.robot = "r5", .overflowed = 2}};
  return report;
}

/// A flight that two robots have seen, one that one robot has seen, and one that was rejected.
inline station::StairsReport some_stairs() {
  station::StairsReport report;
  const auto flight = [](double x, double y, double heading, int steps) {
    return Staircase{.foot = {x, y, 0.1},
                     .heading = heading,
                     .rise = 0.17,
                     .run = 0.28,
                     .width = 1.4,
                     .steps = steps,
                     .sigma = {.place = 0.03, .heading = 0.01, .rise = 0.002, .run = 0.004, .width = 0.05}};
  };
  report.stairs = {{.number = 4,
                    .stairs = flight(14, 3, 0.6, 18),
                    .findings = {4, 6},
                    .robots = {"r1", "r3"},
                    .verdict = station::Verdict::confirmed,
                    .fleet = {{.robot = "r1", .may = true},
                              {.robot = "r2", .reason = "climbs steps of 0.15 m at most"},
                              {.robot = "r3", .may = true}}},
                   {.number = 5,
                    .stairs = flight(9.5, 8, -1.5707963, 6),
                    .findings = {5},
                    .robots = {"r3"},
                    .fleet = {{.robot = "r2", .reason = "climbs no stairs"}}},
                   {.number = 7,
                    .stairs = flight(20, 1, 3.1, 4),
                    .findings = {7},
                    .robots = {"r3"},
                    .verdict = station::Verdict::rejected}};
  report.unreadable = 1;
  return report;
}
/// The findings, and those of the staircases.
inline station::FoundReport findings_with_stairs() {
  station::FoundReport report = some_findings();
  for (const std::uint32_t number : {4U, 5U, 6U, 7U, 8U})
    report.findings.push_back(
        {.number = number, .robot = "r3", .kind = "stairs", .position = {14.0 + number, 3, 0.1}});
  return report;
}

/// The ten robots; all but the last two have a camera, and r1 has two.
inline station::World robots_with_cameras() {
  station::World world = ten_robots();
  for (std::size_t i = 0; i + 2 < world.robots.size(); ++i) world.robots[i].cameras = {{.name = "front"}};
  world.robots[0].cameras.push_back({.name = "back"});
  return world;
}

/// The window with answers of a station for its tabs.
class TabsTest : public Window {
 protected:
  template <class Report>
  station::CommandOutcome answer_of(const Report& report) {
    return {.json = station::line_of(station::json_of(report))};
  }
  /// Presses an item until so many lines were sent in all.
  void hold(const QString& name, std::size_t lines) {
    settle_layout();
    finger_down(middle(name));
    (void)QTest::qWaitFor([&] { return sink.lines.size() >= lines; }, 3000);
    finger_up(middle(name));
    settle();
  }
  /// Ends the newest query of the open tab, or of that one: others may have been asked since.
  void answer(const station::CommandOutcome& outcome, std::string query = {}) {
    if (query.empty()) query = control.tabs()->open().toStdString();
    if (query == "network") query = "net";
    const auto asked = [&] {
      return std::find_if(sink.asked.rbegin(), sink.asked.rend(),
                          [&](const auto& next) { return next.first == query; });
    };
    ASSERT_TRUE(QTest::qWaitFor([&] { return asked() != sink.asked.rend(); }, 30'000)) << query;
    const auto found = std::prev(asked().base());
    const auto done = std::move(found->second);
    sink.asked.erase(found);
    done(outcome);
    settle();
  }
  void open(const QString& tab) {
    if (control.tabs()->open() != tab) control.tabs()->toggle(tab);
    settle();
  }
  void type(const std::string& text) {
    for (const char key : text) QTest::keyClick(window(), key);
    settle();
  }
  double panel_height() { return item("panel")->isVisible() ? item("panel")->height() : 0.0; }
};

}  // namespace adit::gui
