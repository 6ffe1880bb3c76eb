// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "core/wire/memory/simulated_network.hpp"
#include "robot_agent/motion/velocity_writer.hpp"
#include "sim/checker/checker.hpp"
#include "sim/rehearsal/digest.hpp"
#include "sim/rehearsal/report.hpp"

namespace adit::sim {

/// Where a robot was sent.
struct Goal {
  std::string robot{};
  Eigen::Vector2d position{Eigen::Vector2d::Zero()};  ///< m
};

/// What a robot last said of itself.
struct RobotWord {
  std::string mode{};
  Authority authority{};
  bool stopped{};
  int exploration{};      ///< As in BehaviourSent.
  bool drives_to_goal{};  ///< As in BehaviourSent.
  bool heard{};
  std::optional<Pose3> pose{};        ///< Its own estimate, map frame.
  Duration pose_sent{};               ///< When it sent that, virtual time.
  std::vector<std::string> convoy{};  ///< The robots of its convoy in their order.
};

/// Sees every frame of a rehearsal: feeds the checker, the digest and the counters, and keeps each robot's
/// last word. Robots and their helpers on the inner network are distinguished by machine name.
class Witness {
 public:
  static constexpr std::uint32_t kRadioDomain = 77;

  Witness(Checker& checker, std::vector<std::string> robots, std::vector<std::string> stations);

  /// The machine that runs a robot's driver; its parent's is `ROBOT/parent`.
  static std::string driver_machine(const std::string& robot) { return robot + "/driver"; }
  static std::string parent_machine(const std::string& robot) { return robot + "/parent"; }
  /// A second computer with the robot's name.
  static std::string twin_machine(const std::string& robot) { return robot + "/twin"; }

  /// The robot's driver obeys a /cmd_vel of that type alone; others are no word to it.
  void obeys(const std::string& robot, agent::VelocityType type);

  void see(const wire::SampleEvent& frame);
  void agent_started(const std::string& robot, Duration at, const wire::ParticipantId& participant);
  /// A fault begins; `text` says what.
  void fault(Duration at, std::string text) { note({}, at, std::move(text)); }
  void component_faulted(const std::string& robot, Duration at, const std::string& component);
  void disk_changed(const std::string& robot, Duration at, bool full);
  void clock_jumped(const std::string& robot, Duration at, Duration by);
  void agent_died(const std::string& robot, Duration at);
  void truth(const std::string& robot, Duration at, const Motion& truth);

  const RobotWord& word(const std::string& robot) const { return words_.at(robot); }
  const std::map<std::string, TopicResult, std::less<>>& topics() const { return topics_; }
  /// Commands of stations, repeats not counted, and the robots' first answers to them.
  const CommandResult& commands() const { return commands_; }
  /// Goals that robots accepted, map frame.
  const std::vector<Goal>& goals() const { return goals_; }
  const std::vector<TimedEvent>& events() const { return events_; }
  /// The robots' notifications by their codes, the first 2000.
  const std::vector<TimedEvent>& notifications() const { return notifications_; }
  /// Whether a robot notified that operator, or all of them, of a matter.
  bool notified(const std::string& by, const std::string& code, const std::string& robot) const {
    return notified_.contains({by, code, robot}) || notified_.contains({{}, code, robot});
  }
  /// Whether a robot gave that reason: in a refusal, a notification or its behaviour.
  bool reported(const std::string& robot, Reason reason) const { return reported_.contains({robot, reason}); }
  std::string digest() const { return digest_.text(); }

 private:
  void sent(const wire::SampleEvent& frame);
  void delivered(const wire::SampleEvent& frame);
  /// Whether the frame is of a twin; what that answered is observed.
  bool of_twin(const wire::SampleEvent& frame);
  void count(const std::string& robot, const AckSent& ack);
  void note(const std::string& robot, Duration at, std::string text);
  /// The robot whose agent or parent runs on that machine; empty: none.
  std::string robot_of(std::string_view machine) const;

  Checker& checker_;
  std::map<std::string, RobotWord> words_{};
  std::map<std::string, agent::VelocityType> obeyed_{};
  std::map<std::string, TopicResult, std::less<>> topics_{};
  std::set<std::string, std::less<>> stations_{};
  struct Asked {
    std::optional<std::array<double, 2>> goal{};
    bool answered{};
  };
  std::map<std::tuple<std::string, StationId, std::uint64_t>, Asked> asked_{};
  CommandResult commands_{};
  std::vector<Goal> goals_{};
  std::vector<TimedEvent> events_{}, notifications_{};
  std::set<std::tuple<std::string, std::string, std::string>> notified_{};  ///< Operator, code, robot.
  std::set<std::pair<std::string, Reason>> reported_{};
  Digest digest_{};
};

}  // namespace adit::sim
