// SPDX-License-Identifier: Apache-2.0
#include "perception/input/point_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace adit::perception {
namespace {

constexpr std::uint8_t kUint16 = 4, kFloat32 = 7, kFloat64 = 8;
constexpr std::array<std::uint32_t, 9> kSizes{0, 1, 1, 2, 2, 4, 4, 4, 8};
constexpr std::array kTimeNames{"t", "time", "timestamp", "offset_time", "time_stamp"};
constexpr std::array kRingNames{"ring", "line", "channel"};
constexpr std::array kIntensityNames{"intensity", "reflectivity"};
constexpr std::array kUnits{1.0, 1e-3, 1e-6, 1e-9};
constexpr double kLongest = PointLayout::kLongest;
constexpr double kShortest = 1.0 / 40;   ///< Of a sweep's duration, that the times of one must span at least.
constexpr std::size_t kFewPoints = 200;  ///< Fewer may all be seen within an instant.
constexpr double kSinceEpoch = 1e14;     ///< A larger float64 counts ns since 1970.
constexpr double kSameClock = 1.0;       ///< Absolute times this near to the stamp are of its clock, s.
constexpr double kMostWrong = 0.01;      ///< Of the points, that may have no usable time.

template <class T>
double as(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return static_cast<double>(value);
}

double read(const std::uint8_t* at, std::uint8_t datatype) {
  switch (datatype) {
    case 1:
      return as<std::int8_t>(at);
    case 2:
      return as<std::uint8_t>(at);
    case 3:
      return as<std::int16_t>(at);
    case kUint16:
      return as<std::uint16_t>(at);
    case 5:
      return as<std::int32_t>(at);
    case 6:
      return as<std::uint32_t>(at);
    case kFloat32:
      return as<float>(at);
    default:
      return as<double>(at);
  }
}

std::uint16_t ring_number(double ring) {
  return ring >= 0.0 && ring <= 65535.0 ? static_cast<std::uint16_t>(ring) : std::uint16_t{0};
}

/// Whether a point is a return: without one, drivers give NaN or the origin.
bool is_return(const Eigen::Vector3f& at) {
  return std::isfinite(at.x() + at.y() + at.z()) && (at.x() != 0.0f || at.y() != 0.0f || at.z() != 0.0f);
}

}  // namespace

Result<PointLayout> PointLayout::of(std::span<const PointField> fields, std::uint32_t point_step) {
  PointLayout layout;
  layout.step_ = point_step;
  for (const PointField& field : fields) {
    if (field.datatype == 0 || field.datatype > kFloat64)
      return Error{Reason::malformed,
                   "the field " + std::string(field.name) + " of the cloud has no known type"};
    const std::uint32_t size = kSizes[field.datatype];
    if (point_step < size || field.offset > point_step - size)
      return Error{Reason::malformed,
                   "the field " + std::string(field.name) + " of the cloud lies outside its point"};
  }
  const auto find = [&](const auto& names) -> std::optional<Place> {
    for (const char* name : names)
      for (const PointField& field : fields)
        if (field.name == name) return Place{field.offset, field.datatype};
    return std::nullopt;
  };
  for (const auto& [name, offset] : {std::pair{"x", &layout.x_}, {"y", &layout.y_}, {"z", &layout.z_}}) {
    const auto place = find(std::array{name});
    if (!place || place->datatype != kFloat32)
      return Error{Reason::malformed, std::string("the cloud has no float32 ") + name};
    *offset = place->offset;
  }
  layout.time_ = find(kTimeNames);
  layout.ring_ = find(kRingNames);
  layout.intensity_ = find(kIntensityNames);
  return layout;
}

Result<Sweep> PointLayout::unpack(std::span<const std::uint8_t> data, std::uint64_t count,
                                  std::uint64_t stamp, double duration) const {
  if (count > data.size() / std::max<std::uint32_t>(step_, 1))
    return Error{Reason::malformed, "the cloud has less data than points"};
  Sweep sweep;
  sweep.stamp = stamp;
  sweep.timed = time_ && count > 0;
  sweep.points.resize(count);
  Times times{.first = sweep.timed ? first_time(data.data(), count) : 0.0};
  // `read_time` and the others read a field that exists; compiled once for any types, and once for usual
  // ones.
  const auto unpack_points = [&](auto read_time, auto read_ring, auto read_intensity) {
    const std::uint8_t* at = data.data();
    for (TimedPoint& point : sweep.points) {
      std::memcpy(&point.position.x(), at + x_, 4);
      std::memcpy(&point.position.y(), at + y_, 4);
      std::memcpy(&point.position.z(), at + z_, 4);
      point.time = 0;
      // Drivers leave the time of a lost column unset.
      if (!is_return(point.position)) {
        point.position.x() = std::numeric_limits<float>::quiet_NaN();
      } else if (time_) {
        const double time = read_time(at + time_->offset) - times.first;
        point.time = static_cast<float>(time);
        ++times.returns;
        if (time < times.least) times.least = time;  // False for what is not a number.
        if (time > times.most) times.most = time;
      }
      point.ring = ring_ ? ring_number(read_ring(at + ring_->offset)) : std::uint16_t{0};
      point.intensity = intensity_ ? static_cast<float>(read_intensity(at + intensity_->offset)) : 0.0f;
      at += step_;
    }
  };
  const bool usual = time_ && time_->datatype == kFloat32 && ring_ && ring_->datatype == kUint16 &&
                     intensity_ && intensity_->datatype == kFloat32;
  if (usual)
    unpack_points([](const std::uint8_t* at) { return as<float>(at); },
                  [](const std::uint8_t* at) { return as<std::uint16_t>(at); },
                  [](const std::uint8_t* at) { return as<float>(at); });
  else
    unpack_points([this](const std::uint8_t* at) { return read(at, time_->datatype); },
                  [this](const std::uint8_t* at) { return read(at, ring_->datatype); },
                  [this](const std::uint8_t* at) { return read(at, intensity_->datatype); });
  if (!sweep.timed) return sweep;
  if (!unit(times, duration)) leave_out_few(sweep, data.data(), times, duration);
  if (const auto scaled = scale_times(sweep, times, duration); !scaled) return scaled.error();
  return sweep;
}

double PointLayout::first_time(const std::uint8_t* at, std::uint64_t count) const {
  for (std::uint64_t i = 0; i < count; ++i, at += step_) {
    const double time = read(at + time_->offset, time_->datatype);
    if (std::isfinite(time) &&
        is_return(Eigen::Vector3d(as<float>(at + x_), as<float>(at + y_), as<float>(at + z_)).cast<float>()))
      return time;
  }
  return 0.0;
}

// A few returns with a wrong time would hide the unit of all others.
void PointLayout::leave_out_few(Sweep& sweep, const std::uint8_t* data, Times& times, double duration) const {
  std::vector<double> all;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    if (!is_return(sweep.points[i].position)) continue;
    const double time = read(data + i * step_ + time_->offset, time_->datatype);
    if (std::isfinite(time)) all.push_back(time);
  }
  const auto few = static_cast<std::size_t>(kMostWrong * static_cast<double>(all.size()));
  if (few == 0) return;
  const auto quantile = [&all](std::size_t at) {
    const auto place = all.begin() + static_cast<std::ptrdiff_t>(at);
    std::nth_element(all.begin(), place, all.end());
    return *place;
  };
  const double low = quantile(few), high = quantile(all.size() - 1 - few);
  Times most_of{.first = low, .least = 0.0, .most = high - low, .returns = times.returns};
  if (!unit(most_of, duration)) return;
  // The times of the points that were cut off reach so much farther, and twice that.
  const double rest = 3 * kMostWrong * most_of.most;
  most_of.least -= rest;
  most_of.most += rest;
  for (std::size_t i = 0; i < sweep.points.size(); ++i)
    if (is_return(sweep.points[i].position))
      sweep.points[i].time =
          static_cast<float>(read(data + i * step_ + time_->offset, time_->datatype) - most_of.first);
  times = most_of;
}

std::optional<double> PointLayout::unit(const Times& times, double duration) const {
  const double span = times.most - times.least;
  const double usual = time_->datatype == kFloat32                                          ? 1.0
                       : time_->datatype == kFloat64 && std::abs(times.first) < kSinceEpoch ? 1.0
                                                                                            : 1e-9;
  if (times.returns < kFewPoints)
    return span * usual <= kLongest * duration ? std::optional(usual) : std::nullopt;
  // The bounds lie less than a factor of 1000 apart, so at most one unit fits.
  for (const double each : kUnits)
    if (span * each >= kShortest * duration && span * each <= kLongest * duration) return each;
  return std::nullopt;
}

Result<void> PointLayout::scale_times(Sweep& sweep, const Times& times, double duration) const {
  if (times.returns > 0 && times.most < times.least)
    return {Reason::sensor_times, "no point of the cloud has a time that is a number"};
  if (times.most <= times.least) {
    // All points of one instant, as a simulator or a flash lidar takes them.
    sweep.timed = false;
    for (TimedPoint& point : sweep.points) point.time = 0;
    return {};
  }
  const auto seconds = unit(times, duration);
  if (!seconds)
    return {Reason::sensor_times, "the times of the cloud's points span " +
                                      std::to_string(times.most - times.least) +
                                      ", which in no unit is a sweep of " + std::to_string(duration) + " s"};
  // Times since 1970 count from the stamp; where that is of another clock, the stamp is the first point's.
  double offset = times.first * *seconds;
  if (std::abs(offset) > kLongest * duration) {
    const double since_stamp = offset - static_cast<double>(sweep.stamp) * 1e-9;
    offset = std::abs(since_stamp) < kSameClock ? since_stamp : -times.least * *seconds;
  }
  const auto scale = static_cast<float>(*seconds), after = static_cast<float>(offset);
  std::size_t wrong = 0;
  for (TimedPoint& point : sweep.points) {
    const bool returned = is_return(point.position);
    // Negated, so that what is not a number is wrong, too.
    if (returned &&
        !(point.time >= static_cast<float>(times.least) && point.time <= static_cast<float>(times.most))) {
      ++wrong;
      point.position.x() = std::numeric_limits<float>::quiet_NaN();
      point.time = 0;
    }
    point.time = point.time * scale + after;
  }
  if (static_cast<double>(wrong) > kMostWrong * static_cast<double>(times.returns))
    return {Reason::sensor_times, "the times of " + std::to_string(wrong) + " of the cloud's " +
                                      std::to_string(times.returns) + " returns are none of its sweep"};
  return {};
}

}  // namespace adit::perception
