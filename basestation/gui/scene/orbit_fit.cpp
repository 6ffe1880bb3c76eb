// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/scene/orbit_fit.hpp"

namespace adit::gui {
namespace {

/// The nearest place of the eye along one direction of the screen that sees all points between two slopes.
struct Edges {
  double first{1e12}, last{-1e12};  ///< Intercepts of the outermost lines of sight along that slope, m.
  double low{}, high{};             ///< Slopes of the edges of the view.
  void add(double across, double ahead) {
    first = std::min(first, across - low * ahead);
    last = std::max(last, across - high * ahead);
  }
  double ahead() const { return (first - last) / (high - low); }
  /// Of the eye, so that as much is free at both edges.
  double across(double eye_ahead) const { return (first + low * eye_ahead + last + high * eye_ahead) / 2; }
};

/// Both made smaller if they take too much of a side.
void limit(double& one, double& other, double side) {
  const double share = kMostMargin * side / std::max(one + other, 1e-9);
  if (share < 1.0) one *= share, other *= share;
}

}  // namespace

OrbitCamera fitted(const OrbitCamera& camera, const std::vector<Point3>& points, Margins margins) {
  constexpr double kNearest = 2.0;  // Distance of the target, m.
  if (points.empty()) return camera;
  limit(margins.left, margins.right, camera.width);
  limit(margins.top, margins.bottom, camera.height);
  const auto [right, down, ahead] = camera.axes();
  const double focal = camera.focal();
  Edges x{.low = (margins.left - camera.width / 2) / focal,
          .high = (camera.width / 2 - margins.right) / focal};
  Edges y{.low = (margins.top - camera.height / 2) / focal,
          .high = (camera.height / 2 - margins.bottom) / focal};
  if (!(x.high > x.low && y.high > y.low)) return camera;
  double nearest = 1e12, farthest = -1e12;
  for (const Point3& point : points) {
    const double depth = dot(point, ahead);
    x.add(dot(point, right), depth);
    y.add(dot(point, down), depth);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  const double middle = (nearest + farthest) / 2;
  OrbitCamera out = camera;
  out.distance = std::clamp(std::max(middle - std::min(x.ahead(), y.ahead()), kNearest),
                            OrbitCamera::kMinDistance, OrbitCamera::kMaxDistance);
  const double eye = middle - out.distance;
  out.target = x.across(eye) * right + y.across(eye) * down + middle * ahead;
  return out;
}

std::optional<ScreenBox> box_of(const OrbitCamera& camera, const std::vector<Point3>& points) {
  if (points.empty()) return std::nullopt;
  ScreenBox box{{1e9, 1e9}, {-1e9, -1e9}};
  for (const Point3& point : points) {
    const auto seen = camera.project(point);
    if (!seen) return std::nullopt;
    box.low = {std::min(box.low.x, seen->at.x), std::min(box.low.y, seen->at.y)};
    box.high = {std::max(box.high.x, seen->at.x), std::max(box.high.y, seen->at.y)};
  }
  return box;
}

}  // namespace adit::gui
