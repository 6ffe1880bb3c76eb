// SPDX-License-Identifier: Apache-2.0
#include "perception/input/turn_check.hpp"

#include <cmath>

#include "core/geometry/pose.hpp"

namespace adit::perception {
namespace {

constexpr double kQuarter = M_PI / 2;
constexpr double kComparable = 0.5;  ///< Between two samples, s; over a longer one nothing is compared.
constexpr double kSlowest = 0.05;    ///< A slower turn may be noise, rad/s.
constexpr double kOpposite = -0.5;   ///< A ratio below this is a turn in the other direction.
constexpr double kOtherUnit = 20;    ///< A ratio above this is another unit: degrees give 57.

double seconds_between(std::uint64_t from, std::uint64_t to) {
  return static_cast<double>(static_cast<std::int64_t>(to - from)) * 1e-9;
}

}  // namespace

void TurnCheck::add_rate(std::uint64_t stamp, double rate) {
  const double dt = seconds_between(rate_stamp_, stamp);
  if (rate_stamp_ != 0 && dt > 0 && dt < kComparable) angle_ += rate * dt;
  rate_stamp_ = stamp;
}

void TurnCheck::add_yaw(std::uint64_t stamp, double yaw) {
  const double dt = seconds_between(yaw_stamp_, stamp);
  const double turn = wrap_angle(yaw - yaw_), measured = angle_ - angle_then_;
  const bool comparable = yaw_stamp_ != 0 && dt > 0 && dt < kComparable &&
                          std::fabs(seconds_between(rate_stamp_, stamp)) < kComparable;
  yaw_stamp_ = stamp;
  yaw_ = yaw;
  angle_then_ = angle_;
  if (!comparable || std::fabs(turn) < kSlowest * dt) return;
  turned_ += std::fabs(turn);
  measured_ += std::copysign(1.0, turn) * measured;
  if (turned_ < kQuarter) return;
  ratio_ = measured_ / turned_;
  turned_ = measured_ = 0;
  refusal_.clear();
  if (ratio_ < kOpposite) refusal_ = "the gyro and the odometry turn in opposite directions";
  if (ratio_ > kOtherUnit)
    refusal_ = "the gyro measures " + std::to_string(std::lround(ratio_)) +
               " times the turn of the odometry; it must send rad/s";
}

}  // namespace adit::perception
