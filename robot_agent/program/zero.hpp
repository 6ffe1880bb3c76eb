#pragma once
#include <memory>

#include "core/wire/fastdds/fastdds_participant.hpp"
#include "robot_agent/motion/velocity_writer.hpp"

namespace adit::agent {

/// The parent's own writer of rt/cmd_vel.
class ZeroSender {
 public:
  /// Errors of the wire.
  Result<void> open(const wire::FastDdsParams& robot, VelocityType type);
  /// Nothing when open() failed; a failed write is followed by the next one.
  void send() { cmd_vel_.write({}); }

 private:
  std::unique_ptr<wire::Participant> wire_{};
  VelocityWriter cmd_vel_{};
};

}  // namespace adit::agent
