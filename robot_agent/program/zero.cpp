#include "robot_agent/program/zero.hpp"

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"

namespace adit::agent {

struct ZeroSender::Endpoints {
  std::unique_ptr<wire::Wire> wire{};
  wire::Writer<geometry_msgs::msg::Twist> cmd_vel{};
};

ZeroSender::ZeroSender() : endpoints_(std::make_unique<Endpoints>()) {}
ZeroSender::~ZeroSender() = default;

Result<void> ZeroSender::open(const wire::FastDdsParams& robot) {
  wire::FastDdsParams params = robot;
  params.name += "-parent";
  auto opened = wire::open_fastdds(params);
  if (!opened) return opened.error();
  endpoints_->wire = std::move(*opened);
  auto writer = wire::Writer<geometry_msgs::msg::Twist>::make(*endpoints_->wire, wire::topics::cmd_vel);
  if (!writer) return writer.error();
  endpoints_->cmd_vel = std::move(*writer);
  return {};
}

void ZeroSender::send() {
  if (endpoints_->cmd_vel) (void)endpoints_->cmd_vel.write({});
}

}  // namespace adit::agent
