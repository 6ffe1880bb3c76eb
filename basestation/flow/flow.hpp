// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "basestation/fleet/fleet.hpp"
#include "basestation/send/answer.hpp"
#include "basestation/send/sender.hpp"
#include "basestation/send/stick.hpp"
#include "core/exec/executor.hpp"

namespace adit::station {

/// The objects that flows use.
struct FlowDependencies {
  Executor& strand;
  Fleet& fleet;
  Sender& sender;
  Stick& stick;
};

/// A command that takes time at one robot, e.g. driving or waiting for arrival. It ends by itself or is
/// cancelled, and reports its end once.
class Flow : public std::enable_shared_from_this<Flow> {
 public:
  using Done = std::function<void(const Answer&)>;
  Flow(FlowDependencies dependencies, std::string robot, Done done)
      : dependencies_(dependencies), robot_(std::move(robot)), done_(std::move(done)) {}
  virtual ~Flow() = default;
  Flow(const Flow&) = delete;
  Flow& operator=(const Flow&) = delete;

  virtual void start() = 0;
  /// Ends the flow safely; the end is reported with this reason.
  virtual void cancel(Reason reason, const std::string& text) = 0;
  /// Ends at once because another flow takes over the robot; leaves a stream, if any, centred but running.
  virtual void hand_over() { cancel(Reason::cancelled, "another command took its place"); }
  /// Whether it drives the robot by a stick: a robot has one such flow.
  virtual bool is_drive() const { return false; }
  /// Sets the stick's new position, if a live stick drives the robot.
  virtual void set_velocity(const StickVelocity& /*velocity*/) {}
  /// Processes a refusal of the joystick stream.
  virtual void stream_refused(Reason, const std::string& /*text*/) {}
  const std::string& robot() const { return robot_; }
  /// Whether the flow has ended and can be dropped.
  virtual bool over() const { return reported_; }

 protected:
  const RobotView* view() const { return dependencies_.fleet.robot(robot_); }
  void notify(Answer answer) {
    if (reported_) return;
    reported_ = true;
    answer.robot = robot_;
    done_(answer);
  }

  FlowDependencies dependencies_;

 private:
  std::string robot_;
  Done done_;
  bool reported_{false};
};

}  // namespace adit::station
