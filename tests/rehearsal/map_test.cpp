// SPDX-License-Identifier: Apache-2.0
// Robots' maps on their way to the stations, in rehearsal.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

/// Two robots drive through a room of 16 x 8 m, with two stations. They are at their goals after 15 s; the
/// map of robots that only stood there would have 160 m2, all that they saw on their way has 230 m2.
std::string room(const std::string& more, const std::string& lidar = "full",
                 const std::string& link = "mesh_500k") {
  return "world: {boxes: [[-1, 16, -4, -3.8, 0, 2.5], [-1, 16, 3.8, 4, 0, 2.5], [-1.2, -1, -4, 4, 0, 2.5], "
         "[15, 15.2, -4, 4, 0, 2.5], [6, 6.4, -1, 1, 0, 2.5]], floor: 0, ceiling: 3}\n"
         "duration: 30\nlink: " +
         link + "\nlidar: " + lidar +
         "\nperception: slam\n"
         "robots:\n  - {id: r1, platform: wheeled, pose: [0, 2, 0]}\n  - {id: r2, platform: wheeled, pose: "
         "[0, -2, 0]}\n"
         "basestations:\n  - {id: op1, pose: [0, 0]}\n  - {id: op2, pose: [14, 0]}\n"
         "script:\n  - {at: 1, by: op1, do: take r1 r2}\n  - {at: 2, by: op1, do: goto r1 12 2}\n"
         "  - {at: 2, by: op1, do: goto r2 12 -2}\n" +
         more;
}

double seen(const RunReport& report) {
  EXPECT_TRUE(report.map.has_value());
  return report.map ? report.map->m2 : 0.0;
}

TEST(MapRehearsal, TheMapReachesTheStation) {
  const RunReport report = run_text(room(""), "map.yaml");
  EXPECT_TRUE(report.ok()) << (report.complaints().empty() ? "" : report.complaints().front());
  EXPECT_GT(seen(report), 200.0);
  EXPECT_LT(report.map->bytes_per_m2(), 3000.0);
}

TEST(MapRehearsal, SurvivesComponentsThatCrashAndHang) {
  const RunReport report = run_text(
      room(
          "faults:\n  - {at: 4, crash: r1/map}\n  - {at: 6, hang: r2/map}\n  - {at: 8, crash: r1}\n"
          "  - {at: 9, crash: r2/command}\n  - {at: 12, crash: op1}\n  - {at: 14, cut: [op2, r1], for: 5}\n"),
      "map.yaml");
  EXPECT_TRUE(report.ok()) << (report.complaints().empty() ? "" : report.complaints().front());
  EXPECT_GT(seen(report), 200.0);
  EXPECT_EQ(report.failures, 0U);
}

TEST(MapRehearsal, ARestartedAgentHasItsMapForAStationThatComesLater) {
  // The agent ends after it has driven; the stations are restarted after that and have nothing.
  const RunReport report = run_text(room("faults:\n  - {at: 16, crash: r1}\n  - {at: 16, crash: r2}\n"
                                         "  - {at: 20, crash: op1}\n  - {at: 20, crash: op2}\n"),
                                    "map.yaml");
  EXPECT_TRUE(report.ok()) << (report.complaints().empty() ? "" : report.complaints().front());
  EXPECT_GT(seen(report), 200.0);
}

/// Two robots in two halls, of which one ring sees 15 m2 each; full lidars, with all_seeds(), see 60 m2 and
/// more. The station never hears the first one. `carry`: of the second one.
std::string halls(bool carry, const std::string& more) {
  return "world: {boxes: [[-2, 22, -4, -3.8, 0, 2.5], [-2, 22, 3.8, 4, 0, 2.5], [-2.2, -2, -4, 4, 0, 2.5], "
         "[22, 22.2, -4, 4, 0, 2.5], [10, 10.2, -4, 4, 0, 2.5]], floor: 0, ceiling: 3}\n"
         "duration: 90\nlink: mesh_500k\nlidar: " +
         std::string(all_seeds() ? "full" : "planar") +
         "\nperception: slam\n"
         "robots:\n  - {id: r1, platform: wheeled, pose: [4, 0, 0]}\n  - {id: r2, platform: wheeled, pose: "
         "[16, 0, 0]" +
         std::string(carry ? ", map: {carry: true}" : "") +
         "}\n"
         "basestations:\n  - {id: op1, pose: [14, 0]}\n"
         "script:\n  - {at: 1, by: op1, do: take r2}\n  - {at: 2, by: op1, do: goto r2 19 0}\n"
         "faults:\n  - {at: 0, cut: [r1, op1], for: 90}\n" +
         more;
}

TEST(CarriedMapRehearsal, ARobotThatIsAllowedToBringsTheMapOfOneThatIsOutOfReach) {
  const RunReport without = run_text(halls(false, ""), "halls.yaml");
  const RunReport with = run_text(halls(true, ""), "halls.yaml");
  for (const RunReport* report : {&without, &with})
    EXPECT_TRUE(report->ok()) << (report->complaints().empty() ? "" : report->complaints().front());
  const double hall = all_seeds() ? 60.0 : 12.0;  // m2
  EXPECT_GT(seen(without), hall);
  EXPECT_GT(seen(with), seen(without) + hall) << "the other hall";
}

TEST(CarriedMapRehearsal, SurvivesARestartOfTheCarrierAndOfTheStation) {
  const RunReport report =
      run_text(halls(true,
                     "  - {at: 22, crash: r2}\n  - {at: 40, crash: r1}\n  - {at: 50, crash: op1}\n"
                     "  - {at: 55, hang: r2/command}\n"),
               "halls.yaml");
  EXPECT_GT(seen(report), all_seeds() ? 120.0 : 22.0);
}

/// Megabytes of memory that this process uses.
double resident() {
  std::ifstream status("/proc/self/statm");
  double size = 0, pages = 0;
  status >> size >> pages;
  return pages * 4096 / 1e6;
}

/// Two robots drive to and fro for so long, with a planar lidar.
RunReport patrol(int seconds) {
  std::string text = room("", "planar", "wifi");
  text.replace(text.find("duration: 30"), 12, "duration: " + std::to_string(seconds));
  for (int at = 40, to = 0; at < seconds; at += 40, to = 12 - to)
    for (const char* robot : {"r1", "r2"})
      text += "  - {at: " + std::to_string(at) + ", by: op1, do: goto " + robot + " " + std::to_string(to) +
              (robot[1] == '1' ? " 2}\n" : " -2}\n");
  return run_text(text, "patrol.yaml");
}

TEST(MapRehearsal, MemoryIsFlatOverAnHour) {
  const char* wanted = std::getenv("ADIT_MAP_HOUR");
  if (wanted == nullptr) GTEST_SKIP() << "long: set ADIT_MAP_HOUR to the seconds of a quarter";
  const int unit = std::max(30, std::atoi(wanted));  // s
  (void)patrol(unit);                                // What is allocated once.
  const double before = resident();
  const RunReport quarter = patrol(unit);
  const double after_quarter = resident();
  const RunReport hour = patrol(4 * unit);
  const double after_hour = resident();
  std::cout << "resident, MB: " << before << ", " << after_quarter << ", " << after_hour
            << "; bytes on the air: " << quarter.map->bytes << ", " << hour.map->bytes << "\n";
  EXPECT_LT(after_hour - before, 60.0);
  // Each submap is sent once, so the bytes grow with the way driven, and no faster.
  EXPECT_LT(static_cast<double>(hour.map->bytes), 4.5 * static_cast<double>(quarter.map->bytes));
}

TEST(MapRehearsal, OffSendsNoPieces) {
  std::string text = room("", "planar");
  text.replace(text.find("perception: slam"), 16, "perception: off ");
  text.replace(text.find("duration: 30"), 12, "duration: 12");
  const RunReport report = run_text(text, "map.yaml");
  EXPECT_FALSE(report.map.has_value());
  EXPECT_FALSE(report.topics.contains("adit/bulk"));
}

}  // namespace
}  // namespace adit::sim
