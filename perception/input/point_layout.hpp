// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "core/result/result.hpp"
#include "perception/types/sweep.hpp"

namespace adit::perception {

/// One field of a packed point, as sensor_msgs/PointField describes it.
struct PointField {
  std::string_view name{};
  std::uint32_t offset{};   ///< Within the point, bytes.
  std::uint8_t datatype{};  ///< 1 int8, 2 uint8, 3 int16, 4 uint16, 5 int32, 6 uint32, 7 float32, 8 float64.
};

/// Reads packed points: x, y and z as float32; time, ring and intensity where the driver sends them.
///
/// Names of the time are those of the common drivers: `t` (Ouster, ns), `time` (Velodyne, s), `timestamp`
/// (Hesai, s; Livox, ns; since 1970), `offset_time` (Livox, ns), `time_stamp`. The unit follows from how long
/// a sweep takes, because drivers of one name disagree about it.
class PointLayout {
 public:
  /// Of a sweep's duration, that its times may span: a lidar may turn more slowly than the file says.
  static constexpr double kLongest = 1.6;

  /// Reason::malformed when a field is missing, or lies outside the point.
  static Result<PointLayout> of(std::span<const PointField> fields, std::uint32_t point_step);

  /// Unpacks `count` points. The times count only of those that are a return; a few returns whose time is not
  /// of their sweep become none.
  ///
  /// @param stamp     Of the message, ns.
  /// @param duration  How long a sweep takes, s: decides about the unit of the times.
  /// Errors: malformed when there is less data than points; sensor_times when the times fit no unit.
  Result<Sweep> unpack(std::span<const std::uint8_t> data, std::uint64_t count, std::uint64_t stamp,
                       double duration) const;

 private:
  struct Place {
    std::uint32_t offset{};
    std::uint8_t datatype{};
  };
  /// Times of the points that are a return, in the driver's unit.
  struct Times {
    double first{};  ///< Of a return; the others count from it.
    double least{std::numeric_limits<double>::infinity()}, most{-std::numeric_limits<double>::infinity()};
    std::size_t returns{};
  };
  /// Of the first return that has one; 0: none has.
  double first_time(const std::uint8_t* at, std::uint64_t count) const;
  void leave_out_few(Sweep& sweep, const std::uint8_t* data, Times& times, double duration) const;
  Result<void> scale_times(Sweep& sweep, const Times& times, double duration) const;
  /// Seconds in one unit of the times; nothing when none fits.
  std::optional<double> unit(const Times& times, double duration) const;

  std::uint32_t step_{};
  std::uint32_t x_{}, y_{}, z_{};
  std::optional<Place> time_{}, ring_{}, intensity_{};
};

}  // namespace adit::perception
