// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/driver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/wire/component_io.hpp"
#include "core/wire/topics.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "geometry_msgs/msg/TwistStamped.h"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/motion/charge_input.hpp"
#include "robot_agent/motion/sensor_messages.hpp"
#include "sensor_msgs/msg/BatteryState.h"

namespace adit::agent {
namespace {

// Maps index their cells with 32 bits, so positions must be nearer than 1000 km.
constexpr double kFarthest = 1e6;

bool is_finite(const Twist2& twist) {
  return std::isfinite(twist.vx) && std::isfinite(twist.vy) && std::isfinite(twist.wz) &&
         std::isfinite(twist.vz);
}

/// Why a sample of the odometry cannot be used; empty: it can.
std::string unusable(const Pose3& pose, const Twist2& twist) {
  char text[160] = "";
  const Eigen::Vector3d& p = pose.position;
  const Eigen::Quaterniond& q = pose.orientation;
  if (!p.allFinite() || p.cwiseAbs().maxCoeff() >= kFarthest)
    std::snprintf(text, sizeof text, "its position %.4g %.4g %.4g is no place within 1000 km", p.x(), p.y(),
                  p.z());
  else if (!is_rotation(q))
    std::snprintf(text, sizeof text, "its orientation %.4g %.4g %.4g %.4g is no quaternion", q.x(), q.y(),
                  q.z(), q.w());
  else if (!is_finite(twist))
    std::snprintf(text, sizeof text, "its twist is no number");
  return text;
}

InputFault refused(const wire::TopicInfo& topic, Reason reason, const std::string& text) {
  return {topic.name + 3, "sensor_refused", Severity::error, {reason, text}};
}

}  // namespace

struct Driver::Endpoints {
  static Twist2 twist_of(const geometry_msgs::msg::Twist& t) {
    return {t.linear().x(), t.linear().y(), t.angular().z(), t.linear().z()};
  }

  wire::ComponentIo io;
  Handlers handlers;
  std::shared_ptr<OneSource> source;
  VelocityWriter cmd_vel{};
  ChargeInput charge{};
  bool external_stamped{false};
  std::unique_ptr<wire::RawReader> odom{}, battery{}, external{}, rival{};

  void take(const nav_msgs::msg::Odometry& o, const wire::SampleInfo& info) {
    const OneSource::Use use = source->take(info.sender, info.received);
    if (use == OneSource::Use::no) return;
    if (use == OneSource::Use::besides) handlers.fault(two_sources("odom", *source));
    const auto& p = o.pose().pose().position();
    Pose3 pose{{p.x(), p.y(), p.z()}, quaternion_of(o.pose().pose().orientation())};
    const Twist2 twist = twist_of(o.twist().twist());
    // Left out, it counts as silence: the robot stops if it continues.
    if (const std::string why = unusable(pose, twist); !why.empty())
      return handlers.fault(
          refused(wire::topics::kOdom, Reason::malformed, "the odometry on /odom cannot be used: " + why));
    pose.orientation.normalize();
    handlers.odometry(pose, twist, nanoseconds_of(o.header()), info.received);
  }
  void take(const sensor_msgs::msg::BatteryState& b, const wire::SampleInfo& info) {
    const auto taken = charge.take(b.percentage(), info.sender);
    handlers.battery(taken ? *taken : ChargeInput::kUnknown);
    if (taken) return;
    InputFault fault = refused(wire::topics::kBattery, taken.reason(), taken.error().text);
    fault.severity = Severity::warning;
    handlers.fault(fault);
  }
  void take(const geometry_msgs::msg::Twist& t, const wire::SampleInfo& info) {
    const Twist2 velocity = twist_of(t);
    if (!is_finite(velocity))
      return handlers.fault(refused(wire::topics::kExternalCmdVel, Reason::malformed,
                                    "a velocity on /external/cmd_vel is no number and is left out"));
    handlers.external(velocity, info.received);
  }
  Result<void> open_external(bool stamped) {
    external.reset();  // A topic has one type at a time.
    external_stamped = stamped;
    if (stamped)
      return io.open(external, wire::topics::kExternalCmdVelStamped,
                     [this](const geometry_msgs::msg::TwistStamped& t, const wire::SampleInfo& info) {
                       take(t.twist(), info);
                     });
    return io.open(
        external, wire::topics::kExternalCmdVel,
        [this](const geometry_msgs::msg::Twist& t, const wire::SampleInfo& info) { take(t, info); });
  }
};

Driver::Driver(std::unique_ptr<Endpoints> endpoints) : endpoints_(std::move(endpoints)) {}
Driver::~Driver() = default;

std::uint64_t Driver::malformed() const {
  std::uint64_t sum = 0;
  for (const wire::TopicCount& count : endpoints_->io.wire.counters().topics) sum += count.malformed;
  return sum;
}

Result<std::unique_ptr<Driver>> Driver::open(const wire::ComponentIo& io, VelocityType type,
                                             Handlers handlers, std::shared_ptr<OneSource> source) {
  namespace topics = wire::topics;
  std::unique_ptr<Driver> driver(
      new Driver(std::unique_ptr<Endpoints>(new Endpoints{io, std::move(handlers), std::move(source)})));
  Endpoints& e = *driver->endpoints_;
  auto cmd_vel = VelocityWriter::make(io.wire, type, io.generation);
  if (!cmd_vel) return cmd_vel.error();
  e.cmd_vel = std::move(*cmd_vel);

  const auto take = [&e](const auto& sample, const wire::SampleInfo& info) { e.take(sample, info); };
  const auto heard = [&e, self = io.wire.id()](const auto& /*velocity*/, const wire::SampleInfo& info) {
    if (info.sender != self) e.handlers.rival(info.sender, info.received);
  };
  for (const auto& opened :
       {io.open(e.odom, topics::kOdom, take), io.open(e.battery, topics::kBattery, take),
        e.open_external(false),
        type == VelocityType::twist_stamped ? io.open(e.rival, topics::kCmdVelStampedHeard, heard)
                                            : io.open(e.rival, topics::kCmdVelHeard, heard)})
    if (!opened) return opened.error();
  return driver;
}

void Driver::look() {
  Endpoints& e = *endpoints_;
  const auto writers = e.io.wire.endpoints(wire::topics::kExternalCmdVel.name);
  const auto any = [&](const char* type) {
    return std::ranges::any_of(
        writers, [&](const wire::RemoteEndpoint& each) { return each.writes && each.type == type; });
  };
  const char* const plain = wire::topics::kExternalCmdVel.type;
  const char* const stamped = wire::topics::kExternalCmdVelStamped.type;
  const bool heard = e.external && any(e.external_stamped ? stamped : plain);
  if (heard || !any(e.external_stamped ? plain : stamped)) return;
  (void)e.open_external(!e.external_stamped);  // The next look tries again.
}

bool Driver::obeyed() const { return endpoints_->cmd_vel.readers() > 0; }

void Driver::close() {
  endpoints_->odom.reset();
  endpoints_->battery.reset();
  endpoints_->external.reset();
  endpoints_->rival.reset();
}

void Driver::write(const Twist2& velocity) { endpoints_->cmd_vel.write(velocity); }

}  // namespace adit::agent
