// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <optional>

#include "core/component/component.hpp"
#include "core/findings/photo_source.hpp"
#include "core/supervisor/unit.hpp"
#include "core/wire/link/rate_control.hpp"
#include "robot_agent/agent.hpp"
#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/camera/camera_calls.hpp"
#include "robot_agent/camera/shot_source.hpp"
#include "robot_agent/command/command_interface.hpp"
#include "robot_agent/command/map_commands.hpp"
#include "robot_agent/common/rate_limit.hpp"
#include "robot_agent/content/content_sender.hpp"
#include "robot_agent/convoy/convoy.hpp"
#include "robot_agent/discovery/directory.hpp"
#include "robot_agent/discovery/namesakes.hpp"
#include "robot_agent/discovery/peer_table.hpp"
#include "robot_agent/findings/detection_input.hpp"
#include "robot_agent/findings/finding_source.hpp"
#include "robot_agent/findings/report_input.hpp"
#include "robot_agent/motion/driver.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/motion/grip_watch.hpp"
#include "robot_agent/motion/mux.hpp"
#include "robot_agent/motion/navigation.hpp"
#include "robot_agent/motion/rival.hpp"
#include "robot_agent/motion/router_client.hpp"
#include "robot_agent/motion/scans.hpp"
#include "robot_agent/motion/topic_types.hpp"
#include "robot_agent/notices/notices.hpp"
#include "robot_agent/objects/objects_calls.hpp"
#include "robot_agent/perception/map_keeper.hpp"
#include "robot_agent/place/localiser.hpp"
#include "robot_agent/radio/notifier.hpp"
#include "robot_agent/radio/radio_edge.hpp"
#include "robot_agent/safeguard/safeguards.hpp"
#include "robot_agent/stairs/stairs_part.hpp"
#include "robot_agent/stairs/stairs_reporter.hpp"
#include "robot_agent/state/restored.hpp"
#include "robot_agent/state/state_keeper.hpp"
#include "robot_agent/supervisor/agent_supervisor.hpp"
#include "robot_agent/team/beacon_rate.hpp"
#include "robot_agent/telemetry/telemetry.hpp"

namespace adit::agent {

/// The objects that outlive the command component: the endpoints that other computers know, the peers, the
/// last known safe state, and the services of the other components. Used on the command strand unless noted
/// otherwise.
struct Agent::Context {
  Context(Executor& command, const wire::ParticipantId& own)
      : peers(command), directory(peers), namesakes(own) {}

  std::unique_ptr<Notifier> notifier{};  ///< From any thread.
  std::unique_ptr<RadioEdge> radio{};
  std::unique_ptr<InputFaults> inputs{};  ///< From any thread.
  std::shared_ptr<StaticFrames> static_frames{std::make_shared<StaticFrames>()};
  std::shared_ptr<OneSource> odometry_source{std::make_shared<OneSource>()};
  std::unique_ptr<Driver> driver{};
  PeerTable peers;
  Directory directory;
  Namesakes namesakes;
  Restored restored{};                    ///< State at the start, or when the component was restarted.
  std::unique_ptr<StateKeeper> keeper{};  ///< The component's last state, in memory and on the disk.
  std::unique_ptr<FindingSource> findings{};
  std::unique_ptr<findings::PhotoStore> photos{};
  std::unique_ptr<findings::PhotoSources> photo_sources{};
  std::unique_ptr<DetectionInput> detections{};
  std::unique_ptr<ReportInput> reports{};
  PlanService planner{"planner", 2};        ///< The services are callable from any thread.
  std::unique_ptr<RouteServices> router{};  ///< Null: this robot has no router.
  ScanService scans{"scan", 4};
  PlaceMemory place{};
  std::uint32_t odometries{};  ///< Instances of the odometry so far; by the sensors component only.
  FrameServices frames{};
  std::unique_ptr<MapKeeper> map{};          ///< Null: this robot makes no map.
  std::unique_ptr<Carrier> carrier{};        ///< Null: this robot carries no maps.
  std::unique_ptr<ContentSender> content{};  ///< Of the findings and the maps.
  MapService map_insertion{"map insertion", 2};
  CameraService cameras{"cameras", 4};
  ObjectsService objects_search{"objects", 2};
  std::unique_ptr<DetectionReporter> objects{};  ///< Null: this robot detects no objects.
  PlaceService place_then{"place of a picture", 16};
  std::unique_ptr<ShotSource> shots{};  ///< Null: this robot has no camera.
  StairsService stairs_search{"stairs", 2};
  std::uint32_t object_parts{};     ///< Instances of the component `objects` so far; by itself only.
  std::uint32_t camera_parts{};     ///< Instances of the component `cameras` so far; by itself only.
  std::uint32_t stairs_searches{};  ///< Instances of the search so far; by the stairs component only.
  std::unique_ptr<StairsReporter> stairs{};  ///< Null: this robot seeks no staircases.
  AgentSupervisor* watch{};                  ///< From any thread.
  CommandComponent* command_component{};     ///< Null while the command component is not running.
  std::uint32_t instances{};                 ///< Number of instances of the command component so far.
  wire::Participant* wire{};                 ///< The radio domain.
  wire::Participant* robot_wire{};           ///< The robot domain.
  wire::RateControl rate{};                  ///< Rate of RobotState; the rest of the telemetry follows.
};

/// The command component: command interface, behaviour, mux, and the part of navigation without heavy
/// computation. A restart rebuilds all of it; restore() restores the state that must survive.
class Agent::CommandComponent : public Component {
 public:
  CommandComponent(const AgentParams& params, Executor& command, std::unique_ptr<Decider> decider,
                   Context& context);

  void odometry(const Pose3& odom, const Twist2& twist, std::uint64_t stamp, Time received);
  void battery(float charge);
  void external(const Twist2& velocity, Time received);
  /// Reports another participant that writes velocities to this robot's driver.
  void rival(const wire::ParticipantId& writer, Time received);
  /// Reports that what a robot or station announced of itself is ignored, once in 10 s.
  void announcement_refused(const std::string& name, const std::string& why);
  void commands(const std::function<void(CommandInterface&)>& use);
  /// Handles a command; see MapCommands::handle().
  void handle(const Command& command, const MapCommands::Answered& answered);
  std::string at_console(const std::string& line);
  /// Passes on what a station looks at of this robot's cameras.
  void look(const transfer::PeerId& station, std::vector<contract::CameraView> views);
  /// Stores the state that must survive a restart.
  void keep();
  /// Sends the pieces of findings and maps that are ready, as the link allows.
  void send_pieces();

 protected:
  Result<void> on_start() override;
  void on_stop() override;

 private:
  /// Restores the last known safe state, before any message is sent or processed.
  void restore();
  /// Whether the restored state is from the computer's present boot.
  bool same_boot() const;
  /// The components that live and fail with this one.
  std::array<Component*, 3> parts() { return {&router_, &navigation_, &localiser_}; }
  void beat();
  void listen_first(Time at);
  /// The route that the robot follows at this time.
  contract::Route followed_route(Time at) const;
  /// Notifies the holder when the wheels slip, and ends an autonomous mode when the body is stuck.
  void watch_grip(const OdometryReport& report, Time at);
  void watch_driver();
  /// Looks at who else uses the topics of the robot domain.
  void watch_topics(Time at);
  /// Keeps the robot in hold while it gives way to another one of its name.
  void watch_namesakes(Time at);
  /// RouterClient::check_goal(), if the robot knows its place.
  void check_goal(const Eigen::Vector3d& goal, bool replace, const RouterClient::Done<GoalReport>& done);
  /// Takes a scan with its poses.
  void located(std::shared_ptr<Scan> scan, const LidarScan& lidar);
  /// Offers a scan to the map, in the odometry frame.
  void add_to_map(const std::shared_ptr<const Scan>& scan);
  /// Offers each scan to the search for staircases, and reports those that it finds.
  void seek_stairs(const std::shared_ptr<const Scan>& scan);
  void seek_objects(const std::shared_ptr<const Scan>& scan, const LidarScan& lidar);
  /// Those that this robot found, odometry frame.
  std::vector<Staircase> known_stairs() const;
  /// Sends findings and maps to the stations, or its map to carriers, as the link allows.
  void send_content();
  /// Asks the component `cameras` for the pictures that it took.
  void ask_cameras(CameraOrder order);
  /// Where the robot was when a picture was taken.
  PlaceThen place_then(const PlaceQuery& query) const;
  /// Sends this robot's state to the other robots, when the link allows.
  void send_beacon(Time at);
  Facts sense(Time now) const;
  CommandInterface::Outputs command_outputs();
  /// Passes the holder to the table of peers, which never evicts it.
  void note_holder();
  Behaviour::Inputs behaviour_inputs();
  Behaviour::Outputs behaviour_outputs();
  Navigation::Outputs navigation_outputs();
  Localiser::Outputs localiser_outputs();
  Convoy::Inputs convoy_inputs();
  RightOfWay::Outputs right_of_way_outputs();
  /// Lets RightOfWay look at the other robots.
  void give_way(Time at);
  /// The other robots for the router, odometry frame.
  std::vector<TeamRobot> team(Time at) const;

  AgentParams params_;
  Context& context_;
  Frames frames_;
  RouterClient router_;
  Navigation navigation_;
  Mux mux_;
  Convoy convoy_;
  RightOfWay right_of_way_;
  Behaviour behaviour_;
  CommandInterface commands_;
  MapCommands map_commands_;
  Notices notices_;
  Safeguards safeguards_;
  Localiser localiser_;
  Telemetry telemetry_;
  GripWatch grip_{};
  std::uint64_t modes_seen_{};  ///< Behaviour::modes_begun() at the last scan.
  Time looked_ahead_{};         ///< When the map's focus was set last.
  Time started_{};
  std::optional<Time> holder_heard_{};  ///< First heartbeat of the holder since the start.
  RivalWatch rivals_;
  std::vector<TopicUse> topics_;             ///< Of the robot domain.
  int disobeyed_{};                          ///< Looks in a row without a reader of the velocities.
  bool gives_way_{};                         ///< It gives way to another robot of its name.
  RateLimit<bool> namesakes_reported_{10s};  // The key is `gives_way_`.
  RateLimit<int> refusals_reported_{10s};    // Under one key: a stranger may invent any number of names.
  std::uint64_t camera_batch_{};             ///< Of the last answer of the component `cameras`.
  bool cameras_active_{};                    ///< A picture is wanted, or is being taken.
  BeaconRate beacon_rate_{};
  std::uint32_t beats_{};    ///< Number of calls of beat().
  std::uint32_t beacons_{};  ///< Number of beacons sent.
  std::vector<Timer> timers_{};
};

}  // namespace adit::agent
