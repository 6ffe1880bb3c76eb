#pragma once
#include <functional>
#include <memory>
#include <string>

#include "core/component/fault.hpp"
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
#include "robot_agent/motion/map_frame.hpp"
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
  std::string name{"r1"};  ///< 1 to 32 of [A-Za-z0-9_-]
  Platform platform{};
  Id id{};                    ///< kept on the robot's disk; all zero: drawn from the seed
  std::uint64_t seed{1};      ///< of the epoch; another one at each start
  Pose2 start{};              ///< map frame, where odometry begins
  double start_height{};      ///< Of the ground there, map frame, m; odometry's z counts from it.
  Duration lock_lease{300s};  ///< a lock lapses when its holder was silent so long; 0: never
  /// Behaviour tree, on the configuration's search path. A tree that cannot be read, or contradicts the mode
  /// table, is refused: the agent runs in `hold` with the reason tree_refused.
  std::string tree{"trees/robot.xml"};
  std::shared_ptr<const ModeTable> modes{};  ///< The robot's modes; null: those that are shipped.
  /// Loads that file, for tests that replace the check against the mode table; empty: Decider::load.
  std::function<Result<std::unique_ptr<Decider>>(const std::string& file)> load_tree{};
  Duration planning{20ms};  ///< what a planning cycle takes in rehearsal
  std::shared_ptr<LogSink> log{};
  /// What the local planner of that platform looks up, when several robots share it; empty: made here.
  std::function<std::shared_ptr<const nav::PlannerLibrary>(const Platform&)> library{};
  /// Makes a local planner of its own; empty: the one that the platform names.
  std::function<std::unique_ptr<nav::Planner>()> local_planner{};
  std::shared_ptr<store::Disk> disk{};  ///< what outlives the agent; null: nothing is kept
  std::uint64_t
      boot{};  ///< of this computer's start: after another one odometry is another one; 0: not known
  bool resume_after_restart{true};  ///< an autonomous mode goes on after a restart; false: hold, goal kept
  VelocityType velocity{};          ///< what the driver's /cmd_vel is
  SafeguardParams safeguards{};
  std::size_t findings{512};  ///< kept at most, [1, 65536]
  SupervisionParams supervision{};
  /// The agent's process is to end and to be started anew: a component could not be brought back. Called
  /// once, on a strand of the agent; empty: the agent stays as it is, with zero at the driver.
  std::function<void(const std::string& why)> end{};
  /// Called twenty times a second while supervisor and command component live, on the supervisor's strand.
  std::function<void()> alive{};
};

/// One robot's agent: discovery, command interface, behaviours, mux, navigation, driver, telemetry, composed
/// of components that a supervisor watches and makes anew, each alone: command, planner, sensors. The same
/// object live and in rehearsal. Made, started and destroyed outside its strands; runtime and wires must
/// outlive it.
class Agent {
 public:
  Agent(AgentParams params, Runtime& runtime, wire::Participant& radio, wire::Participant& robot);
  ~Agent();
  Agent(const Agent&) = delete;
  Agent& operator=(const Agent&) = delete;

  /// Errors: bad_argument (name, platform), those of the wires.
  Result<void> start();

  /// The robot's own console: "status", "unlock", "peers", "health", "restart COMPONENT", "policy COMPONENT
  /// auto|manual". `answer` runs on a strand of the agent, or never when that hangs. From any thread, after
  /// start().
  void at_console(const std::string& line, std::function<void(const std::string&)> answer);

  /// Something was found: kept on the disk, sent until every station that is heard has it (rule 9). Its robot
  /// is this one; id 0: it gets one; stamp 0: now. What is not taken (no room, no finding) is told to
  /// everybody. From any thread live, after start().
  void report(findings::Finding finding);

  /// Asks for the place of the odometry frame in the map, from which a correction is computed. `done` runs on
  /// `caller` exactly once, unless that strand ends first. Errors: no_answer (the command component is away,
  /// or does not answer within 2 s), cancelled (it was restarted meanwhile, or the agent ended), queue_full.
  /// Called on `caller`, after start().
  void map_frame(Executor& caller, std::function<void(const Result<MapFrame>&)> done);

  /// Corrects the place of the odometry frame in the map, as SLAM does; no robot moves by that (rule 7).
  /// `done` is called as for map_frame(), with the place then in force. Errors: those of Frames::correct and
  /// of map_frame(). After no_answer and cancelled the correction may be in force: map_frame() tells.
  void correct_map(Executor& caller, const MapFrame& corrected,
                   std::function<void(const Result<MapFrame>&)> done);

  /// For tests and rehearsals: a callback on the strand of that component throws or never returns.
  /// Components: command, planner, sensors. Errors: bad_argument for another name. From any thread live,
  /// after start().
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
