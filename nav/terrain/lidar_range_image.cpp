// SPDX-License-Identifier: Apache-2.0
#include "nav/terrain/lidar_range_image.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

void LidarRangeImage::clear() {
  std::fill(bins_.begin(), bins_.end(), kEmpty);
  lowest_ = 0.0f;
}

bool LidarRangeImage::saw_through(const Eigen::Vector3f& low, const Eigen::Vector3f& high,
                                  float beyond) const {
  const float x = 0.5f * (low.x() + high.x()), y = 0.5f * (low.y() + high.y());
  const float range = std::sqrt(x * x + y * y);
  const int column = column_of(diamond_angle(x, y));
  const int first = std::max(0, row_of(low.z() / range));
  const int last = std::min(kRows - 1, row_of(high.z() / range));
  const auto need = static_cast<std::uint16_t>(std::min(60000.0f, (range + beyond) * 100.0f));
  for (int row = first; row <= last; ++row) {
    const std::uint16_t bin = bins_[row * kColumns + column];
    if (bin != kEmpty && bin > need) return true;
  }
  return false;
}

Eigen::Vector2f LidarRangeImage::direction_of(int column) {
  float turn = (static_cast<float>(column) + 0.5f) * (4.0f / kColumns);
  if (turn >= 3.0f) turn -= 4.0f;                    // [-1, 3)
  const float t = turn > 1.0f ? 2.0f - turn : turn;  // y divided by |x| + |y|.
  const float x = (turn > 1.0f ? -1.0f : 1.0f) * (1.0f - std::fabs(t));
  return Eigen::Vector2f(x, t).normalized();
}

}  // namespace adit::nav
