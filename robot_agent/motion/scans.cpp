// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/scans.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "core/wire/component_io.hpp"
#include "core/wire/topics.hpp"
#include "sensor_msgs/msg/LaserScan.h"
#include "sensor_msgs/msg/PointCloud2.h"

namespace adit::agent {
namespace {

constexpr Duration kScanDeadline = 500ms;  // An older scan is outdated.
constexpr std::uint8_t kFloat32 = 7;       // sensor_msgs/msg/PointField.FLOAT32

}  // namespace

Scans::Scans(Executor& strand, Log log, double lidar_height, const ScanService& output)
    : Component("sensors", strand, std::move(log), {.beat = 100ms}),
      lidar_height_(lidar_height),
      output_(output) {}

void Scans::give(const std::function<Result<PointCloud>()>& unpack, const std_msgs::msg::Header& header,
                 Time received) {
  protect([&] {
    auto points = unpack();
    if (!points) return;  // The operator then sees terrain_stale.
    const auto& stamp = header.stamp();
    const auto nanoseconds = static_cast<std::uint64_t>(stamp.sec()) * 1'000'000'000u + stamp.nanosec();
    call(output_, {std::make_shared<PointCloud>(std::move(*points)), nanoseconds, received},
         {.deadline = kScanDeadline}, [](const Result<void>&) {});
  });
}

void Scans::take(const sensor_msgs::msg::PointCloud2& cloud, Time received) {
  give([&] { return to_points(cloud); }, cloud.header(), received);
}

void Scans::take(const sensor_msgs::msg::LaserScan& scan, Time received) {
  give([&] { return to_points(scan, lidar_height_); }, scan.header(), received);
}

Result<Scans::Readers> Scans::read(const wire::ComponentIo& io, std::function<Scans*()> taker) {
  const auto give = [taker = std::move(taker)](const auto& sample, const wire::SampleInfo& info) {
    if (Scans* scans = taker()) scans->take(sample, info.received);
  };
  Readers readers{};
  for (const auto& opened : {io.open(readers.points, wire::topics::kPoints, give),
                             io.open(readers.scan, wire::topics::kScan, give)})
    if (!opened) return opened.error();
  return readers;
}

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

Result<PointCloud> to_points(const sensor_msgs::msg::LaserScan& scan, double height) {
  const double first = scan.angle_min(), step = scan.angle_increment();
  const std::size_t count = scan.ranges().size();
  if (!std::isfinite(first) || !std::isfinite(step) || std::abs(first) > 10.0 ||
      std::abs(step) * static_cast<double>(count) > 2.2 * std::numbers::pi)
    return Error{Reason::malformed, "the scan's angles are none of one turn"};
  PointCloud points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float range = scan.ranges()[i];
    if (!std::isfinite(range) || range < scan.range_min() || range > scan.range_max()) continue;
    const double angle = first + step * static_cast<double>(i);
    points.push_back(Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), height).cast<float>());
  }
  return points;
}

}  // namespace adit::agent
