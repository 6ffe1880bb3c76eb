// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "basestation/fleet/fleet.hpp"
#include "basestation/send/answer.hpp"
#include "core/exec/executor.hpp"

namespace adit::station {

/// Parameters of the repeats of commands.
struct SenderParams {
  std::string name{};  ///< Name of the operator.
  Id id{};
  Duration repeat{std::chrono::milliseconds(100)};      ///< Period of the repeats of a command.
  Duration repeat_stop{std::chrono::milliseconds(50)};  ///< Period of the repeats of a stop.
  /// Time without an answer after which a command ends with `no_answer`.
  Duration give_up{std::chrono::seconds(3)};
  Duration give_up_stop{std::chrono::seconds(10)};
  /// Time after the start in which robots may not be discovered yet.
  Duration discovery_grace{std::chrono::seconds(5)};
};

/// Sends commands and repeats each until it is acknowledged. There is one lane per robot: its commands are
/// sent one after the other, robots never wait for each other, and a stop overtakes all queued commands.
///
/// A stop is also sent to a robot that was not heard yet. It is reported as sent and not acknowledged, and
/// is repeated until that robot answers it, or is heard and does not answer within `give_up_stop`. At most
/// `kMaxUnheard` such stops are sent: a new one replaces the oldest, which ends as not acknowledged.
class Sender {
 public:
  using Done = std::function<void(const Answer&)>;
  static constexpr std::size_t kMaxQueue = 16;    ///< Queued commands for one robot.
  static constexpr std::size_t kMaxUnheard = 16;  ///< Stops to robots that were not heard yet.

  Sender(SenderParams params, Executor& strand, wire::Participant& radio, Fleet& fleet);
  ~Sender();

  /// Creates the robot's writer before its first command, so that discovery is complete by then.
  void prepare(const std::string& robot);
  /// Sends a command. `done` is called once on the strand: with the robot's answer, no_answer, queue_full or
  /// wire_failed.
  void send(RobotCommand robot_command, Done done);
  /// Processes a robot's answer to this station.
  void hear(const contract::Acknowledgement& ack);
  /// Whether no command is queued or pending for that robot.
  bool idle(const std::string& robot) const;

  /// Ends the stops of robots that were not heard yet, and returns the names of those robots.
  std::vector<std::string> drop_unheard();

  const Counts& counts() const { return counts_; }
  /// Called with the result of a stop that had been reported as not acknowledged.
  std::function<void(const Answer&)> on_late{};

 private:
  struct Pending;
  struct Lane;
  Lane* lane(const std::string& robot);
  void start(Lane& lane, std::shared_ptr<Pending> pending);
  void transmit(Lane& lane, Pending& pending);
  void renumber(Lane& lane, Pending& pending);
  void tick(const std::string& robot, const std::shared_ptr<Pending>& pending);
  bool unheard(const std::string& robot) const { return fleet_.robot(robot) == nullptr; }
  /// Closes the lane of the oldest stop to a robot that was not heard, if `kMaxUnheard` of them are being
  /// sent.
  void make_room();
  /// Ends the stop of a lane, if any, and closes the lane.
  void close_lane(std::string robot, const std::string& why);
  /// Reports a stop of a robot that was not heard as sent and not acknowledged.
  void report_unheard(Pending& pending) const;
  /// Withdraws a command that was reported as unanswered: the robot must not execute it when the link
  /// returns.
  void withdraw(Lane& lane, const Pending& pending);
  void finish(Lane& lane, const std::shared_ptr<Pending>& pending, Answer answer);
  /// Whether the refusal has a temporary cause.
  bool worth_another(const Pending& pending, const contract::Acknowledgement& ack) const;

  SenderParams params_;
  Executor& strand_;
  wire::Participant& radio_;
  Fleet& fleet_;
  Time started_;
  std::map<std::string, std::shared_ptr<Lane>> lanes_;
  std::uint64_t first_seq_{1};  ///< First number of a new lane: above all numbers of closed lanes.
  Counts counts_{};
};

}  // namespace adit::station
