// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/wire/fastdds/fastdds_participant.hpp"
#include "robot_agent/motion/velocity_writer.hpp"

namespace adit::agent {

/// The parent process's own writer of rt/cmd_vel.
class ZeroSender {
 public:
  /// Errors: those of the participant.
  Result<void> open(const wire::FastDdsParams& robot, VelocityType type);
  /// Sends a zero velocity; does nothing if open() failed. The next call follows a failed write.
  void send() { cmd_vel_.write({}); }

 private:
  std::unique_ptr<wire::Participant> wire_{};
  VelocityWriter cmd_vel_{};
};

}  // namespace adit::agent
