// SPDX-License-Identifier: Apache-2.0
#include "sim/world/standing_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/world/distance_transform.hpp"

namespace adit::sim {
namespace {

constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();

}  // namespace

StandingMap::StandingMap(const World& world, double height, double step)
    : origin_(world.grid().origin()),
      resolution_(world.grid().resolution()),
      nx_(world.grid().nx()),
      ny_(world.grid().ny()),
      open_sides_(world.grid().open_sides()),
      outside_floor_(world.grid().levels().front()) {
  block(world, height, step);
  smooth();
  measure();
}

void StandingMap::block(const World& world, double height, double step) {
  floor_.resize(static_cast<std::size_t>(nx_) * ny_);
  blocked_.assign(floor_.size(), 0);
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i) floor_[index(i, j)] = static_cast<float>(world.column_floor(i, j, height));
  const float limit = static_cast<float>(step + 1e-4);
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i) {
      const float here = floor_[index(i, j)];
      bool blocked = std::isnan(here);
      for (int b = std::max(0, j - 1); b <= std::min(ny_ - 1, j + 1); ++b)
        for (int a = std::max(0, i - 1); a <= std::min(nx_ - 1, i + 1); ++a)
          blocked = blocked || here > floor_[index(a, b)] + limit;  // false beside a NaN
      blocked_[index(i, j)] = blocked;
    }
}

void StandingMap::smooth() {
  // A box average over columns that carry; along x, then along y.
  const int reach = std::max(1, static_cast<int>(kSupport / resolution_));
  const auto pass = [&](const std::vector<float>& sum, const std::vector<float>& count,
                        std::vector<float>& sum_out, std::vector<float>& count_out, int di, int dj) {
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i) {
        float s = 0.0f, c = 0.0f;
        for (int n = -reach; n <= reach; ++n) {
          const int a = i + n * di, b = j + n * dj;
          if (a < 0 || b < 0 || a >= nx_ || b >= ny_) continue;
          s += sum[index(a, b)];
          c += count[index(a, b)];
        }
        sum_out[index(i, j)] = s;
        count_out[index(i, j)] = c;
      }
  };
  std::vector<float> sum(floor_.size()), count(floor_.size()), row_sum(floor_.size()),
      row_count(floor_.size());
  for (std::size_t n = 0; n < floor_.size(); ++n) {
    sum[n] = blocked_[n] ? 0.0f : floor_[n];
    count[n] = blocked_[n] ? 0.0f : 1.0f;
  }
  pass(sum, count, row_sum, row_count, 1, 0);
  pass(row_sum, row_count, sum, count, 0, 1);
  ground_.resize(floor_.size());
  for (std::size_t n = 0; n < floor_.size(); ++n) ground_[n] = count[n] > 0.0f ? sum[n] / count[n] : kNowhere;
}

void StandingMap::measure() {
  // A border of blocked columns stands for what lies beside a closed world.
  const int rim = open_sides_ ? 0 : 1, width = nx_ + 2 * rim, height = ny_ + 2 * rim;
  std::vector<std::uint8_t> targets(static_cast<std::size_t>(width) * height, 1);
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i)
      targets[static_cast<std::size_t>(j + rim) * width + i + rim] = blocked_[index(i, j)];
  const std::vector<float> cells = distance_transform(targets, width, height);
  distance_.assign(floor_.size(), std::numeric_limits<float>::infinity());
  if (std::find(targets.begin(), targets.end(), 1) == targets.end()) return;
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i) {
      distance_[index(i, j)] =
          static_cast<float>(cells[static_cast<std::size_t>(j + rim) * width + i + rim] * resolution_);
      if (blocked_[index(i, j)]) bounds_.extend(middle(i, j));
    }
}

bool StandingMap::blocked_at(int i, int j) const {
  if (i < 0 || j < 0 || i >= nx_ || j >= ny_) return !open_sides_;
  return blocked_[index(i, j)] != 0;
}

double StandingMap::ground(double x, double y) const {
  // Bilinear between the middles of the columns; columns without ground are left out.
  const double gx = (x - origin_.x()) / resolution_ - 0.5, gy = (y - origin_.y()) / resolution_ - 0.5;
  if (gx < -0.5 || gy < -0.5 || gx >= nx_ - 0.5 || gy >= ny_ - 0.5)
    return open_sides_ ? outside_floor_ : std::numeric_limits<double>::quiet_NaN();
  const int i = static_cast<int>(std::floor(gx)), j = static_cast<int>(std::floor(gy));
  double sum = 0.0, weight = 0.0;
  for (int n = 0; n < 4; ++n) {
    const int a = std::clamp(i + n % 2, 0, nx_ - 1), b = std::clamp(j + n / 2, 0, ny_ - 1);
    const float g = ground_[index(a, b)];
    if (std::isnan(g)) continue;
    const double w = (n % 2 ? gx - i : 1.0 - gx + i) * (n / 2 ? gy - j : 1.0 - gy + j);
    sum += w * g;
    weight += w;
  }
  return weight > 1e-9 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
}

double StandingMap::contact(double x, double y, double expected, double reach) const {
  const double radius = std::max(kSupport, resolution_);
  double sum = 0.0, weight = 0.0;
  for (int j = column(y - radius, 1); j <= column(y + radius, 1); ++j) {
    const double wy = radius - std::abs(origin_.y() + resolution_ * (j + 0.5) - y);
    if (wy <= 0.0) continue;
    for (int i = column(x - radius, 0); i <= column(x + radius, 0); ++i) {
      const double wx = radius - std::abs(origin_.x() + resolution_ * (i + 0.5) - x);
      if (wx <= 0.0 || blocked_at(i, j)) continue;
      const bool inside = i >= 0 && j >= 0 && i < nx_ && j < ny_;
      const double floor = inside ? double{floor_[index(i, j)]} : outside_floor_;
      if (!(std::abs(floor - expected) <= reach)) continue;
      sum += wx * wy * floor;
      weight += wx * wy;
    }
  }
  return weight > 0.0 ? sum / weight : expected;
}

double StandingMap::distance(double x, double y) const {
  const int i = column(x, 0), j = column(y, 1);
  const int a = std::clamp(i, 0, nx_ - 1), b = std::clamp(j, 0, ny_ - 1);
  if (a == i && b == j) return distance_[index(i, j)];
  // Beside an open world: at least the way to the rectangle that holds all there is, and what the nearest
  // column of the map knows, less the way there.
  if (!open_sides_) return 0.0;
  if (bounds_.isEmpty()) return std::numeric_limits<double>::infinity();
  return std::max(bounds_.exteriorDistance(Eigen::Vector2d(x, y)),
                  distance_[index(a, b)] - resolution_ * std::hypot(i - a, j - b));
}

bool StandingMap::touches(const Rectangle& footprint) const {
  const double radius = footprint.radius();
  if (distance(footprint.pose.x, footprint.pose.y) > radius + 2.0 * resolution_) return false;
  const Rectangle cell{{}, resolution_, resolution_};
  for (int j = column(footprint.pose.y - radius, 1); j <= column(footprint.pose.y + radius, 1); ++j)
    for (int i = column(footprint.pose.x - radius, 0); i <= column(footprint.pose.x + radius, 0); ++i) {
      if (!blocked_at(i, j)) continue;
      Rectangle target = cell;
      target.pose = {middle(i, j).x(), middle(i, j).y(), 0.0};
      if (overlap(footprint, target)) return true;
    }
  return false;
}

double StandingMap::clearance(const Rectangle& footprint) const {
  if (touches(footprint)) return 0.0;
  const auto corners = footprint.corners();
  double nearest = std::numeric_limits<double>::infinity();
  for (int side = 0; side < 4; ++side) {
    const Eigen::Vector2d from = corners[side], along = corners[(side + 1) % 4] - from;
    const int count = std::max(1, static_cast<int>(std::ceil(along.norm() / resolution_)));
    for (int n = 0; n < count; ++n) {
      const Eigen::Vector2d p = from + along * n / count;
      nearest = std::min(nearest, distance(p.x(), p.y()));
    }
  }
  return std::max(0.0, nearest - 0.5 * resolution_);
}

}  // namespace adit::sim
