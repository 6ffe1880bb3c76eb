#pragma once
#include <memory>
#include <optional>

#include "core/component/component.hpp"
#include "core/supervisor/unit.hpp"
#include "core/wire/link/rate_control.hpp"
#include "robot_agent/agent.hpp"
#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/command/command_interface.hpp"
#include "robot_agent/common/rate_limit.hpp"
#include "robot_agent/discovery/directory.hpp"
#include "robot_agent/discovery/namesakes.hpp"
#include "robot_agent/discovery/peer_table.hpp"
#include "robot_agent/findings/sync.hpp"
#include "robot_agent/motion/driver.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/motion/mux.hpp"
#include "robot_agent/motion/navigation.hpp"
#include "robot_agent/motion/rival.hpp"
#include "robot_agent/motion/scans.hpp"
#include "robot_agent/notices/notices.hpp"
#include "robot_agent/radio/notifier.hpp"
#include "robot_agent/radio/radio_edge.hpp"
#include "robot_agent/safeguard/safeguards.hpp"
#include "robot_agent/state/restored.hpp"
#include "robot_agent/state/state_keeper.hpp"
#include "robot_agent/supervisor/agent_supervisor.hpp"
#include "robot_agent/telemetry/telemetry.hpp"

namespace adit::agent {

/// What outlives the command component: the endpoints that other machines know, who is there, the last known
/// safe state, and the way to the components beside it. Touched on the command strand, but for what says
/// otherwise.
struct Agent::Context {
  Context(Executor& command, const wire::ParticipantId& own)
      : peers(command), directory(peers), namesakes(own) {}

  std::unique_ptr<Notifier> notifier{};  ///< from any thread
  std::unique_ptr<RadioEdge> radio{};
  std::unique_ptr<Driver> driver{};
  PeerTable peers;
  Directory directory;
  Namesakes namesakes;
  Restored restored{};  ///< what was there at the start, or when the component was made anew
  std::unique_ptr<StateKeeper> keeper{};  ///< what the component gave last, here and on the disk
  std::unique_ptr<FindingSync> findings{};
  PlanService planner{"planner", 2};        ///< These are for any thread.
  std::unique_ptr<RouteServices> router{};  ///< Null: this robot has none.
  ScanService scans{"scan", 4};
  FrameServices frames{};
  AgentSupervisor* watch{};               ///< from any thread
  CommandComponent* command_component{};  ///< null while the command component is away
  std::uint32_t instances{};              ///< of the command component so far
  wire::Participant* wire{};              ///< the radio domain
  wire::RateControl rate{};               ///< of RobotState; the rest of the telemetry follows
};

/// The command component: command interface, behaviour, mux, navigation's light half. Everything in it is
/// made anew when it is restarted; what must survive that is put back in restore().
class Agent::CommandComponent : public Component {
 public:
  CommandComponent(const AgentParams& params, Executor& command, std::unique_ptr<Decider> decider,
                   Context& context);

  void odometry(const Pose3& odom, const Twist2& twist, std::uint64_t stamp, Time received);
  void scan(std::shared_ptr<PointCloud> points, std::uint64_t stamp, Time received);
  void battery(float charge);
  void external(const Twist2& velocity, Time received);
  /// Somebody else writes velocities to this robot's driver.
  void rival(const wire::ParticipantId& writer, Time received);
  void commands(const std::function<void(CommandInterface&)>& use);
  /// The route to a place (map frame, m): `done` is called once, within half a second.
  void find_route(const Eigen::Vector3d& goal, std::function<void(const Result<PlannedRoute>&)> done);
  std::string at_console(const std::string& line);
  /// What must survive, as it is now.
  void keep();

 protected:
  Result<void> on_start() override;
  void on_stop() override;

 private:
  /// The last known safe state, before anything is sent or heard.
  void restore();
  /// What was restored is of this computer's present start.
  bool same_boot() const;
  void beat();
  void listen_first(Time at);
  void watch_driver();
  /// The odometry began again elsewhere: zero, hold, and a new local map.
  void odometry_jumped();
  Result<void> set_pose(const Pose2& pose);
  Result<MapFrame> correct_map(const MapFrame& corrected);
  /// Whether that stamp is a little newer than the odometry: the next sample brings the pose of then.
  bool is_ahead(std::uint64_t stamp) const;
  void add_waiting_scan();
  /// Holds while this robot gives way to another one of its name.
  void watch_namesakes(Time at);
  void send_findings();
  Facts sense(Time now) const;
  CommandInterface::Outputs command_outputs();
  /// The table of peers never evicts the holder.
  void note_holder();
  Behaviour::Inputs behaviour_inputs();
  Behaviour::Outputs behaviour_outputs();
  Navigation::Outputs navigation_outputs();

  AgentParams params_;
  Context& context_;
  Frames frames_;
  Navigation navigation_;
  Mux mux_;
  Behaviour behaviour_;
  CommandInterface commands_;
  Notices notices_;
  Safeguards safeguards_;
  Telemetry telemetry_;
  struct WaitingScan {
    std::shared_ptr<PointCloud> points{};
    std::uint64_t stamp{};
    Time received{};
  };
  std::optional<WaitingScan> waiting_scan_{};  ///< For odometry as new as it is.
  Time started_{};
  std::optional<Time> holder_heard_{};  ///< First time since the start that the holder was heard.
  std::optional<Time> jump_told_{};
  RivalWatch rivals_;
  bool gives_way_{};                     ///< to another robot of its name
  RateLimit<bool> namesakes_told_{10s};  // by whether it gives way
  std::vector<Timer> timers_{};
};

}  // namespace adit::agent
