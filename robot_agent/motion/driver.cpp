// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/driver.hpp"

#include <cmath>

#include "core/wire/component_io.hpp"
#include "core/wire/topics.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "geometry_msgs/msg/TwistStamped.h"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/motion/sensor_messages.hpp"
#include "sensor_msgs/msg/BatteryState.h"

namespace adit::agent {
namespace {

// Maps index their cells with 32 bits, so positions must be nearer than 1000 km.
bool usable(const Pose3& pose, const Twist2& twist) {
  const double turn = pose.orientation.norm();
  return pose.position.allFinite() && pose.position.cwiseAbs().maxCoeff() < 1e6 && turn > 1e-6 &&
         turn < 1e6 && std::isfinite(twist.vx) && std::isfinite(twist.vy) && std::isfinite(twist.wz) &&
         std::isfinite(twist.vz);
}

}  // namespace

struct Driver::Endpoints {
  const wire::Participant* wire{};
  VelocityWriter cmd_vel{};
  std::unique_ptr<wire::RawReader> odom{}, battery{}, external{}, rival{};
};

Driver::Driver() : endpoints_(std::make_unique<Endpoints>()) {}
Driver::~Driver() = default;

std::uint64_t Driver::malformed() const {
  std::uint64_t sum = 0;
  for (const wire::TopicCount& count : endpoints_->wire->counters().topics) sum += count.malformed;
  return sum;
}

Result<std::unique_ptr<Driver>> Driver::open(const wire::ComponentIo& io, VelocityType type,
                                             Handlers handlers) {
  namespace topics = wire::topics;
  std::unique_ptr<Driver> driver(new Driver);
  Endpoints& e = *driver->endpoints_;
  e.wire = &io.wire;
  auto cmd_vel = VelocityWriter::make(io.wire, type, io.generation);
  if (!cmd_vel) return cmd_vel.error();
  e.cmd_vel = std::move(*cmd_vel);

  const auto heard = [rival = std::move(handlers.rival), self = io.wire.id()](const auto& /*velocity*/,
                                                                              const wire::SampleInfo& info) {
    if (info.sender != self) rival(info.sender, info.received);
  };
  for (const auto& opened : {
           io.open(e.odom, topics::kOdom,
                   [odometry = std::move(handlers.odometry)](const nav_msgs::msg::Odometry&o,
                                                             const wire::SampleInfo&info) {
                     const auto& p = o.pose().pose().position();
                     Pose3 pose{{p.x(), p.y(), p.z()}, quaternion_of(o.pose().pose().orientation())};
                     const auto& v = o.twist().twist();
                     const Twist2 twist{v.linear().x(), v.linear().y(), v.angular().z(), v.linear().z()};
                     if (!usable(pose, twist))
                       return;  // It counts as silence: the robot stops if it continues.
                     pose.orientation.normalize();
                     odometry(pose, twist, nanoseconds_of(o.header()), info.received);
                   }),
           io.open(
               e.battery, topics::kBattery,
               [battery = std::move(handlers.battery)](const sensor_msgs::msg::BatteryState&b,
                                                       const wire::SampleInfo&) { battery(b.percentage()); }),
           io.open(
               e.external, topics::kExternalCmdVel,
               [external = std::move(handlers.external)](const geometry_msgs::msg::Twist&t,
                                                         const wire::SampleInfo&info) {
                 external({t.linear().x(), t.linear().y(), t.angular().z(), t.linear().z()}, info.received);
               }),
           type == VelocityType::twist_stamped ? io.open(e.rival, topics::kCmdVelStampedHeard, heard)
                                               : io.open(e.rival, topics::kCmdVelHeard, heard),
       })
    if (!opened) return opened.error();
  return driver;
}

void Driver::close() {
  endpoints_->odom.reset();
  endpoints_->battery.reset();
  endpoints_->external.reset();
  endpoints_->rival.reset();
}

void Driver::write(const Twist2& velocity) { endpoints_->cmd_vel.write(velocity); }

}  // namespace adit::agent
