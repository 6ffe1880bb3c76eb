#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/config/platform.hpp"
#include "core/findings/finding.hpp"
#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/command/command_interface.hpp"
#include "robot_agent/discovery/directory.hpp"
#include "robot_agent/discovery/namesakes.hpp"

namespace adit::wire {
struct ComponentIo;
}

namespace adit::agent {

/// The state of the robot that goes out ten times a second.
struct RobotReport {
  Pose2 pose{};         ///< map frame
  double z{};           ///< m
  Twist2 twist{};       ///< body frame
  float battery{-1.0};  ///< 0..1; negative: not known
};

/// The radio domain: what arrives goes to the command interface and the directory, what we say goes out. All
/// on the command strand. Every message is numbered here.
class RadioEdge {
 public:
  struct Dependencies {
    Directory& directory;
    Namesakes& namesakes;
    /// Runs it with the command interface; not at all while there is none.
    std::function<void(const std::function<void(CommandInterface&)>&)> commands;
    /// Runs what gives an answer once all that it tells of is on disk.
    std::function<void(Task)> settle{};
    /// The route to a place (map frame, m): `done` is called once, within half a second.
    std::function<void(const Eigen::Vector3d& goal, std::function<void(const Result<PlannedRoute>&)> done)>
        find_route{};
    /// A station has these findings of ours on its disk.
    std::function<void(const Id& station, std::span<const std::uint64_t> ids)> findings_kept{};
  };

  /// `io`: the command component's, on the radio domain. Errors of the wire.
  static Result<std::unique_ptr<RadioEdge>> open(const wire::ComponentIo& io, const std::string& robot);
  ~RadioEdge();
  RadioEdge(const RadioEdge&) = delete;
  RadioEdge& operator=(const RadioEdge&) = delete;

  /// From now on the parts hear what arrives; they must outlive this. Errors of the wire.
  Result<void> listen(Dependencies dependencies);

  /// Nothing is heard any more. From any thread.
  void close();

  /// `kept`: how many there are; `overflowed`: given up or not taken.
  void send(const findings::Finding& finding, std::size_t kept, std::uint32_t overflowed);
  void send_authority(const CommandInterface& commands, Time now);
  void send_behaviour(const BehaviourView& view, const std::vector<ModeOption>& options);
  void send_state(const RobotReport& report, std::uint64_t stamp);
  /// And from now on a sign of life once a second, and when somebody appears.
  void send_capabilities(const Platform& platform, const Id& id, std::uint16_t protocol,
                         const ModeTable& modes = ModeTable::shipped());
  /// Sends the capabilities once more, with what this robot claims while it gives way to another one of its
  /// name.
  void send_claim(const std::optional<Namesakes::Claim>& claim);
  /// What passed on the wire since the last call. `inner_malformed`: samples on the robot's inner network
  /// that were none, since the start; operators see them with the radio's.
  /// `state_rate`: RobotStates a second, as the link lets it.
  void send_link_report(Time now, std::uint64_t inner_malformed, double state_rate);

 private:
  struct Endpoints;
  explicit RadioEdge(std::unique_ptr<Endpoints> endpoints);
  std::unique_ptr<Endpoints> endpoints_;
};

}  // namespace adit::agent
