// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>

#include "adit/authority.h"
#include "adit/command.h"
#include "adit/robot.h"
#include "core/geometry/pose.hpp"
#include "sim/checker/observation.hpp"
#include "sim/defects/defect.hpp"
#include "sim/defects/interceptor.hpp"

namespace adit::sim {

/// A command or joystick sample and who sent it.
template <class T>
struct From {
  T sample{};
  wire::SampleInfo info{};
};
using CommandFrom = From<radio::Command>;
using StickFrom = From<radio::Joystick>;

/// An interceptor that decodes what it sees, and remembers what robot and stations last said.
class RadioInterceptor : public Interceptor {
 public:
  /// `strand`: any of the agent's machine, for its clock.
  explicit RadioInterceptor(std::shared_ptr<Executor> strand) : strand_(std::move(strand)) {}

  std::vector<Arrival> received(Arrival arrival) final;
  std::vector<Cdr> sent(const wire::TopicInfo& topic, Cdr cdr) final;

 protected:
  /// What arrives instead of a command. The default is the command itself.
  virtual void on_command(const CommandFrom& command, std::vector<Arrival>& out);
  /// What arrives instead of a joystick sample.
  virtual void on_stick(const StickFrom& stick, std::vector<Arrival>& out);
  /// What arrives instead of a sample of another topic.
  virtual void on_other(Arrival arrival, std::vector<Arrival>& out);
  /// An answer leaves. False: it does not.
  virtual bool on_answer(radio::Acknowledgement&) { return true; }
  virtual void on_authority(radio::AuthorityStatus&) {}
  virtual void on_behaviour(radio::BehaviourState&) {}
  virtual void on_state(radio::RobotState&) {}
  /// A velocity leaves for the driver (body frame).
  virtual void on_velocity(Twist2&) {}

  static Arrival arrival(const CommandFrom& command);
  static Arrival arrival(const StickFrom& stick);

  Time now() const { return strand_->now(); }
  /// The last authority that the robot published; before the first its holder is empty.
  const radio::AuthorityStatus& authority() const { return authority_; }
  bool held_by(const StationId& station) const {
    return !authority_.holder().empty() && authority_.holder_id() == station;
  }
  /// The participant that spoke last for the holder's station.
  std::optional<wire::ParticipantId> holders_participant() const;
  /// The mode that the robot published last; empty before the first.
  const std::string& mode() const { return mode_; }
  bool drives_by_hand() const { return mode_ == "manual" || mode_ == "smart_joystick"; }
  /// The stamp of the robot's last state.
  std::uint64_t stamp() const { return stamp_; }
  /// The holder's last joystick sample under the authority in force, and when it arrived.
  const Twist2& stick() const { return stick_; }
  std::optional<Duration> stick_age() const;
  /// The last velocity other than zero that left.
  const Twist2& last_motion() const { return last_motion_; }
  /// The last velocity that left is zero.
  bool stands() const { return stands_; }

 private:
  bool change(const wire::TopicInfo& topic, Cdr& cdr);

  std::shared_ptr<Executor> strand_;
  radio::AuthorityStatus authority_{};
  std::map<StationId, wire::ParticipantId> participants_{};
  std::string mode_{};
  std::uint64_t stamp_{};
  Twist2 stick_{}, last_motion_{};
  std::optional<Time> stick_at_{};
  bool stands_{true};
};

/// A decoration of both wires of a robot by an interceptor with a strand of its own.
template <class T>
Decoration on_wires(const Subject& subject) {
  Decoration decoration;
  decoration.wires = std::make_unique<T>(subject.runtime.strand("defect"));
  return decoration;
}

}  // namespace adit::sim
