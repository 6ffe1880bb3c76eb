// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/velocity_writer.hpp"

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "geometry_msgs/msg/TwistStamped.h"

namespace adit::agent {
namespace {

void fill(const Twist2& velocity, geometry_msgs::msg::Twist& twist) {
  twist.linear().x(velocity.vx);
  twist.linear().y(velocity.vy);
  twist.linear().z(velocity.vz);
  twist.angular().z(velocity.wz);
}

}  // namespace

struct VelocityWriter::Endpoint {
  wire::Writer<geometry_msgs::msg::Twist> twist{};
  wire::Writer<geometry_msgs::msg::TwistStamped> stamped{};
};

VelocityWriter::VelocityWriter() = default;
VelocityWriter::~VelocityWriter() = default;
VelocityWriter::VelocityWriter(VelocityWriter&&) noexcept = default;
VelocityWriter& VelocityWriter::operator=(VelocityWriter&&) noexcept = default;

Result<VelocityWriter> VelocityWriter::make(wire::Participant& wire, VelocityType type,
                                            const std::shared_ptr<const Generation>& generation) {
  VelocityWriter out;
  out.endpoint_ = std::make_unique<Endpoint>();
  if (type == VelocityType::twist_stamped) {
    auto writer = wire::Writer<geometry_msgs::msg::TwistStamped>::make(wire, wire::topics::kCmdVelStamped);
    if (!writer) return writer.error();
    out.endpoint_->stamped = std::move(*writer);
    out.endpoint_->stamped.bind(generation);
  } else {
    auto writer = wire::Writer<geometry_msgs::msg::Twist>::make(wire, wire::topics::kCmdVel);
    if (!writer) return writer.error();
    out.endpoint_->twist = std::move(*writer);
    out.endpoint_->twist.bind(generation);
  }
  return out;
}

void VelocityWriter::write(const Twist2& velocity) {
  if (!endpoint_) return;
  if (endpoint_->stamped) {
    geometry_msgs::msg::TwistStamped stamped;
    stamped.header().frame_id("base_link");
    fill(velocity, stamped.twist());
    (void)endpoint_->stamped.write(stamped);
  } else {
    geometry_msgs::msg::Twist twist;
    fill(velocity, twist);
    (void)endpoint_->twist.write(twist);
  }
}

std::size_t VelocityWriter::readers() const {
  return endpoint_ ? endpoint_->twist.matched() + endpoint_->stamped.matched() : 0;
}

}  // namespace adit::agent
