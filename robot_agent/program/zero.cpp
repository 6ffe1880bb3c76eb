// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/program/zero.hpp"

namespace adit::agent {

Result<void> ZeroSender::open(const wire::FastDdsParams& robot, VelocityType type) {
  wire::FastDdsParams params = robot;
  params.name += "-parent";
  auto opened = wire::open_fastdds(params);
  if (!opened) return opened.error();
  auto writer = VelocityWriter::make(**opened, type);
  if (!writer) return writer.error();
  wire_ = std::move(*opened);
  cmd_vel_ = std::move(*writer);
  return {};
}

}  // namespace adit::agent
