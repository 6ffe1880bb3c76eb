#pragma once
#include <functional>
#include <memory>

#include "core/exec/executor.hpp"
#include "core/geometry/pose.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/motion/velocity_writer.hpp"

namespace adit::wire {
struct ComponentIo;
}

namespace adit::agent {

/// The robot domain: ROS 2 messages from and to the robot's driver, the lidar's clouds apart (scans.hpp).
/// Programs of the robot that steer in the mode `external` speak here, too.
class Driver {
 public:
  /// Called on the command strand. `stamp`: the driver's clock, ns. `received`: when the sample arrived, by
  /// our clock; it may have waited for the strand since.
  struct Handlers {
    std::function<void(const Pose3& odom, const Twist2& twist, std::uint64_t stamp, Time received)>
        odometry{};
    std::function<void(float charge)> battery{};                            ///< 0..1
    std::function<void(const Twist2& velocity, Time received)> external{};  ///< what a program asks for
    /// Another participant wrote a velocity.
    std::function<void(const wire::ParticipantId& writer, Time received)> rival{};
  };

  /// `io`: the command component's, on the robot domain; strand and wire must outlive the driver's last
  /// callback. Errors of the wire.
  static Result<std::unique_ptr<Driver>> open(const wire::ComponentIo& io, VelocityType type,
                                              Handlers handlers);
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  /// Nothing is called any more. From any thread.
  void close();
  /// Body frame. A failed write is counted by the wire; the next one follows within 50 ms.
  void write(const Twist2& velocity);
  /// Samples of the driver, and of whoever else writes its topics, that were none; since the wire was opened.
  std::uint64_t malformed() const;

 private:
  Driver();
  struct Endpoints;
  std::unique_ptr<Endpoints> endpoints_;
};

}  // namespace adit::agent
