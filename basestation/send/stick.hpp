// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>

#include "basestation/fleet/fleet.hpp"
#include "basestation/model/stick_velocity.hpp"
#include "core/exec/executor.hpp"

namespace adit::station {

/// Streams joystick samples to robots, each with the stamp of the last RobotState received.
///
/// A new value is sent at once, and the last one is repeated: 20 Hz on average, independent of the rate of
/// new values. A stream continues until end(); the caller chooses the last samples before that.
class Stick {
 public:
  enum class Source : std::uint8_t {
    held,  ///< One value for some time: repeated each `kPeriod`.
    live,  ///< A stick that is renewed each `kPeriod` or more often: repeated only if a renewal is missing.
  };
  static constexpr Duration kPeriod = std::chrono::milliseconds(50);
  /// A live value is repeated after this time without another one.
  static constexpr Duration kLiveRepeat = std::chrono::milliseconds(75);
  /// A sample may be sent this much earlier than the rate requires: one period, for any phase of the
  /// renewals, plus their jitter.
  static constexpr Duration kTolerance = std::chrono::milliseconds(70);

  Stick(Id id, Executor& strand, wire::Participant& radio, Fleet& fleet);
  ~Stick();

  /// Streams this velocity from now on. Error: wire_failed.
  Result<void> stream(const std::string& robot, const StickVelocity& velocity, Source source = Source::held);
  /// Ends the stream: nothing more is sent to the robot.
  void end(const std::string& robot);
  bool streaming(const std::string& robot) const;

 private:
  struct Stream;
  /// Sends a sample. `at`: now, or the time when the sample was due.
  void send(Stream& stream, Time at);
  void arm(Stream& stream, Time due);
  void transmit(Stream& stream);

  Id id_;
  Executor& strand_;
  wire::Participant& radio_;
  Fleet& fleet_;
  std::map<std::string, std::unique_ptr<Stream>> streams_;
};

}  // namespace adit::station
