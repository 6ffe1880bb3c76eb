// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/config/perception_level.hpp"
#include "core/geometry/pose.hpp"
#include "core/result/reason.hpp"
#include "core/time/time.hpp"
#include "core/wire/link.hpp"
#include "robot_agent/program/robot_config.hpp"
#include "sim/rehearsal/fault.hpp"
#include "sim/truth/exploration.hpp"
#include "sim/world/person.hpp"

/// A rehearsal as its YAML file says it; docs/rehearsal.md is the reference.
namespace adit::sim {

using BoxCorners = std::array<double, 6>;  ///< x0, x1, y0, y1, z0, z1, m

struct WorldSpec {
  std::filesystem::path map{};         ///< OctoMap; empty: none
  std::filesystem::path floor_plan{};  ///< map_server YAML; empty: none
  std::vector<BoxCorners> boxes{};
  double floor{0.0};
  double ceiling{3.0};
  double dust{0.0};  ///< LidarErrors::dust, [0, 0.5].
};

enum class LidarKind { full, planar };

struct RobotSpec {
  std::string id{};
  std::string platform{};         ///< Its name, as written.
  Pose2 pose{};                   ///< At the start, world frame.
  agent::RobotConfig settings{};  ///< Of its file and of the scenario, as the product's reader gives them.
  double charge{1.0};             ///< Charge of its battery at the start, [0, 1].
  double drain{1.0 / 14400.0};    ///< Charge that it loses a second, 1/s, [0, 1].
};

struct StationSpec {
  std::string id{};
  Eigen::Vector2d position{Eigen::Vector2d::Zero()};  ///< World frame, m.
};

/// A command line that an operator types at a given time.
struct ScriptLine {
  Duration at{};
  std::string by{};
  std::string command{};
};

/// Random commands: `commands` of them between `from` and `to`, each by one of `by`, to one of `robots`.
struct RandomScript {
  int commands{};
  Duration from{}, to{};
  std::vector<std::string> by{};
  std::vector<std::string> robots{};
  std::vector<std::string> verbs{};
  Eigen::Vector2d reach{3.0, 3.0};  ///< Largest distance of a random place from the start, along x and y, m.
};

/// Random faults: `faults` of them that begin between `from` and `to`, each of one of `kinds`.
struct RandomFaults {
  int faults{};
  Duration from{}, to{};
  std::vector<std::string> kinds{};  ///< Of random_fault_kinds(); empty: all that the scenario can have.
  int finds{};                       ///< Findings beside the faults, each of one robot.
};

struct NearExpectation {
  std::string robot{};
  double x{}, y{}, tolerance{};  ///< True position in the world, m.
};
/// What a robot says of itself, all at once.
struct StateExpectation {
  std::string robot{};
  std::optional<std::string> mode{};
  std::optional<std::string> holder{};  ///< Empty: none.
  std::optional<bool> locked{};
  std::optional<bool> stopped{};
  std::optional<NearExpectation> near{};  ///< Combined with the others: both must hold.
  std::optional<std::string> explore{};   ///< `exploring` also matches `travelling`.
};
struct AnswerExpectation {
  std::string by{};
  Reason refused{Reason::none};
};
/// A station has so many findings, of all robots, and so many whole photos of them.
struct FindingsExpectation {
  std::string by{};
  std::size_t findings{};
  std::optional<std::size_t> photos{};
};
/// That many live pictures of cameras arrived at a station since it started, of all robots.
struct PicturesExpectation {
  std::string by{};
  std::uint64_t least{};
};
/// The order of a convoy, as every member says.
struct ConvoyExpectation {
  std::vector<std::string> order{};
};
/// The robots are in that order along a line, the first farthest on; true positions.
struct InLineExpectation {
  std::vector<std::string> robots{};
  Eigen::Vector2d from{Eigen::Vector2d::Zero()}, to{Eigen::Vector2d::Zero()};  ///< m
};
/// The true distance of two robots' outlines is within these limits all the time, m.
struct GapExpectation {
  std::string a{}, b{};
  double min{}, max{};
};
/// The robot is never farther than this from where it was at the beginning, m.
struct StillExpectation {
  std::string robot{};
  double distance{};
};
/// The robot notified the operator of a matter.
struct NoticeExpectation {
  std::string by{};
  std::string code{};
  std::string robot{};
};
/// The robot gave that reason: it refused a command with it, notified an operator of it, or named it as why
/// it does not move.
struct ReasonExpectation {
  std::string robot{};
  Reason reason{Reason::none};
};
/// No robot that drives to a goal, and was not stopped, stays within 0.3 m for longer.
struct ProgressExpectation {
  Duration within{};
  std::vector<std::string> robots{};
};
struct NoCollision {
  bool caused{};  ///< Only contacts caused by a robot, see Collision.
};
/// No part of these robots' outlines ever leaves the rectangle, or enters it.
struct PlaceExpectation {
  bool inside{};
  ExplorationArea area{};
  std::vector<std::string> robots{};
};
/// The share of what can be seen at all that these robots truly saw, see ExplorationTruth.
struct ExploredExpectation {
  double share{};                         ///< At least, [0, 1].
  std::optional<ExplorationArea> area{};  ///< Nothing: everywhere.
  std::vector<std::string> robots{};      ///< Empty: any.
};
/// What a station's map holds of the truly seen surface, and how much of the map is wrong, see judge_map().
struct MapExpectation {
  std::string by{};
  std::optional<double> share{};  ///< At least, [0, 1].
  std::optional<double> wrong{};  ///< At most, [0, 1].
};
/// The robots' stated poses are never farther than this from the true ones, m.
struct PoseWithinExpectation {
  double distance{};
  std::vector<std::string> robots{};
};
/// The share of their way that all robots drove again, see RepeatedWay.
struct RepeatExpectation {
  double share{};  ///< At most, [0, 1].
};
/// Counted over the whole run.
struct AtLeast {
  std::string what{};  ///< `commands`, `refusals`, `faults`, or `distance` and `moving` (of every robot).
  double amount{};
};
struct Expectation {
  enum class When { at, by, always, during } when{When::always};
  Duration time{};  ///< `during`: the end.
  std::variant<StateExpectation, NearExpectation, AnswerExpectation, FindingsExpectation, NoCollision,
               ExploredExpectation, RepeatExpectation, AtLeast, ConvoyExpectation, InLineExpectation,
               GapExpectation, StillExpectation, NoticeExpectation, PlaceExpectation, MapExpectation,
               PoseWithinExpectation, ReasonExpectation, ProgressExpectation, PicturesExpectation>
      what{};
  int line{};          ///< In the scenario file.
  std::string text{};  ///< As written.
  Duration from{};     ///< Of `during`.
};

struct Scenario {
  std::filesystem::path file{};
  std::string text{};  ///< Text of the file.
  std::string name{};
  WorldSpec world{};
  Duration duration{};
  std::uint64_t seed{1};  ///< Used when the command line names none.
  wire::LinkProfile link{};
  LidarKind lidar{LidarKind::full};
  PerceptionLevel perception{PerceptionLevel::off};  ///< Of robots that do not name their own.
  double noise{1.0};                 ///< Scale of the errors of odometry and sensors, [0, 10]; 0: the truth.
  std::optional<double> dropouts{};  ///< LidarErrors::dropouts, unless its default, [0, 1].
  std::vector<RobotSpec> robots{};
  std::vector<StationSpec> stations{};
  std::vector<PersonSpec> people{};
  std::vector<ScriptLine> script{};  ///< By time.
  std::optional<RandomScript> random{};
  std::vector<Fault> faults{};  ///< By time.
  std::optional<RandomFaults> random_faults{};
  std::vector<Expectation> expectations{};

  const RobotSpec* robot(const std::string& id) const;
  const StationSpec* station(const std::string& id) const;
  /// Whether its exploration is judged.
  bool explores() const;
  /// Whether a station's map is judged.
  bool judges_maps() const;
};

}  // namespace adit::sim
