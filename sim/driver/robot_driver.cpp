// SPDX-License-Identifier: Apache-2.0
#include "sim/driver/robot_driver.hpp"

#include <algorithm>
#include <vector>

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "geometry_msgs/msg/TwistStamped.h"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/BatteryState.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "sim/driver/messages.hpp"
#include "sim/world/active.hpp"

namespace adit::sim {
namespace {

constexpr double kLateOdometry = 0.02;    // share of the samples that others overtake
constexpr double kLateImu = 0.005;        // share of the samples that wait and come together
constexpr Duration kLongestDelay = 45ms;  // of such samples
constexpr double kUsualScanDelay = 0.02;  // s: of a sweep, beyond DriverParams::scan_delay
constexpr double kLateScan = 0.02;        // share of the sweeps that come kLongestDelay later still
constexpr double kClockOffset = 0.005;    // s: of a sensor's clock to the driver's

}  // namespace

struct RobotDriver::Endpoints {
  wire::Writer<nav_msgs::msg::Odometry> odom{};
  wire::Writer<sensor_msgs::msg::Imu> imu{};
  wire::Writer<sensor_msgs::msg::BatteryState> battery{};
  std::vector<std::unique_ptr<wire::RawWriter>> points{};  ///< By lidar.
  std::unique_ptr<wire::RawReader> cmd_vel{};
};

RobotDriver::RobotDriver(Simulation& simulation, std::size_t robot, Executor& strand, wire::Participant& wire,
                         const DriverParams& params)
    : simulation_(simulation),
      robot_(robot),
      strand_(strand),
      wire_(wire),
      params_(params),
      noise_(simulation.params().noise),
      random_(simulation.sensor_seed(robot)) {
  const auto offset = [this] { return from_seconds(random_.uniform(-kClockOffset, kClockOffset) * noise_); };
  lidar_clock_ = offset();
  imu_clock_ = offset();
}

RobotDriver::~RobotDriver() = default;

Result<void> RobotDriver::start() {
  endpoints_ = std::make_shared<Endpoints>();
  auto odom = wire::Writer<nav_msgs::msg::Odometry>::make(wire_, wire::topics::kOdom);
  if (!odom) return odom.error();
  auto battery = wire::Writer<sensor_msgs::msg::BatteryState>::make(wire_, wire::topics::kBattery);
  if (!battery) return battery.error();
  endpoints_->odom = std::move(*odom);
  endpoints_->battery = std::move(*battery);
  const bool realistic = simulation_.params().realistic;
  for (const LidarConfig& lidar : simulation_.platform(robot_).all_lidars()) {
    wire::TopicInfo topic = wire::topics::kPoints;
    const std::string name = "rt/" + lidar.topic;
    topic.name = name.c_str();
    auto points = wire_.make_writer(topic, {});
    if (!points) return points.error();
    endpoints_->points.push_back(std::move(*points));
    if (!realistic) break;  // One scan in base_link.
  }
  if (auto listening = listen(); !listening) return listening;
  started_ = strand_.now();
  if (realistic) {
    auto topic = wire::topics::kImu;
    const std::string name = "rt/" + simulation_.platform(robot_).imu.value_or(ImuConfig{}).topic;
    topic.name = name.c_str();
    auto imu = wire::Writer<sensor_msgs::msg::Imu>::make(wire_, topic);
    if (!imu) return imu.error();
    endpoints_->imu = std::move(*imu);
    imu_ = strand_.every(simulation_.params().step, [this] { send_imu(); });
  }
  odom_ = strand_.every(params_.odom_period, [this] { send_odom(); });
  battery_ = strand_.every(params_.battery_period, [this] { send_battery(); });
  first_points_ = strand_.after(params_.first_scan, [this] {
    send_points();
    points_ = strand_.every(from_seconds(1.0 / simulation_.params().lidar.rate), [this] { send_points(); });
  });
  return start_cameras();
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

std_msgs::msg::Header RobotDriver::header(Sensor sensor, Time stamp, const std::string& frame) {
  const SensorFaults& active = faults(sensor);
  return message_header(active.stampless > 0 ? Time{} : stamp + active.clock, frame);
}

void RobotDriver::lose_columns(const ColumnLoss& loss, bool begins) { change_active(losses_, loss, begins); }

Time RobotDriver::simulated(Duration at) {
  const Time now = strand_.now();
  const Duration age = now - (origin_ + simulation_.now());
  // The clock was set, or the world goes slow.
  if (age < 0ns || age > simulation_.params().step) origin_ = now - simulation_.now();
  return origin_ + at;
}

// A failed write is counted by the wire and shown with its counters; the next sample replaces it.
void RobotDriver::send_odom() {
  if (silent(Sensor::odometry)) return;
  if (params_.catch_up) params_.catch_up();
  const Odometry& measured = simulation_.odometry(robot_);
  const bool realistic = simulation_.params().realistic;
  nav_msgs::msg::Odometry odom;
  odom.header(header(Sensor::odometry, realistic ? simulated(simulation_.now()) : strand_.now(), "odom"));
  odom.child_frame_id("base_link");
  auto& pose = odom.pose().pose();
  pose.position().x(measured.pose().x);
  pose.position().y(measured.pose().y);
  pose.position().z(simulation_.altitude(robot_));
  const Eigen::Quaterniond q = measured.orientation();
  pose.orientation().x(q.x());
  pose.orientation().y(q.y());
  pose.orientation().z(q.z());
  pose.orientation().w(q.w());
  auto& twist = odom.twist().twist();
  twist.linear().x(measured.twist().vx);
  twist.linear().y(measured.twist().vy);
  twist.angular().z(measured.twist().wz);
  if (realistic) {
    set_covariance(odom, measured.sigma());
    if (random_.chance(noise_ * kLateOdometry)) {
      std::erase_if(late_, [](const Timer& timer) { return !timer.active(); });
      const Duration delay = from_seconds(random_.uniform() * seconds(kLongestDelay));
      late_.push_back(strand_.after(delay, [this, odom] { (void)endpoints_->odom.write(odom); }));
      return;
    }
  }
  (void)endpoints_->odom.write(odom);
}

void RobotDriver::send_imu() {
  // A bus that is busy hands several samples over at once.
  if (strand_.now() < imu_waits_until_) return;
  if (random_.chance(noise_ * kLateImu)) {
    imu_waits_until_ = strand_.now() + from_seconds(random_.uniform() * seconds(kLongestDelay));
    return;
  }
  const std::optional<ImuConfig>& config = simulation_.platform(robot_).imu;
  const std::string frame = config.value_or(ImuConfig{}).frame;
  for (const ImuSample& sample : simulation_.take_imu(robot_)) {
    if (silent(Sensor::imu)) continue;  // Those of the silence do not come later.
    (void)endpoints_->imu.write(imu_message(sample, simulation_.imu_params(robot_),
                                            header(Sensor::imu, simulated(sample.at) + imu_clock_, frame)));
  }
}

void RobotDriver::send_battery() {
  const double charge =
      std::clamp(params_.charge - params_.drain * seconds(strand_.now() - started_), 0.0, 1.0);
  sensor_msgs::msg::BatteryState battery;
  battery.header(message_header(strand_.now(), "base_link"));
  battery.percentage(static_cast<float>(charge));
  battery.voltage(static_cast<float>(21.0 + 4.2 * charge));
  battery.present(true);
  (void)endpoints_->battery.write(battery);
}

std::function<void(const Result<std::vector<std::uint8_t>>&)> RobotDriver::sender(
    std::weak_ptr<Endpoints> alive, std::size_t lidar) {
  return [alive, lidar](const Result<std::vector<std::uint8_t>>& bytes) {
    const auto endpoints = alive.lock();
    if (endpoints && bytes) (void)endpoints->points[lidar]->write(*bytes);
  };
}

void RobotDriver::send_points() {
  if (silent(Sensor::lidar)) return;
  if (params_.catch_up) params_.catch_up();
  if (simulation_.params().realistic) {
    for (std::size_t lidar = 0; lidar < endpoints_->points.size(); ++lidar) send_sweep(lidar);
    return;
  }
  auto job = std::make_shared<Simulation::ScanJob>(simulation_.scan(robot_));
  strand_.compute(
      {.name = "scan", .modelled = params_.scan_delay},
      [job, header = header(Sensor::lidar, strand_.now(), "base_link")] {
        return cloud_message(job->compute(), header);
      },
      sender(endpoints_, 0));
}

void RobotDriver::send_sweep(std::size_t lidar) {
  auto job = std::make_shared<SweepJob>(simulation_.sweep(robot_, lidar));
  if (!losses_.empty()) job->loss = losses_.back();
  job->covered = covers_ > 0;
  const Time begin = simulated(simulation_.now() - simulation_.sweep_duration()) + lidar_clock_;
  Duration delay = params_.scan_delay + from_seconds(noise_ * kUsualScanDelay * random_.uniform());
  if (random_.chance(noise_ * kLateScan)) delay += kLongestDelay;
  strand_.compute(
      {.name = "scan", .modelled = delay},
      [job, header = header(Sensor::lidar, begin, simulation_.platform(robot_).all_lidars()[lidar].frame)] {
        return cloud_message(job->trace(), header);
      },
      sender(endpoints_, lidar));
}

}  // namespace adit::sim
