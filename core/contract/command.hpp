// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/command/request.hpp"
#include "core/contract/common.hpp"
#include "core/geometry/pose.hpp"
#include "core/result/result.hpp"

namespace adit::radio {
class Command;
class Joystick;
class Acknowledgement;
}  // namespace adit::radio

namespace adit::contract {

/// A command of a station to one robot.
struct Command {
  std::string robot{};
  std::string station{};  ///< The operator's name; not checked: each command gets an answer.
  Id station_id{};
  Epoch epoch{};        ///< Of the authority; ignored for take, stop, query and plan.
  std::uint64_t seq{};  ///< Per station process and robot, from 1.
  command::Request request{command::verb("query")};
  std::optional<Error> invalid{};  ///< Why the arguments are refused; `request` then has only its row.
};

radio::Command encode(const Command& command);
/// A name that is too long becomes one of 32 bytes that is not valid: a plainly cut name could be another
/// station's. Arguments are checked against the command table.
Command decode(const radio::Command& sample);

/// A sample of manual control.
struct Joystick {
  std::string robot{};
  Id station_id{};
  Epoch epoch{};
  std::uint64_t seq{};
  std::uint64_t echo{};  ///< The last RobotState::stamp received, ns.
  Twist2 twist{};        ///< Body frame, with the precision of a float; vz is not sent.
  bool operator==(const Joystick&) const = default;
};

radio::Joystick encode(const Joystick& sample);
/// The numbers may be any: what is refused for them gets an answer.
Joystick decode(const radio::Joystick& sample);

/// The route over the ground that a robot would take. Map frame, m.
struct PlannedRoute {
  static constexpr std::size_t kMaxCorners = 24;  ///< An acknowledgement has no room for more.

  double length{};
  double unknown_length{};                ///< Length through space that was not observed yet, m.
  std::size_t corners{};                  ///< Of the complete route, its start and its goal included.
  std::vector<Eigen::Vector3d> points{};  ///< The first corners, at most kMaxCorners; z may be NaN.
};

/// The answer to a command: exactly one for each command and repeat.
struct Acknowledgement {
  static constexpr std::size_t kMaxSentText = 200;  ///< The complete message stays below 512 bytes.

  std::string robot{};
  std::string station{};  ///< Of the command.
  Id station_id{};
  std::uint64_t seq{};          ///< Of the command; 0 for a refused joystick sample.
  Reason reason{Reason::none};  ///< `none`: the command was accepted.
  std::string text{};
  std::string holder{};                 ///< Empty: no station has authority over the robot.
  Epoch epoch{};                        ///< After the command.
  std::optional<PlannedRoute> route{};  ///< Of an accepted `plan`.
  bool accepted() const { return reason == Reason::none; }
};

/// A text or a name that is too long is cut, so that the answer is sent in any case.
radio::Acknowledgement encode(const Acknowledgement& answer);
/// Returns nothing if the robot has no valid name, or if the answer is neither accepted nor has a reason. A
/// malformed route is left out.
std::optional<Acknowledgement> decode(const radio::Acknowledgement& sample);

}  // namespace adit::contract
