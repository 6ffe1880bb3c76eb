// SPDX-License-Identifier: Apache-2.0
#include "perception/objects/object_place.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace adit::perception {
namespace {

constexpr double kNearest = 0.1;  // m
// The outer parts of a box show what is behind, beside and under the object.
constexpr double kSideMargin = 0.15, kTopMargin = 0.1, kBottomMargin = 0.2;
constexpr double kGap = 0.3;           // Between the depths of two clusters, m.
constexpr double kGapShare = 0.03;     // The same by depth: beams and pixels are farther apart there.
constexpr std::size_t kMinPoints = 3;  // Of a cluster.
constexpr double kMinShare = 0.1;      // Of a cluster, of all points in the box: less is dust, or a wire.
constexpr double kNormal = 1.4826;     // Standard deviation by median absolute deviation.
constexpr double kHalfDepth = 0.25;    // Uncertainty of what is behind the surface, by the object's width.

double median(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The nearest cluster of depths that are sorted; empty: none is large enough.
std::span<double> nearest_cluster(std::span<double> depths) {
  const auto least =
      std::max(kMinPoints, static_cast<std::size_t>(kMinShare * static_cast<double>(depths.size())));
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= depths.size(); ++i) {
    if (i < depths.size() && depths[i] - depths[i - 1] <= std::max(kGap, kGapShare * depths[i])) continue;
    if (i - begin >= least) return depths.subspan(begin, i - begin);
    begin = i;
  }
  return {};
}

}  // namespace

std::optional<Eigen::Vector2d> PinholeView::project(const Eigen::Vector3d& point) const {
  if (!(point.x() > kNearest)) return std::nullopt;
  const double half = std::tan(field_of_view / 2.0);
  const double across = 0.5 - point.y() / point.x() / (2.0 * half);
  const double down = 0.5 - point.z() / point.x() / (2.0 * half) * aspect;
  if (across < 0.0 || across > 1.0 || down < 0.0 || down > 1.0) return std::nullopt;
  return Eigen::Vector2d(across, down);
}

Eigen::Vector3d PinholeView::ray(double across, double down) const {
  const double half = std::tan(field_of_view / 2.0);
  return {1.0, (0.5 - across) * 2.0 * half, (0.5 - down) * 2.0 * half / aspect};
}

std::optional<ObjectPlace> place_object(const ObjectBox& box, const PinholeView& view,
                                        std::span<const Eigen::Vector3f> points) {
  const double left = box.left + kSideMargin * box.width, right = box.left + (1.0 - kSideMargin) * box.width;
  const double top = box.top + kTopMargin * box.height, bottom = box.top + (1.0 - kBottomMargin) * box.height;
  std::vector<double> depths;
  for (const Eigen::Vector3f& point : points) {
    const auto at = view.project(point.cast<double>());
    if (at && at->x() >= left && at->x() <= right && at->y() >= top && at->y() <= bottom)
      depths.push_back(point.x());
  }
  std::ranges::sort(depths);
  const std::span<double> cluster = nearest_cluster(depths);
  if (cluster.empty()) return std::nullopt;
  ObjectPlace out{.points = cluster.size()};
  const double depth = median(cluster);
  const double half = std::tan(view.field_of_view / 2.0);
  const double width = box.width * depth * 2.0 * half;
  const double height = box.height * depth * 2.0 * half / view.aspect;
  if ((box.shortest > 0.0 && height < box.shortest) || (box.tallest > 0.0 && height > box.tallest))
    return std::nullopt;
  out.position = depth * view.ray(box.left + box.width / 2.0, box.top + box.height / 2.0);
  for (double& each : cluster) each = std::abs(each - depth);
  const double spread = kNormal * median(cluster);
  out.sigma = std::hypot(spread, kHalfDepth * width);
  return out;
}

}  // namespace adit::perception
