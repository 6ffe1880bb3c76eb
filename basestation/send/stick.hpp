#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>

#include "basestation/fleet/fleet.hpp"
#include "core/exec/executor.hpp"

namespace adit::station {

/// Streams joystick samples to robots, each with the last RobotState stamp that was heard.
///
/// A new value goes out when it comes, and the last one is repeated: 20 samples a second on average, however
/// often values come. A stream goes on until end(); the caller chooses the last samples before that.
class Stick {
 public:
  enum class Source : std::uint8_t {
    held,  ///< one value for a while: repeated each `kPeriod`
    live,  ///< a stick that is renewed each `kPeriod` or more often: repeated only when a renewal is missing
  };
  static constexpr Duration kPeriod = std::chrono::milliseconds(50);
  /// A live value is repeated after this time without another one.
  static constexpr Duration kLiveRepeat = std::chrono::milliseconds(75);
  /// A sample may go out so much earlier than the rate says: one period, whatever the phase of the renewals
  /// is, and their jitter.
  static constexpr Duration kTolerance = std::chrono::milliseconds(70);

  Stick(Id id, Executor& strand, wire::Participant& radio, Fleet& fleet);
  ~Stick();

  /// Streams this velocity (m/s, m/s, rad/s, body frame) from now on. Error: wire_failed.
  Result<void> stream(const std::string& robot, const std::array<double, 3>& velocity,
                      Source source = Source::held);
  /// Lets go: the robot hears nothing more.
  void end(const std::string& robot);
  bool streaming(const std::string& robot) const;

 private:
  struct Stream;
  /// `at`: now, or when the sample was due.
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
