// SPDX-License-Identifier: Apache-2.0
#include "perception/input/body_filter.hpp"

#include <algorithm>

namespace adit::perception {
namespace {

constexpr double kAbove = 0.05;  ///< An aerial or a mast is a little higher than the file says, m.
constexpr double kBelow = 0.3;   ///< Wheels stand lower than base_link where the ground falls, m.

}  // namespace

BodyFilter::BodyFilter(const Platform& platform) {
  std::vector<Eigen::Vector2d> corners = platform.footprint;
  if (corners.empty()) {
    const double x = platform.length / 2, y = platform.width / 2;
    corners = {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
  }
  double radius = 0, top = std::max(platform.height, platform.lidar_height);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d along = corners[(i + 1) % corners.size()] - corners[i];
    const Eigen::Vector2d normal = Eigen::Vector2d(along.y(), -along.x()).normalized();
    edges_.push_back({normal.cast<float>(), static_cast<float>(normal.dot(corners[i]))});
    radius = std::max(radius, corners[i].norm());
  }
  radius2_ = static_cast<float>(radius * radius);
  top_ = static_cast<float>(top + kAbove);
  bottom_ = static_cast<float>(-kBelow);
}

}  // namespace adit::perception
