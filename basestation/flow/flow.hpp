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

/// What flows work with.
struct FlowDependencies {
  Executor& strand;
  Fleet& fleet;
  Sender& sender;
  Stick& stick;
};

/// Something that takes time at one robot: driving, waiting for arrival. It ends by itself or is cancelled,
/// and tells its end once.
class Flow : public std::enable_shared_from_this<Flow> {
 public:
  using Done = std::function<void(const Answer&)>;
  Flow(FlowDependencies dependencies, std::string robot, Done done)
      : dependencies_(dependencies), robot_(std::move(robot)), done_(std::move(done)) {}
  virtual ~Flow() = default;
  Flow(const Flow&) = delete;
  Flow& operator=(const Flow&) = delete;

  virtual void start() = 0;
  /// Ends it in a safe way; the end is told with this reason.
  virtual void cancel(Reason reason, const std::string& text) = 0;
  /// Another flow takes the robot over: ends at once and leaves a stream, if any, centred but running.
  virtual void hand_over() { cancel(Reason::cancelled, "another command took its place"); }
  /// A refused joystick stream.
  virtual void stream_refused(Reason, const std::string& /*text*/) {}
  const std::string& robot() const { return robot_; }
  /// Nothing is left to do: it can be dropped.
  virtual bool over() const { return told_; }

 protected:
  const RobotView* view() const { return dependencies_.fleet.robot(robot_); }
  void notify(Answer answer) {
    if (told_) return;
    told_ = true;
    answer.robot = robot_;
    done_(answer);
  }

  FlowDependencies dependencies_;

 private:
  std::string robot_;
  Done done_;
  bool told_{false};
};

}  // namespace adit::station
