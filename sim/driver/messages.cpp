// SPDX-License-Identifier: Apache-2.0
#include "sim/driver/messages.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "core/wire/typed.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/PointCloud2.h"

namespace adit::sim {
namespace {

// Of sensor_msgs/msg/PointField.
constexpr std::uint8_t kUint16 = 4;
constexpr std::uint8_t kFloat32 = 7;

struct Field {
  const char* name;
  std::uint32_t offset;
  std::uint8_t type;
};

template <class Point>
std::vector<std::uint8_t> encode_cloud(std::span<const Point> points, std::span<const Field> fields,
                                       const std_msgs::msg::Header& header) {
  sensor_msgs::msg::PointCloud2 cloud;
  cloud.header(header);
  cloud.height(1);
  cloud.width(static_cast<std::uint32_t>(points.size()));
  for (const Field& f : fields) {
    sensor_msgs::msg::PointField field;
    field.name(f.name);
    field.offset(f.offset);
    field.datatype(f.type);
    field.count(1);
    cloud.fields().push_back(field);
  }
  cloud.point_step(sizeof(Point));
  cloud.row_step(cloud.point_step() * cloud.width());
  cloud.is_dense(true);
  std::vector<std::uint8_t> out;
  wire::encode(cloud, out);
  // The data, the last member but one, are put in afterwards, so that they are copied once: after their
  // number, which is 0 so far, and before `is_dense`.
  constexpr std::ptrdiff_t kDense = 1;
  const auto bytes = static_cast<std::uint32_t>(points.size_bytes());
  std::memcpy(out.data() + out.size() - kDense - sizeof bytes, &bytes, sizeof bytes);
  const auto* data = reinterpret_cast<const std::uint8_t*>(points.data());
  out.reserve(out.size() + bytes);
  out.insert(out.end() - kDense, data, data + bytes);
  return out;
}

geometry_msgs::msg::Vector3 to_message(const Eigen::Vector3d& v) {
  geometry_msgs::msg::Vector3 out;
  out.x(v.x());
  out.y(v.y());
  out.z(v.z());
  return out;
}

std::array<double, 9> isotropic(double variance) { return {variance, 0, 0, 0, variance, 0, 0, 0, variance}; }

}  // namespace

std_msgs::msg::Header message_header(Time stamp, const std::string& frame) {
  // Downwards: the nanoseconds of a time before 1970 count forward, too.
  const auto sec = std::chrono::floor<std::chrono::seconds>(stamp.time_since_epoch());
  std_msgs::msg::Header out;
  out.stamp().sec(static_cast<std::int32_t>(sec.count()));
  out.stamp().nanosec(static_cast<std::uint32_t>((stamp.time_since_epoch() - sec).count()));
  out.frame_id(frame);
  return out;
}

std::vector<std::uint8_t> cloud_message(const PointCloud& points, const std_msgs::msg::Header& header) {
  static_assert(sizeof(Eigen::Vector3f) == 12);
  constexpr std::array kFields{Field{"x", 0, kFloat32}, Field{"y", 4, kFloat32}, Field{"z", 8, kFloat32}};
  return encode_cloud(std::span<const Eigen::Vector3f>(points), kFields, header);
}

std::vector<std::uint8_t> cloud_message(std::span<const SweepPoint> points,
                                        const std_msgs::msg::Header& header) {
  constexpr std::array kFields{Field{"x", offsetof(SweepPoint, x), kFloat32},
                               Field{"y", offsetof(SweepPoint, y), kFloat32},
                               Field{"z", offsetof(SweepPoint, z), kFloat32},
                               Field{"intensity", offsetof(SweepPoint, intensity), kFloat32},
                               Field{"t", offsetof(SweepPoint, t), kFloat32},
                               Field{"ring", offsetof(SweepPoint, ring), kUint16}};
  return encode_cloud(points, kFields, header);
}

sensor_msgs::msg::Imu imu_message(const ImuSample& sample, const ImuParams& params,
                                  const std_msgs::msg::Header& header) {
  sensor_msgs::msg::Imu out;
  out.header(header);
  out.orientation().w(1.0);
  out.orientation_covariance()[0] = -1.0;  // No estimate of the orientation, by REP-145.
  out.angular_velocity(to_message(sample.gyro));
  out.linear_acceleration(to_message(sample.accel));
  const double gyro = params.gyro_noise * params.gyro_noise * params.rate;
  const double accel = params.accel_noise * params.accel_noise * params.rate;
  out.angular_velocity_covariance(isotropic(gyro));
  out.linear_acceleration_covariance(isotropic(accel));
  return out;
}

void set_covariance(nav_msgs::msg::Odometry& odom, const OdometrySigma& sigma) {
  constexpr double kUnknown = 1e6;  // A variance that no filter counts on: what is not measured.
  const auto diagonal = [](std::array<double, 6> sigmas) {
    std::array<double, 36> out{};
    for (std::size_t n = 0; n < sigmas.size(); ++n) out[7 * n] = sigmas[n] * sigmas[n];
    return out;
  };
  const double unknown = std::sqrt(kUnknown);
  odom.pose().covariance(
      diagonal({sigma.position, sigma.position, sigma.height, sigma.tilt, sigma.tilt, sigma.yaw}));
  odom.twist().covariance(diagonal({sigma.speed, sigma.speed, unknown, unknown, unknown, sigma.turn}));
}

}  // namespace adit::sim
