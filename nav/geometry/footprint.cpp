// SPDX-License-Identifier: Apache-2.0
#include "nav/geometry/footprint.hpp"

#include <algorithm>
#include <utility>

namespace adit::nav {

Footprint::Footprint(const Platform& platform) {
  if (platform.footprint.size() < 3) {
    *this = Footprint(platform.length / 2, platform.width / 2);
    return;
  }
  corner_count_ = std::min(platform.footprint.size(), corners_.size());
  std::copy_n(platform.footprint.begin(), corner_count_, corners_.begin());
  build();
}

Footprint::Footprint(double half_length, double half_width) {
  corner_count_ = 4;
  corners_[0] = {half_length, half_width};
  corners_[1] = {-half_length, half_width};
  corners_[2] = {-half_length, -half_width};
  corners_[3] = {half_length, -half_width};
  build();
}

Footprint Footprint::grown(double ahead, double behind, double across) const {
  Footprint more = *this;
  more.ahead_ += ahead;
  more.behind_ += behind;
  more.across_ += across;
  more.build();
  return more;
}

Footprint Footprint::turned() const {
  Footprint other = *this;
  for (std::size_t i = 0; i < corner_count_; ++i) other.corners_[i] = -corners_[i];
  other.build();
  return other;
}

bool Footprint::symmetric() const {
  constexpr double kSame = 1e-3;  // m
  const auto corners = std::span(corners_).first(corner_count_);
  return std::ranges::all_of(corners, [&](const Eigen::Vector2d& one) {
    return std::ranges::any_of(corners, [&](const Eigen::Vector2d& c) { return (c + one).norm() < kSame; });
  });
}

double Footprint::reach(double nx, double ny) const {
  double most = 0;
  for (std::size_t i = 0; i < corner_count_; ++i)
    most = std::max(most, nx * corners_[i].x() + ny * corners_[i].y());
  return most + (nx > 0 ? ahead_ * nx : -behind_ * nx) + across_ * std::fabs(ny);
}

void Footprint::build() {
  // The Minkowski sum of the polygon and the margins' rectangle has the normals of both.
  count_ = 0;
  radius_ = 0;
  const auto add = [this](double nx, double ny) {
    for (std::size_t i = 0; i < count_; ++i)
      if (std::hypot(edges_[i].nx - nx, edges_[i].ny - ny) < 1e-6) return;
    edges_[count_++] = {static_cast<float>(nx), static_cast<float>(ny), static_cast<float>(reach(nx, ny))};
  };
  for (std::size_t i = 0; i < corner_count_; ++i) {
    const Eigen::Vector2d side = corners_[(i + 1) % corner_count_] - corners_[i];
    const double length = side.norm();
    if (length > 1e-9) add(side.y() / length, -side.x() / length);
    const double x = std::max(corners_[i].x() + ahead_, behind_ - corners_[i].x());
    radius_ = std::max(radius_, std::hypot(x, std::fabs(corners_[i].y()) + across_));
  }
  for (const auto& [nx, ny] : {std::pair{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) add(nx, ny);
}

}  // namespace adit::nav
