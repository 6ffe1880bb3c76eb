#pragma once
#include <memory>

#include "core/exec/generation.hpp"
#include "core/geometry/pose.hpp"
#include "core/wire/participant.hpp"

namespace adit::agent {

/// Which type /cmd_vel has: ROS 2's drivers know one or the other.
enum class VelocityType : std::uint8_t { twist, twist_stamped };

/// Writes /cmd_vel; the agent has one, and its parent for the zeros it sends when the agent is gone.
class VelocityWriter {
 public:
  VelocityWriter();
  ~VelocityWriter();
  VelocityWriter(VelocityWriter&&) noexcept;
  VelocityWriter& operator=(VelocityWriter&&) noexcept;

  /// With a `generation` it writes while that is valid. Errors of the wire.
  static Result<VelocityWriter> make(wire::Participant& wire, VelocityType type,
                                     const std::shared_ptr<const Generation>& generation = nullptr);
  /// Body frame. A TwistStamped has stamp zero, "now" to a driver: its clock is not ours. A failed write is
  /// counted by the wire. Nothing before make().
  void write(const Twist2& velocity);

 private:
  struct Endpoint;
  std::unique_ptr<Endpoint> endpoint_;
};

}  // namespace adit::agent
