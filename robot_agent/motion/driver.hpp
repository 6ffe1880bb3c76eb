// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>

#include "core/geometry/pose.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/motion/input_faults.hpp"
#include "robot_agent/motion/one_source.hpp"
#include "robot_agent/motion/velocity_writer.hpp"

namespace adit::wire {
struct ComponentIo;
}

namespace adit::agent {

/// The agent's readers and writers on the robot domain: ROS 2 messages from and to the robot's driver, except
/// the lidar's (scans.hpp), and velocities of programs that steer in the mode `external`.
class Driver {
 public:
  /// Called on the command strand. `stamp`: time by the driver's clock, ns. `received`: time of reception by
  /// the agent's clock; the sample may have waited for the strand since.
  struct Handlers {
    std::function<void(const Pose3& odom, const Twist2& twist, std::uint64_t stamp, Time received)>
        odometry{};
    std::function<void(float charge)> battery{};  ///< State of charge, [0, 1]; negative: unknown.
    /// Velocity that a program requests.
    std::function<void(const Twist2& velocity, Time received)> external{};
    /// Reports that another participant wrote a velocity.
    std::function<void(const wire::ParticipantId& writer, Time received)> rival{};
    /// Reports what arrives and cannot be used.
    std::function<void(const InputFault& fault)> fault{};
  };

  /// `io`: the command component's, on the robot domain; strand and participant must outlive the driver's
  /// last callback. `source`: of the odometry, shared with its other readers. Errors: those of the
  /// participant.
  static Result<std::unique_ptr<Driver>> open(const wire::ComponentIo& io, VelocityType type,
                                              Handlers handlers, std::shared_ptr<OneSource> source);
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  /// Ends all calls of the handlers. Callable from any thread.
  void close();
  /// Writes a velocity, body frame. The participant counts a failed write; the next one follows within 50 ms.
  void write(const Twist2& velocity);
  /// Looks at the endpoints of others: reads /external/cmd_vel in the type in which it is written. About once
  /// a second.
  void look();
  /// Whether another participant reads the velocities.
  bool obeyed() const;
  /// Number of malformed samples on the driver's topics since the participant was opened.
  std::uint64_t malformed() const;

 private:
  struct Endpoints;
  explicit Driver(std::unique_ptr<Endpoints> endpoints);
  std::unique_ptr<Endpoints> endpoints_;
};

}  // namespace adit::agent
