#include "robot_agent/motion/scans.hpp"

#include <array>
#include <cstring>

#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "sensor_msgs/msg/PointCloud2.h"

namespace adit::agent {
namespace {

constexpr std::uint8_t kFloat32 = 7;  // sensor_msgs/msg/PointField.FLOAT32

}  // namespace

Scans::Scans(Executor& strand, Log log, Output output)
    : Component("sensors", strand, std::move(log), {.beat = 100ms}), output_(std::move(output)) {}

void Scans::take(const sensor_msgs::msg::PointCloud2& cloud) {
  protect([&] {
    auto points = to_points(cloud);
    if (!points) return;  // terrain_stale follows, which the operator sees
    const auto& stamp = cloud.header().stamp();
    output_(std::make_shared<PointCloud>(std::move(*points)),
            static_cast<std::uint64_t>(stamp.sec()) * 1'000'000'000u + stamp.nanosec());
  });
}

Result<std::unique_ptr<wire::RawReader>> Scans::read(wire::Wire& robot, Executor& strand,
                                                     std::function<Scans*()> taker) {
  return wire::make_reader(
      robot, wire::topics::points, strand,
      [taker = std::move(taker)](const sensor_msgs::msg::PointCloud2& cloud, const wire::SampleInfo&) {
        if (Scans* scans = taker()) scans->take(cloud);
      });
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

}  // namespace adit::agent
