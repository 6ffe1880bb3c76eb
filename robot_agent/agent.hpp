// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/component/fault.hpp"
#include "core/config/perception_level.hpp"
#include "core/config/platform.hpp"
#include "core/exec/executor.hpp"
#include "core/findings/finding.hpp"
#include "core/geometry/pose.hpp"
#include "core/log/log.hpp"
#include "core/result/result.hpp"
#include "core/store/disk.hpp"
#include "core/supervisor/restart_policy_engine.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/command/types.hpp"
#include "robot_agent/findings/detection.hpp"
#include "robot_agent/motion/map_frame.hpp"
#include "robot_agent/motion/map_watch.hpp"
#include "robot_agent/motion/velocity_writer.hpp"
#include "robot_agent/safeguard/safeguard_params.hpp"

namespace adit::nav {
class Planner;
struct PlannerLibrary;
}  // namespace adit::nav

namespace adit::agent {

class Decider;
class ModeTable;

struct AgentParams {
  std::string name{"r1"};  ///< See command::valid_robot_name().
  Platform platform{};
  PerceptionLevel perception{PerceptionLevel::off};
  Id id{};                ///< Stored on the robot's disk; all zero: drawn from the seed.
  std::uint64_t seed{1};  ///< Of the epoch; differs at each start of the agent.
  Pose2 start{};          ///< Map frame; the pose where odometry begins.
  double start_height{};  ///< Height of the ground at `start`, map frame, m; the z of odometry is relative to
                          ///< it.
  bool start_given{};  ///< `start` replaces the stored place, and the robot holds; false: a stored place is
                       ///< used.
  Duration lock_lease{300s};  ///< A lock expires after its holder was silent for this long; 0: never.
  /// Behaviour tree, on the configuration's search path. A tree that cannot be read, or contradicts the mode
  /// table, is refused: the agent runs in `hold` with the reason tree_refused.
  std::string tree{"trees/robot.xml"};
  std::shared_ptr<const ModeTable> modes{};  ///< The robot's modes; null: those that are shipped.
  /// Loads the tree file, for tests that replace the check against the mode table; empty: Decider::load.
  std::function<Result<std::unique_ptr<Decider>>(const std::string& file)> load_tree{};
  Duration planning{20ms};  ///< Duration of a planning cycle in rehearsal.
  std::shared_ptr<LogSink> log{};
  /// Returns the local planner's lookup tables for a platform, when several robots share them; empty: the
  /// agent computes its own.
  std::function<std::shared_ptr<const nav::PlannerLibrary>(const Platform&)> library{};
  /// Makes a local planner that replaces the one that the platform names; empty: the platform's.
  std::function<std::unique_ptr<nav::Planner>()> local_planner{};
  MapWatch watch_maps{};
  /// Stores the state that survives a restart; null: nothing is stored.
  std::shared_ptr<store::Disk> disk{};
  std::uint64_t boot{};  ///< Id of the computer's boot; odometry starts again at each boot; 0: unknown.
  bool resume_after_restart{
      true};  ///< An autonomous mode resumes after a restart; false: the robot holds, and its goal is stored.
  VelocityType velocity{};  ///< Message type of the driver's /cmd_vel.
  SafeguardParams safeguards{};
  bool carry_maps{false};     ///< Carries maps of other robots on to stations.
  std::size_t findings{512};  ///< Maximum number of stored findings, [1, 65536].
  DetectionParams detections{};
  ReportParams reports{};
  std::optional<ObjectsParams> objects{};       ///< Nothing: the agent detects no objects itself.
  perception::DetectorFactory make_detector{};  ///< Of `objects`; empty: they are refused.
  SupervisionParams supervision{};
  /// Requests a restart of the agent's process, because a component could not be restarted. Called once, on a
  /// strand of the agent; empty: the agent keeps running and sends zero to the driver.
  std::function<void(const std::string& why)> end{};
  /// Called at 20 Hz on the supervisor's strand while the supervisor and the command component are alive.
  std::function<void()> alive{};
};

/// The agent of one robot: discovery, command interface, behaviours, mux, navigation, driver and telemetry.
///
/// The components command, planner, router (if the platform has one) and sensors are supervised, and each is
/// restarted separately. The same class runs live and in rehearsal. Construct, start and destroy it outside
/// its strands; the runtime and the participants must outlive it.
class Agent {
 public:
  Agent(AgentParams params, Runtime& runtime, wire::Participant& radio, wire::Participant& robot);
  ~Agent();
  Agent(const Agent&) = delete;
  Agent& operator=(const Agent&) = delete;

  /// Errors: bad_argument (name, platform), those of the participants, and those of the disk if `start` is to
  /// replace a stored place and cannot be stored.
  Result<void> start();

  /// Executes a line of the robot's own console: "status", "unlock", "peers", "health", "restart COMPONENT",
  /// "policy COMPONENT auto|manual". The answer to a line that is not executed starts with kConsoleRefusal.
  /// `answer` runs on a strand of the agent, or never if that strand hangs.
  /// Callable from any thread, after start().
  void at_console(const std::string& line, std::function<void(const std::string&)> answer);

  /// Reports a finding. It is stored on the disk and sent until every station that is heard has it (rule 9).
  /// The agent sets its robot; id 0 is replaced by a new id, stamp 0 by the present time. If the finding is
  /// invalid or there is no room, all operators are notified. Callable from any thread live, after start().
  void report(findings::Finding finding);

  /// Changes a finding, or reports it if the robot does not have one of that id (any more). Stations get the
  /// newest content, at most every 2 s; stamp 0 is replaced by the present time. Notifications and threads:
  /// as report().
  void update(findings::Finding finding);
  /// Withdraws a finding: stations keep it and list it as withdrawn, until it is updated. Notifications and
  /// threads: as report().
  void withdraw(std::uint64_t id);

  /// Requests the pose of the odometry frame in the map, from which a correction is computed. `done` runs on
  /// `caller` exactly once, unless that strand ends first. Errors: no_answer (the command component is not
  /// running, or does not answer within 2 s), cancelled (it was restarted meanwhile, or the agent ended),
  /// queue_full. Call it on `caller`, after start().
  void map_frame(Executor& caller, std::function<void(const Result<MapFrame>&)> done);

  /// Corrects the pose of the odometry frame in the map, as SLAM does; this moves no robot (rule 7). `done`
  /// is called as for map_frame(), with the pose then in force. Errors: those of Frames::correct and of
  /// map_frame(). After no_answer and cancelled the correction may be in force; map_frame() returns the
  /// actual pose.
  void correct_map(Executor& caller, const MapFrame& corrected,
                   std::function<void(const Result<MapFrame>&)> done);

  /// Injects a fault: makes a callback on the strand of that component throw or never return.
  /// Components: command, planner, router (if the platform has one), sensors. Errors: bad_argument for
  /// another name. Callable from any thread live, after start().
  Result<void> inject(const std::string& component, ComponentFault fault);

 private:
  class CommandComponent;
  struct Context;
  struct Impl;
  AgentParams params_;
  Runtime& runtime_;
  wire::Participant& radio_;
  wire::Participant& robot_;
  std::unique_ptr<Impl> impl_{};
};

}  // namespace adit::agent
