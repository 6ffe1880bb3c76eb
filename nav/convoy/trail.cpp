// SPDX-License-Identifier: Apache-2.0
#include "nav/convoy/trail.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {

void Trail::record(const Eigen::Vector3d& place) {
  if (points_.empty()) {
    points_.push_back(place);
    return;
  }
  if (leader_at(place) < length()) return;
  const Eigen::Vector3d step = place - points_.back();
  const double distance = step.norm();
  const Eigen::Vector3d from = points_.back();
  for (double along = kSpacing; along <= distance; along += kSpacing)
    points_.push_back(from + step * (along / distance));
  trim();
}

void Trail::trim() {
  for (; points_.size() > kCapacity; ++first_) points_.pop_front();
}

double Trail::leader_at(const Eigen::Vector3d& place) const {
  constexpr double kOnPath = 0.3;     // m: offset of a leader that drives back along its own path.
  constexpr double kBackSeen = 10.0;  // m: length of path that is searched for it.
  if (points_.empty()) return 0.0;
  const auto on = project(place, length() - kBackSeen, length());
  if (on->offset < kOnPath && on->along < length()) return on->along;
  return length() + (place - points_.back()).norm();
}

bool Trail::add(std::uint32_t first, std::span<const Eigen::Vector3d> points) {
  // Largest distance of consecutive points, m: their spacing, rounding, and a correction of the map.
  constexpr double kMaxStep = 3 * kSpacing;
  if (points.empty()) return true;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (!((points[i] - points[i - 1]).norm() <= kMaxStep)) return false;
  if (first > UINT32_MAX - points.size()) return false;
  const std::uint32_t last = first + static_cast<std::uint32_t>(points.size());
  if (points_.empty()) {
    first_ = first;
    points_.assign(points.begin(), points.end());
    return true;
  }
  if (first <= end() && last > end()) {
    const auto fresh = points.subspan(std::max(first, end()) - first);
    if (!((fresh.front() - points_.back()).norm() <= kMaxStep)) return false;
    points_.insert(points_.end(), fresh.begin(), fresh.end());
  } else if (last >= first_ && first < first_ && points_.size() < kCapacity) {
    const auto fresh = points.first(first_ - first);
    if (!((fresh.back() - points_.front()).norm() <= kMaxStep)) return false;
    points_.insert(points_.begin(), fresh.begin(), fresh.end());
    first_ = first;
  }
  trim();
  return true;
}

Eigen::Vector3d Trail::at(double along) const {
  const double index = std::clamp((along - start()) / kSpacing, 0.0, static_cast<double>(points_.size() - 1));
  const auto before = static_cast<std::size_t>(index);
  const std::size_t after = std::min(before + 1, points_.size() - 1);
  const double part = index - static_cast<double>(before);
  return (1.0 - part) * points_[before] + part * points_[after];
}

std::optional<Trail::Projection> Trail::project(const Eigen::Vector3d& place, double from, double to) const {
  if (points_.empty()) return std::nullopt;
  const double last = static_cast<double>(points_.size() - 1);
  const auto low = static_cast<std::size_t>(std::clamp(std::floor((from - start()) / kSpacing), 0.0, last));
  const auto high = static_cast<std::size_t>(std::clamp(std::ceil((to - start()) / kSpacing), 0.0, last));
  Projection best{kSpacing * (first_ + static_cast<double>(low)), (place - points_[low]).norm()};
  for (std::size_t i = low; i < high; ++i) {
    const Eigen::Vector3d step = points_[i + 1] - points_[i];
    const double part =
        std::clamp((place - points_[i]).dot(step) / std::max(step.squaredNorm(), 1e-9), 0.0, 1.0);
    const double offset = (points_[i] + part * step - place).norm();
    if (offset < best.offset) best = {kSpacing * (first_ + static_cast<double>(i) + part), offset};
  }
  if (first_ == 0 && best.along <= 0.0) best.along = -best.offset;
  return best;
}

}  // namespace adit::nav
