// SPDX-License-Identifier: Apache-2.0
// Robots whose agent is killed on the way, with an odometry of their own.
#include <cstdlib>

#include "tests/rehearsal/run_text.hpp"

namespace adit::sim {
namespace {

/// A robot drives through a furnished hall, and its agent is killed at `at`, s.
std::string killed(std::uint64_t seed, double at, const std::string& more) {
  return "seed: " + std::to_string(seed) +
         "\nworld: {boxes: [[-1, 16, -4, -3.8, 0, 2.5], [-1, 16, 3.8, 4, 0, 2.5], [-1.2, -1, -4, 4, 0, 2.5], "
         "[15, 15.2, -4, 4, 0, 2.5], [6, 6.4, -1, 1, 0, 2.5], [9, 10, -3.8, -3, 0, 1.5]], floor: 0, ceiling: "
         "3}\n"
         "duration: 35\nlink: wifi\nlidar: full\nperception: odometry\n"
         "robots:\n  - {id: r1, platform: wheeled, pose: [0, 2, 0]}\n"
         "basestations:\n  - {id: op1, pose: [0, 0]}\n"
         "script:\n  - {at: 1, by: op1, do: take r1}\n  - {at: 2, by: op1, do: goto r1 12 2}\n"
         "faults:\n  - {at: " +
         std::to_string(at) + ", crash: r1}\n" + more;
}

/// The same with a lidar of one ring.
std::string killed_planar(std::uint64_t seed, double at, const std::string& more) {
  std::string text = killed(seed, at, more);
  const std::string full = "lidar: full";
  return text.replace(text.find(full), full.size(), "lidar: planar");
}

std::uint64_t restart_seeds() {
  const char* wanted = std::getenv("ADIT_RESTART_SEEDS");
  return wanted ? std::strtoull(wanted, nullptr, 10) : 1;
}

TEST(PlaceAfterARestart, IsTheSameAndTheRobotGoesOn) {
  for (std::uint64_t seed = 1; seed <= restart_seeds(); ++seed) {
    const double at = 3.0 + 0.05 * static_cast<double>(seed * 37 % 160);
    const RunReport report =
        run_text(killed(seed, at,
                        "expect:\n  - {always: pose_within, m: 0.3}\n  - {always: no_collision}\n"
                        "  - {by: 34, robot: r1, near: [12, 2, 0.6]}\n"),
                 "killed.yaml");
    EXPECT_EQ(report.complaints(), std::vector<std::string>{})
        << "seed " << seed << ", killed at " << at << " s";
  }
}

TEST(PlaceAfterARestart, IsTheSameForALidarOfOneRing) {
  for (std::uint64_t seed = 1; seed <= restart_seeds(); ++seed) {
    const RunReport report =
        run_text(killed_planar(seed, 5.0,
                               "expect:\n  - {always: pose_within, m: 0.3}\n  - {always: no_collision}\n"
                               "  - {by: 34, robot: r1, near: [12, 2, 0.6]}\n"),
                 "planar.yaml");
    EXPECT_EQ(report.complaints(), std::vector<std::string>{}) << "seed " << seed;
  }
}

TEST(PlaceAfterARestart, IsUnknownWhenTheOdometryBeganAgainAsWellForALidarOfOneRing) {
  const RunReport report = run_text(killed_planar(1, 8.0,
                                                  "  - {at: 8.2, odometry_reset: r1}\n"
                                                  "expect:\n  - {at: 34, robot: r1, mode: hold}\n"),
                                    "planar.yaml");
  EXPECT_EQ(report.complaints(), std::vector<std::string>{});
}

TEST(PlaceAfterARestart, IsCorrectedWhenTheOdometryBeganAgainNearby) {
  // Rule 11 sees an error that stays.
  for (std::uint64_t seed = 1; seed <= restart_seeds(); ++seed) {
    const RunReport report =
        run_text(killed(seed, 2.7,
                        "  - {at: 2.8, odometry_reset: r1}\n"
                        "expect:\n  - {always: no_collision}\n  - {by: 34, robot: r1, near: [12, 2, 0.6]}\n"),
                 "killed.yaml");
    EXPECT_EQ(report.complaints(), std::vector<std::string>{}) << "seed " << seed;
  }
}

TEST(PlaceAfterARestart, IsUnknownWhenTheOdometryBeganAgainAsWell) {
  for (std::uint64_t seed = 1; seed <= restart_seeds(); ++seed) {
    const RunReport report = run_text(
        killed(
            seed, 8.0,
            "  - {at: 8.2, odometry_reset: r1}\n"
            "expect:\n  - {at: 12, robot: r1, mode: hold}\n  - {at: 34, robot: r1, mode: hold, holder: op1}\n"
            "  - {always: no_collision}\n"),
        "killed.yaml");
    EXPECT_EQ(report.complaints(), std::vector<std::string>{}) << "seed " << seed;
  }
}

TEST(PlaceAfterARestart, IsKnownAgainWhenTheOperatorSetsIt) {
  std::string text = killed(1, 8.0,
                            "  - {at: 8.2, odometry_reset: r1}\n  - {at: 14, crash: r1}\n"
                            "expect:\n  - {at: 13, by_operator: op1, refused: not_localised_here}\n"
                            "  - {at: 17, by_operator: op1, refused: not_localised_here}\n"
                            "  - {at: 24, robot: r1, mode: waypoint}\n");
  text.insert(text.find("faults:"),
              "  - {at: 12, by: op1, do: goto r1 12 2}\n  - {at: 16, by: op1, do: goto r1 12 2}\n"
              "  - {at: 20, by: op1, do: pose r1 6 2 0}\n  - {at: 22, by: op1, do: goto r1 12 2}\n");
  EXPECT_EQ(run_text(text, "killed.yaml").complaints(), std::vector<std::string>{});
}

/// A robot whose lidar is covered while its wheels turn, so that it believes to be 2 m away and turned round.
std::string carried(std::uint64_t seed, const std::string& more_boxes, const std::string& more) {
  return "seed: " + std::to_string(seed) +
         "\nworld: {boxes: [[-1, 16, -4, -3.8, 0, 2.5], [-1, 16, 3.8, 4, 0, 2.5], [-1.2, -1, -4, 4, 0, 2.5], "
         "[15, 15.2, -4, 4, 0, 2.5]" +
         more_boxes +
         "], floor: 0, ceiling: 3}\n"
         "duration: 40\nlink: wifi\nlidar: full\nperception: odometry\n"
         "robots:\n  - {id: r1, platform: wheeled, pose: [0, 2, 0]}\n"
         "basestations:\n  - {id: op1, pose: [0, 0]}\n"
         "script:\n  - {at: 1, by: op1, do: take r1}\n  - {at: 2, by: op1, do: goto r1 6 2}\n"
         "  - {at: 26, by: op1, do: goto r1 12 2}\n" +
         more +
         "faults:\n  - {at: 15, cover: r1, for: 4}\n  - {at: 15, slip: r1, wheels: [-0.8, 0.9], for: 3.5}\n";
}

TEST(Lidars, ARosetteAndTwoOfThemKeepThePose) {
  for (const char* lidars : {"{x: 0, y: 0, z: 0.5, pattern: rosette}",
                             "[{x: 0.4, y: 0, z: 0.5, topic: points, frame: lidar}, "
                             "{x: -0.5, y: 0.1, z: 0.5, yaw: 3.14159, topic: rear/points, frame: rear}]"}) {
    std::string text = carried(1, ", [6, 6.4, -1, 1, 0, 2.5]", "");
    text = text.substr(0, text.find("faults:")) +
           "expect:\n  - {always: no_collision}\n  - {always: pose_within, m: 0.3}\n"
           "  - {by: 39, robot: r1, near: [12, 2, 0.6]}\n";
    text.replace(text.find("pose: [0, 2, 0]"), 15,
                 std::string("pose: [0, 2, 0], sensors: {lidar: ") + lidars + "}");
    EXPECT_EQ(run_text(text, "lidars.yaml").complaints(), std::vector<std::string>{}) << lidars;
  }
}

TEST(LostRobot, FindsItsPlaceByWhatItSawBefore) {
  for (std::uint64_t seed = 1; seed <= restart_seeds(); ++seed) {
    const RunReport report =
        run_text(carried(seed,
                         ", [6, 6.4, -1, 1, 0, 2.5], [9, 10, -3.8, -3, 0, 1.5], [1, 3, -3.8, -1, 0, 2.5], "
                         "[-1, 0, 3, 3.8, 0, 2.5]",
                         "") +
                     "expect:\n  - {always: no_collision}\n  - {by: 39, robot: r1, near: [12, 2, 0.6]}\n",
                 "carried.yaml");
    EXPECT_EQ(report.complaints(), std::vector<std::string>{}) << "seed " << seed;
  }
}

TEST(LostRobot, StaysLostWhenItsSensorsAreRestarted) {
  // Places look alike here, so that only the operator can say where it is.
  const std::string text =
      carried(1, "", "") +
      "  - {at: 21, crash: r1/sensors}\n"
      "expect:\n  - {at: 20.5, by_operator: op1, notified: localisation_lost, robot: r1}\n"
      "  - {at: 27, by_operator: op1, refused: localisation_lost}\n"
      "  - {at: 39, robot: r1, near: [6, 2, 0.3]}\n";
  EXPECT_EQ(run_text(text, "restarted.yaml").complaints(), std::vector<std::string>{});
}

TEST(LostRobot, SaysWhenItMayBeTooFarAwayToSearchItsPlace) {
  std::string text = carried(1, "", "");
  text = text.substr(0, text.find("faults:")) +
         "faults:\n  - {at: 8, cover: r1, for: 16}\n  - {at: 8, slip: r1, wheels: [-1.9, 0.9], for: 15.5}\n"
         "expect:\n  - {by: 27, by_operator: op1, notified: place_not_searched, robot: r1}\n"
         "  - {at: 27, by_operator: op1, refused: localisation_lost}\n";
  EXPECT_EQ(run_text(text, "far.yaml").complaints(), std::vector<std::string>{});
}

TEST(SpinningWheels, EndAnAutonomousMode) {
  std::string text = carried(1, "", "  - {at: 28, by: op1, do: goto r1 12 2}\n");
  text = text.substr(0, text.find("faults:")) +
         "faults:\n  - {at: 4, slip: r1, wheels: [1, 0], for: 12}\n"
         "expect:\n  - {by: 6, by_operator: op1, notified: wheels_slip, robot: r1}\n"
         "  - {at: 12, robot: r1, mode: hold}\n  - {at: 25, robot: r1, mode: hold}\n"
         "  - {by: 39, robot: r1, near: [12, 2, 0.6]}\n";
  EXPECT_EQ(run_text(text, "spinning.yaml").complaints(), std::vector<std::string>{});
}

TEST(SpinningWheels, BeforeAModeDoNotEndIt) {
  std::string text = carried(1, "", "  - {at: 9, by: op1, do: goto r1 12 2}\n");
  text = text.substr(0, text.find("faults:")) +
         "faults:\n  - {at: 4, slip: r1, wheels: [1, 0], for: 9}\n"
         "expect:\n  - {at: 8.5, robot: r1, mode: manual}\n  - {at: 12.5, robot: r1, mode: waypoint}\n"
         "  - {by: 39, robot: r1, near: [12, 2, 0.6]}\n";
  text.replace(text.find("goto r1 6 2"), 11, "drive r1 0.3 0 0 --for 6");
  EXPECT_EQ(run_text(text, "spinning.yaml").complaints(), std::vector<std::string>{});
}

/// Drives back and forth through a hall with one fault, so that a pose of some seconds ago is metres away.
std::string drives(const std::string& fault, const std::string& expect) {
  std::string text = carried(1, ", [6, 6.4, -1, 1, 0, 2.5]", "");
  text = text.substr(0, text.find("script:")) +
         "script:\n  - {at: 1, by: op1, do: take r1}\n  - {at: 2, by: op1, do: goto r1 13 2}\n"
         "  - {at: 14, by: op1, do: goto r1 1 2}\n  - {at: 27, by: op1, do: goto r1 13 -2}\n";
  return text + "faults:\n  - " + fault + "\nexpect:\n" + expect;
}

TEST(ClocksOfDrivers, AnOdometryFiveSecondsAheadIsNotTakenForItsPast) {
  EXPECT_EQ(run_text(drives("{at: 5, driver_clock: r1, jump: 5, sensor: odometry}",
                            "  - {always: pose_within, m: 0.6}\n"),
                     "clock.yaml")
                .complaints(),
            std::vector<std::string>{});
}

TEST(LostRobot, StandsAmongPlacesThatLookAlikeUntilItsOperatorSaysWhereItIs) {
  const std::string expect = "expect:\n  - {at: 27, by_operator: op1, refused: localisation_lost}\n";
  const std::string place =
      "  - {at: 27.5, by: op1, do: mode r1 hold}\n  - {at: 28, by: op1, do: pose r1 6 2 0}\n  - {at: 29, by: "
      "op1, do: goto r1 12 2}\n";
  EXPECT_EQ(
      run_text(carried(1, "", "") + expect + "  - {at: 39, robot: r1, near: [6, 2, 0.3]}\n", "alike.yaml")
          .complaints(),
      std::vector<std::string>{});
  EXPECT_EQ(
      run_text(carried(1, "", place) + expect + "  - {by: 39, robot: r1, near: [12, 2, 0.6]}\n", "alike.yaml")
          .complaints(),
      std::vector<std::string>{});
}

}  // namespace
}  // namespace adit::sim
