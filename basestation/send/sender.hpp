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

/// How often and how long a command is repeated.
struct SenderParams {
  std::string name{};  ///< the operator's
  Id id{};
  Duration repeat{std::chrono::milliseconds(100)};      ///< between repeats of a command
  Duration repeat_stop{std::chrono::milliseconds(50)};  ///< between repeats of a stop
  Duration give_up{std::chrono::seconds(3)};            ///< no_answer after this
  Duration give_up_stop{std::chrono::seconds(10)};
  Duration discovery_grace{std::chrono::seconds(5)};  ///< after the start: robots may not be discovered yet
};

/// Sends commands and repeats each until it is acknowledged. One lane per robot: its commands go one after
/// the other, robots never wait for each other, and a stop overtakes all that waits.
///
/// A stop goes out to a robot that was not heard yet, too. It is reported as sent and not acknowledged, and
/// is repeated until that robot answers it, or is heard and does not answer within `give_up_stop`. At most
/// `kMaxUnheard` such stops go out: the oldest one gives way to a new one, and ends as not acknowledged.
class Sender {
 public:
  using Done = std::function<void(const Answer&)>;
  static constexpr std::size_t kMaxQueue = 16;    ///< commands that wait for one robot
  static constexpr std::size_t kMaxUnheard = 16;  ///< robots that were sent a stop and were not heard yet

  Sender(SenderParams params, Executor& strand, wire::Participant& radio, Fleet& fleet);
  ~Sender();

  /// Makes the robot's writer ahead of its first command, so that discovery has happened by then.
  void prepare(const std::string& robot);
  /// `done` is called once on the strand: with the robot's answer, no_answer, queue_full or wire_failed.
  void send(RobotCommand robot_command, Done done);
  void hear(const radio::Acknowledgement& sample, const wire::SampleInfo& info);
  /// True when nothing waits for that robot.
  bool idle(const std::string& robot) const;

  /// Ends the stops of robots that were not heard yet, and returns the names of those robots.
  std::vector<std::string> drop_unheard();

  const Counts& counts() const { return counts_; }
  /// Each command as it first goes out.
  std::function<void(const RobotCommand&, std::uint64_t seq)> on_sent{};
  /// How a stop ended that had been reported as not acknowledged.
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
  /// Closes the lane of the oldest stop to a robot that was not heard, if `kMaxUnheard` of them go out.
  void make_room();
  /// Ends the stop of a lane, if any, and closes the lane.
  void close_lane(std::string robot, const std::string& why);
  /// Reports a stop of a robot that was not heard as sent and not acknowledged.
  void report_unheard(Pending& pending) const;
  /// What the operator was told is without answer must not be obeyed when the link comes back.
  void withdraw(Lane& lane, const Pending& pending);
  void finish(Lane& lane, const std::shared_ptr<Pending>& pending, Answer answer);
  /// A refusal for a cause that passes.
  bool worth_another(const Pending& pending, const radio::Acknowledgement& sample) const;

  SenderParams params_;
  Executor& strand_;
  wire::Participant& radio_;
  Fleet& fleet_;
  Time started_;
  std::map<std::string, std::shared_ptr<Lane>> lanes_;
  std::uint64_t first_seq_{1};  ///< Of a new lane: above all numbers of the lanes that were closed.
  Counts counts_{};
};

}  // namespace adit::station
