#pragma once
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>

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
};

/// Sends commands and repeats each until it is acknowledged. One lane per robot: its commands go one after
/// the other, robots never wait for each other, and a stop overtakes all that waits.
class Sender {
 public:
  using Done = std::function<void(const Answer&)>;
  static constexpr std::size_t max_queue = 16;  ///< commands that wait for one robot

  Sender(SenderParams params, Executor& strand, wire::Wire& radio, Fleet& fleet);
  ~Sender();

  /// Makes the robot's writer ahead of its first command, so that discovery has happened by then.
  void prepare(const std::string& robot);
  /// `done` is called once on the strand: with the robot's answer, no_answer, queue_full or wire_failed.
  void send(Order order, Done done);
  void hear(const radio::Acknowledgement& sample, const wire::SampleInfo& info);
  /// True when nothing waits for that robot.
  bool idle(const std::string& robot) const;

  const Counts& counts() const { return counts_; }
  /// Each command as it first goes out.
  std::function<void(const Order&, std::uint64_t seq)> on_sent{};

 private:
  struct Pending;
  struct Lane;
  Lane* lane(const std::string& robot);
  void start(Lane& lane, std::shared_ptr<Pending> pending);
  void transmit(Lane& lane, Pending& pending);
  void renumber(Lane& lane, Pending& pending);
  void tick(const std::string& robot, const std::shared_ptr<Pending>& pending);
  /// What the operator was told is without answer must not be obeyed when the link comes back.
  void withdraw(Lane& lane, const Pending& pending);
  void finish(Lane& lane, const std::shared_ptr<Pending>& pending, Answer answer);
  /// A refusal for a cause that passes.
  bool worth_another(const Pending& pending, const radio::Acknowledgement& sample) const;

  SenderParams params_;
  Executor& strand_;
  wire::Wire& radio_;
  Fleet& fleet_;
  Time started_;
  std::map<std::string, std::unique_ptr<Lane>> lanes_;
  Counts counts_{};
};

}  // namespace adit::station
