#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>

#include "basestation/fleet/fleet.hpp"
#include "core/exec/executor.hpp"

namespace adit::station {

/// Streams joystick samples at 20 Hz to robots, each with the last RobotState stamp that was heard. A stream
/// ends only when it is told to: the last samples before that are the caller's to choose.
class Stick {
 public:
  static constexpr Duration period = std::chrono::milliseconds(50);

  Stick(Id id, Executor& strand, wire::Wire& radio, Fleet& fleet);
  ~Stick();

  /// Streams this velocity (m/s, m/s, rad/s, body frame) from now on; the first sample goes out at once.
  Result<void> stream(const std::string& robot, const std::array<double, 3>& velocity);
  /// Lets go: the robot hears nothing more.
  void end(const std::string& robot);
  bool streaming(const std::string& robot) const;

 private:
  struct Stream;
  void transmit(Stream& stream);

  Id id_;
  Executor& strand_;
  wire::Wire& radio_;
  Fleet& fleet_;
  std::map<std::string, std::unique_ptr<Stream>> streams_;
};

}  // namespace adit::station
