// SPDX-License-Identifier: Apache-2.0
#include "sim/driver/robot_driver.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "geometry_msgs/msg/TwistStamped.h"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/BatteryState.h"
#include "sensor_msgs/msg/PointCloud2.h"

namespace adit::sim {
namespace {

constexpr std::uint8_t kFloat32 = 7;  // sensor_msgs/msg/PointField.FLOAT32
constexpr std::uint32_t kPointBytes = 12;
static_assert(sizeof(Eigen::Vector3f) == kPointBytes);

std_msgs::msg::Header header(Time now, const char* frame) {
  const std::int64_t ns = now.time_since_epoch().count();
  std_msgs::msg::Header out;
  out.stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
  out.stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
  out.frame_id(frame);
  return out;
}

// The serialised sample: made beside everything else, for it is large.
std::vector<std::uint8_t> cloud_bytes(const PointCloud& points, const std_msgs::msg::Header& stamp) {
  sensor_msgs::msg::PointCloud2 cloud;
  cloud.header(stamp);
  cloud.height(1);
  cloud.width(static_cast<std::uint32_t>(points.size()));
  const std::array names{"x", "y", "z"};
  for (std::uint32_t i = 0; i < names.size(); ++i) {
    sensor_msgs::msg::PointField field;
    field.name(names[i]);
    field.offset(4 * i);
    field.datatype(kFloat32);
    field.count(1);
    cloud.fields().push_back(field);
  }
  cloud.point_step(kPointBytes);
  cloud.row_step(kPointBytes * cloud.width());
  cloud.data().resize(points.size() * kPointBytes);
  if (!points.empty()) std::memcpy(cloud.data().data(), points.data(), cloud.data().size());
  cloud.is_dense(true);
  std::vector<std::uint8_t> out;
  wire::encode(cloud, out);
  return out;
}

}  // namespace

struct RobotDriver::Endpoints {
  wire::Writer<nav_msgs::msg::Odometry> odom{};
  wire::Writer<sensor_msgs::msg::BatteryState> battery{};
  std::unique_ptr<wire::RawWriter> points{};
  std::unique_ptr<wire::RawReader> cmd_vel{};
};

RobotDriver::RobotDriver(Simulation& simulation, std::size_t robot, Executor& strand, wire::Participant& wire,
                         const DriverParams& params)
    : simulation_(simulation), robot_(robot), strand_(strand), wire_(wire), params_(params) {}

RobotDriver::~RobotDriver() = default;

Result<void> RobotDriver::start() {
  endpoints_ = std::make_shared<Endpoints>();
  auto odom = wire::Writer<nav_msgs::msg::Odometry>::make(wire_, wire::topics::kOdom);
  if (!odom) return odom.error();
  auto battery = wire::Writer<sensor_msgs::msg::BatteryState>::make(wire_, wire::topics::kBattery);
  if (!battery) return battery.error();
  auto points = wire_.make_writer(wire::topics::kPoints, {});
  if (!points) return points.error();
  endpoints_->odom = std::move(*odom);
  endpoints_->battery = std::move(*battery);
  endpoints_->points = std::move(*points);
  if (auto listening = listen(); !listening) return listening;

  started_ = strand_.now();
  odom_ = strand_.every(params_.odom_period, [this] { send_odom(); });
  battery_ = strand_.every(params_.battery_period, [this] { send_battery(); });
  first_points_ = strand_.after(params_.first_scan, [this] {
    send_points();
    points_ = strand_.every(from_seconds(1.0 / simulation_.params().lidar.rate), [this] { send_points(); });
  });
  return {};
}

Result<void> RobotDriver::listen() {
  const auto obey = [this](const geometry_msgs::msg::Twist& t) {
    simulation_.command(robot_, {t.linear().x(), t.linear().y(), t.angular().z(), t.linear().z()});
  };
  using Stamped = geometry_msgs::msg::TwistStamped;
  auto reader =
      params_.velocity == agent::VelocityType::twist_stamped
          ? wire::make_reader<Stamped>(wire_, wire::topics::kCmdVelStamped, strand_,
                                       [obey](const Stamped& t, const wire::SampleInfo&) { obey(t.twist()); })
          : wire::make_reader<geometry_msgs::msg::Twist>(
                wire_, wire::topics::kCmdVel, strand_,
                [obey](const geometry_msgs::msg::Twist& t, const wire::SampleInfo&) { obey(t); });
  if (!reader) return reader.error();
  endpoints_->cmd_vel = std::move(*reader);
  return {};
}

void RobotDriver::silence(Sensor sensor, bool silent) {
  (sensor == Sensor::lidar ? lidar_silent_ : odometry_silent_) += silent ? 1 : -1;
}

// A failed write is counted by the wire and shown with its counters; the next sample replaces it.
void RobotDriver::send_odom() {
  if (odometry_silent_ > 0) return;
  const Odometry& measured = simulation_.odometry(robot_);
  nav_msgs::msg::Odometry odom;
  odom.header(header(strand_.now(), "odom"));
  odom.child_frame_id("base_link");
  auto& pose = odom.pose().pose();
  pose.position().x(measured.pose().x);
  pose.position().y(measured.pose().y);
  pose.position().z(simulation_.altitude(robot_));
  pose.orientation().z(std::sin(measured.pose().yaw / 2.0));
  pose.orientation().w(std::cos(measured.pose().yaw / 2.0));
  auto& twist = odom.twist().twist();
  twist.linear().x(measured.twist().vx);
  twist.linear().y(measured.twist().vy);
  twist.angular().z(measured.twist().wz);
  (void)endpoints_->odom.write(odom);
}

void RobotDriver::send_battery() {
  const double charge =
      std::clamp(params_.charge - params_.drain * seconds(strand_.now() - started_), 0.0, 1.0);
  sensor_msgs::msg::BatteryState battery;
  battery.header(header(strand_.now(), "base_link"));
  battery.percentage(static_cast<float>(charge));
  battery.voltage(static_cast<float>(21.0 + 4.2 * charge));
  battery.present(true);
  (void)endpoints_->battery.write(battery);
}

void RobotDriver::send_points() {
  if (lidar_silent_ > 0) return;
  auto job = std::make_shared<Simulation::ScanJob>(simulation_.scan(robot_));
  auto stamp = header(strand_.now(), "base_link");
  std::weak_ptr<Endpoints> alive = endpoints_;
  strand_.compute(
      {.name = "scan", .modelled = params_.scan_delay},
      [job, stamp] { return cloud_bytes(job->compute(), stamp); },
      [alive](const Result<std::vector<std::uint8_t>>& bytes) {
        const auto endpoints = alive.lock();
        if (endpoints && bytes) (void)endpoints->points->write(*bytes);
      });
}

}  // namespace adit::sim
