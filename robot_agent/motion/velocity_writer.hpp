// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/exec/generation.hpp"
#include "core/geometry/pose.hpp"
#include "core/wire/participant.hpp"

namespace adit::agent {

/// The message type of /cmd_vel: a ROS 2 driver accepts one of them.
enum class VelocityType : std::uint8_t { twist, twist_stamped };

/// Writes /cmd_vel. Used by the agent, and by its parent process for the zeros while the agent is not
/// running.
class VelocityWriter {
 public:
  VelocityWriter();
  ~VelocityWriter();
  VelocityWriter(VelocityWriter&&) noexcept;
  VelocityWriter& operator=(VelocityWriter&&) noexcept;

  /// With a `generation` it writes only while that is valid. Errors: those of the participant.
  static Result<VelocityWriter> make(wire::Participant& wire, VelocityType type,
                                     const std::shared_ptr<const Generation>& generation = nullptr);
  /// Writes a velocity, body frame. A TwistStamped has stamp zero, which means "now" to a driver, because the
  /// driver's clock may differ from the agent's. The participant counts a failed write. Does nothing before
  /// make().
  void write(const Twist2& velocity);
  /// Number of readers of other participants that receive it.
  std::size_t readers() const;

 private:
  struct Endpoint;
  std::unique_ptr<Endpoint> endpoint_;
};

}  // namespace adit::agent
