// SPDX-License-Identifier: Apache-2.0
#include "perception/input/deskew.hpp"

#include <cmath>

namespace adit::perception {
namespace {

constexpr double kBetween = 0.01;   ///< Of two poses, s.
constexpr std::size_t kMost = 100;  ///< Poses of one sweep.

}  // namespace

Result<Deskew> Deskew::over(std::uint64_t from, std::uint64_t to, const PoseFunction& pose,
                            const Pose3& T_base_sensor) {
  if (to <= from) return none(T_base_sensor);
  const double span = static_cast<double>(to - from) * 1e-9;
  const auto pieces = std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(span / kBetween)), 1, kMost);
  const auto end = pose(to);
  if (!end) return end.error();
  const Pose3 T_end_odom = end->inverse();
  Deskew deskew;
  deskew.per_second_ = static_cast<float>(static_cast<double>(pieces) / span);
  deskew.last_ = static_cast<float>(pieces);
  for (std::size_t n = 0; n <= pieces; ++n) {
    const auto stamp =
        from + static_cast<std::uint64_t>(static_cast<double>(to - from) * static_cast<double>(n) /
                                          static_cast<double>(pieces));
    const auto T_odom_base = pose(stamp);
    if (!T_odom_base) return T_odom_base.error();
    const Pose3 T = T_end_odom * *T_odom_base * T_base_sensor;
    deskew.knots_.push_back({T.orientation.toRotationMatrix().cast<float>(), T.position.cast<float>()});
  }
  return deskew;
}

Deskew Deskew::none(const Pose3& T_base_sensor) {
  Deskew deskew;
  const Knot knot{T_base_sensor.orientation.toRotationMatrix().cast<float>(),
                  T_base_sensor.position.cast<float>()};
  deskew.knots_ = {knot, knot};
  return deskew;
}

}  // namespace adit::perception
