#include "robot_agent/motion/driver.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/BatteryState.h"
#include "sensor_msgs/msg/PointCloud2.h"

namespace adit::agent {
namespace {

constexpr std::uint8_t kFloat32 = 7;  // sensor_msgs/msg/PointField.FLOAT32

std::uint64_t stamp_of(const std_msgs::msg::Header& header) {
  return static_cast<std::uint64_t>(header.stamp().sec()) * 1'000'000'000u + header.stamp().nanosec();
}

// Maps count their cells in 32 bits: no robot's odometry comes as far as 1000 km.
bool usable(const Pose3& pose, const Twist2& twist) {
  const double turn = pose.orientation.norm();
  return pose.position.allFinite() && pose.position.cwiseAbs().maxCoeff() < 1e6 && turn > 1e-6 &&
         turn < 1e6 && std::isfinite(twist.vx) && std::isfinite(twist.vy) && std::isfinite(twist.wz);
}

}  // namespace

Result<PointCloud> to_points(const sensor_msgs::msg::PointCloud2& cloud) {
  std::array<std::uint32_t, 3> offset{};
  const std::array names{"x", "y", "z"};
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    bool found = false;
    for (const auto& field : cloud.fields()) {
      if (field.name() != names[axis] || field.datatype() != kFloat32) continue;
      offset[axis] = field.offset();
      found = true;
    }
    if (!found) return Error{Reason::malformed, std::string("the cloud has no float32 ") + names[axis]};
  }
  const std::uint64_t step = cloud.point_step();
  const std::uint64_t count = std::uint64_t{cloud.width()} * cloud.height();
  for (const std::uint32_t o : offset)
    if (step < 4 || o > step - 4) return Error{Reason::malformed, "a field lies outside its point"};
  if (cloud.is_bigendian()) return Error{Reason::malformed, "the cloud is big endian"};
  if (count > cloud.data().size() / step)
    return Error{Reason::malformed, "the cloud has less data than points"};
  PointCloud points;
  points.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    Eigen::Vector3f p;
    for (std::size_t axis = 0; axis < 3; ++axis)
      std::memcpy(&p[static_cast<Eigen::Index>(axis)], cloud.data().data() + i * step + offset[axis], 4);
    if (p.allFinite()) points.push_back(p);
  }
  return points;
}

struct Driver::Endpoints {
  const wire::Wire* wire{};
  wire::Writer<geometry_msgs::msg::Twist> cmd_vel{};
  geometry_msgs::msg::Twist twist{};
  std::unique_ptr<wire::RawReader> odom{}, points{}, battery{};
  // Scans on their way between the strands see that the driver is gone.
  std::shared_ptr<Handlers> shared{};
};

Driver::Driver() : endpoints_(std::make_unique<Endpoints>()) {}
Driver::~Driver() = default;

std::uint64_t Driver::malformed() const {
  std::uint64_t sum = 0;
  for (const wire::TopicCount& count : endpoints_->wire->counters().topics) sum += count.malformed;
  return sum;
}

Result<std::unique_ptr<Driver>> Driver::open(wire::Wire& wire, Executor& command, Executor& sensors,
                                             Handlers handlers) {
  std::unique_ptr<Driver> driver(new Driver);
  Endpoints& e = *driver->endpoints_;
  e.wire = &wire;
  e.shared = std::make_shared<Handlers>(std::move(handlers));
  auto cmd_vel = wire::Writer<geometry_msgs::msg::Twist>::make(wire, wire::topics::cmd_vel);
  if (!cmd_vel) return cmd_vel.error();
  e.cmd_vel = std::move(*cmd_vel);

  auto odom =
      wire::make_reader(wire, wire::topics::odom, command,
                        [h = e.shared](const nav_msgs::msg::Odometry& o, const wire::SampleInfo&) {
                          const auto& p = o.pose().pose().position();
                          const auto& q = o.pose().pose().orientation();
                          Pose3 pose{{p.x(), p.y(), p.z()}, Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z())};
                          const auto& v = o.twist().twist();
                          const Twist2 twist{v.linear().x(), v.linear().y(), v.angular().z()};
                          if (!usable(pose, twist))
                            return;  // as good as silence: the robot stops when it goes on
                          pose.orientation.normalize();
                          h->odometry(pose, twist, stamp_of(o.header()));
                        });
  if (!odom) return odom.error();
  e.odom = std::move(*odom);

  auto points =
      wire::make_reader(wire, wire::topics::points, sensors,
                        [h = std::weak_ptr<Handlers>(e.shared), &command](
                            const sensor_msgs::msg::PointCloud2& cloud, const wire::SampleInfo&) {
                          auto unpacked = to_points(cloud);
                          if (!unpacked) return;  // terrain_stale follows, which the operator sees
                          command.post([h, points = std::make_shared<PointCloud>(std::move(*unpacked)),
                                        stamp = stamp_of(cloud.header())] {
                            if (const auto alive = h.lock()) alive->points(points, stamp);
                          });
                        });
  if (!points) return points.error();
  e.points = std::move(*points);

  auto battery = wire::make_reader(wire, wire::topics::battery, command,
                                   [h = e.shared](const sensor_msgs::msg::BatteryState& b,
                                                  const wire::SampleInfo&) { h->battery(b.percentage()); });
  if (!battery) return battery.error();
  e.battery = std::move(*battery);
  return driver;
}

void Driver::close() {
  endpoints_->odom.reset();
  endpoints_->points.reset();
  endpoints_->battery.reset();
}

void Driver::write(const Twist2& velocity) {
  Endpoints& e = *endpoints_;
  e.twist.linear().x(velocity.vx);
  e.twist.linear().y(velocity.vy);
  e.twist.angular().z(velocity.wz);
  (void)e.cmd_vel.write(e.twist);
}

}  // namespace adit::agent
