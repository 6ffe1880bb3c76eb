// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "core/wire/link/rate_control.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/behaviour/behaviour.hpp"
#include "robot_agent/command/command_interface.hpp"
#include "robot_agent/motion/driver.hpp"
#include "robot_agent/motion/frames.hpp"
#include "robot_agent/radio/radio_edge.hpp"
#include "robot_agent/supervisor/agent_supervisor.hpp"
#include "robot_agent/telemetry/route_report.hpp"

namespace adit::agent {

/// Sends the robot's state, status and link report to the stations, at the rate that the link allows. Runs on
/// the command strand, as part of the command component.
class Telemetry {
 public:
  /// Sources and destinations of the reports; they must outlive the telemetry.
  struct Dependencies {
    RadioEdge& radio;
    wire::Participant& wire;  ///< The radio domain.
    wire::RateControl& rate;  ///< Rate of RobotState; the other reports follow it.
    Driver& driver;
    AgentSupervisor& watch;
    const Frames& frames;
    CommandInterface& commands;
    const Behaviour& behaviour;
  };

  explicit Telemetry(const Dependencies& dependencies) : dependencies_(dependencies) {}

  /// Sends authority, behaviour and the driver's health. `started`: start of the command component.
  void start(Time now, Time started);
  /// Adapts the rate to the link, and sends RobotState when it is due. At 10 Hz. `charge`: of the battery,
  /// [0, 1], negative while unknown; `sigma`: of the position, m.
  void send_state(Time now, float charge, Localisation localisation, double sigma);
  /// Sends the followed route when stations must see another one than before. At 10 Hz.
  void send_route(Time now, const contract::Route& route);
  /// Repeats the status for stations that joined late, and reports on the link. Once a second.
  void send_periodic(Time now);
  void send_authority(Time now);
  void send_behaviour(Time now);
  /// Compares the driver's health with the last call and reports a change. Returns whether the driver fell
  /// silent.
  bool driver_fell_silent(Time now);

 private:
  void follow_link(Time now);
  void report_driver(Time now);

  Dependencies dependencies_;
  RouteReport route_report_{};
  Time started_{};
  bool driver_was_alive_{};
  std::uint32_t seconds_{};  ///< Calls of send_periodic() so far.
};

}  // namespace adit::agent
