// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "core/config/platform.hpp"
#include "core/contract/camera.hpp"
#include "core/contract/robot.hpp"
#include "core/transfer/piece.hpp"
#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/carry/carrier.hpp"
#include "robot_agent/command/command_interface.hpp"
#include "robot_agent/discovery/directory.hpp"
#include "robot_agent/discovery/namesakes.hpp"

namespace adit::wire {
struct ComponentIo;
}

namespace adit::agent {

/// The agent's readers and writers on the radio domain. Passes received messages to the command component and
/// the directory, and numbers and sends the agent's messages. Runs on the command strand.
class RadioEdge {
 public:
  struct Dependencies {
    Directory& directory;
    Namesakes& namesakes;
    /// Calls a function with the command interface; does nothing while there is none.
    std::function<void(const std::function<void(CommandInterface&)>&)> commands;
    /// Runs a task that sends an answer, once the state that the answer reports is on disk.
    std::function<void(Task)> settle{};
    /// Handles a command and calls the function with the answer to this sample of it.
    std::function<void(const Command&, const std::function<void(const std::optional<Answer>&)>&)> command{};
    /// Takes what another robot said of itself; nothing: the beacon was malformed.
    std::function<void(const std::optional<TeamBeacon>& beacon, const wire::ParticipantId& from,
                       Time received)>
        beacon{};
    /// Takes what a station has of this robot's pieces.
    std::function<void(const std::string& station, const transfer::Ack& ack, const wire::ParticipantId& from)>
        pieces_acknowledged{};
    /// Takes a piece of another robot's map. Empty: this robot carries no maps.
    std::function<void(const contract::BulkPiece& piece, const wire::ParticipantId& from)> piece_to_carry{};
    /// Takes what a station looks at of cameras. Empty: this robot has none.
    std::function<void(const contract::CameraViews& views, const wire::ParticipantId& from)> cameras{};
    /// Takes the reason why what a robot or station announced was refused.
    std::function<void(const std::string& name, const std::string& why)> refused{};
  };

  /// `io`: the command component's, on the radio domain. Errors: those of the participant.
  static Result<std::unique_ptr<RadioEdge>> open(const wire::ComponentIo& io, const std::string& robot);
  ~RadioEdge();
  RadioEdge(const RadioEdge&) = delete;
  RadioEdge& operator=(const RadioEdge&) = delete;

  /// Passes received messages to the dependencies from now on; they must outlive this. Errors: those of the
  /// participant.
  Result<void> listen(Dependencies dependencies);

  /// Stops the reception of messages. Callable from any thread.
  void close();

  void send_authority(const CommandInterface& commands, Time now);
  /// Sends a message of this robot; its name is set here.
  void send_behaviour(contract::BehaviourState state);
  void send_state(contract::RobotState state);
  /// Sends the followed route; nothing before send_capabilities(), and for a platform without router.
  void send_route(contract::Route route);
  /// Sends a beacon to the other robots.
  void send(const TeamBeacon& beacon);
  /// Sends a piece of content to the stations, or to the carriers. `session`: of the sender.
  void send(const transfer::Piece& piece, std::uint32_t session);
  /// Opens the endpoints to the robots that carry maps, unless they are open; nothing is sent to them before.
  void reach_carriers();
  /// Sends a carrier's receipts to the robots that reach for carriers.
  void send(const transfer::PeerId& carrier,
            const std::vector<std::pair<std::string, transfer::Receipt>>& receipts);
  /// Sends the capabilities, and from now on a heartbeat once a second and when a participant appears.
  void send_capabilities(const Platform& platform, const Id& id, std::uint16_t protocol,
                         const ModeTable& modes = ModeTable::shipped());
  /// Sends the capabilities once more, with what this robot claims while it gives way to another one of its
  /// name.
  void send_claim(const std::optional<Namesakes::Claim>& claim);
  /// Reports the traffic since the last call. `inner_malformed`: number of malformed samples on the robot's
  /// inner network since the start; operators see it together with the radio's. `state_rate`: rate of
  /// RobotState that the link allows, Hz.
  void send_link_report(Time now, std::uint64_t inner_malformed, double state_rate);

 private:
  struct Endpoints;
  explicit RadioEdge(std::unique_ptr<Endpoints> endpoints);
  std::unique_ptr<Endpoints> endpoints_;
};

}  // namespace adit::agent
