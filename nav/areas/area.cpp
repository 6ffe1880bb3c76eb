// SPDX-License-Identifier: Apache-2.0
#include "nav/areas/area.hpp"

#include <algorithm>
#include <cmath>

#include "nav/geometry/segment.hpp"

namespace adit::nav {
namespace {

constexpr double kLeastSize = 0.01;  // m2
constexpr double kSame = 1e-6;       // m: corners nearer than this are the same.

bool is_name(std::string_view text) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  return !text.empty() && text.size() <= 32 && text.find_first_not_of(kLetters) == std::string_view::npos;
}

bool touch(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
           const Eigen::Vector2d& d) {
  const bool apart_ab = cross_of(b - a, c - a) * cross_of(b - a, d - a) > 0;
  const bool apart_cd = cross_of(d - c, a - c) * cross_of(d - c, b - c) > 0;
  if (!apart_ab && !apart_cd && std::fabs(cross_of(b - a, d - c)) > 0) return true;
  return std::min({squared_distance(a, c, d), squared_distance(b, c, d), squared_distance(c, a, b),
                   squared_distance(d, a, b)}) < kSame * kSame;
}

// Neighbouring sides share a corner and touch nowhere else, others do not touch at all.
bool is_simple(const std::vector<Eigen::Vector2d>& corners) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % n], &c = corners[(i + 2) % n];
    if (squared_distance(c, a, b) < kSame * kSame || squared_distance(a, b, c) < kSame * kSame) return false;
    for (std::size_t k = i + 2; k < n && (k + 1) % n != i; ++k)
      if (touch(a, b, corners[k], corners[(k + 1) % n])) return false;
  }
  return true;
}

double size_of(const std::vector<Eigen::Vector2d>& corners) {
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    twice += cross_of(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  return twice / 2;
}

}  // namespace

Result<Area> checked(Area area) {
  const auto refuse = [&](const char* why) -> Result<Area> {
    return {Reason::bad_argument, "area " + area.name + ": " + why};
  };
  if (!is_name(area.name)) return {Reason::bad_argument, "an area's name is 1 to 32 of A-Z a-z 0-9 _ -"};
  if (area.kind > AreaKind::prefer) return refuse("it is neither keep_in, keep_out nor prefer");
  if (area.corners.size() < 2) return refuse("it has less than two corners");
  if (area.corners.size() > Area::kMaxCorners) return refuse("it has more than 16 corners");
  for (const Eigen::Vector2d& corner : area.corners)
    if (!corner.allFinite() || corner.cwiseAbs().maxCoeff() > Area::kFarthest)
      return refuse("a corner is no place within 10 km");
  if (std::isnan(area.z_min) || std::isnan(area.z_max) || area.z_min > area.z_max)
    return refuse("its heights are no interval");
  if (!(area.weight >= 0.0 && area.weight <= Area::kMaxWeight)) return refuse("its weight is not in 0 to 10");
  if (area.corners.size() == 2) {
    const Eigen::Vector2d low = area.corners[0].cwiseMin(area.corners[1]);
    const Eigen::Vector2d high = area.corners[0].cwiseMax(area.corners[1]);
    area.corners = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  }
  const double size = size_of(area.corners);
  if (std::fabs(size) < kLeastSize) return refuse("it encloses nothing");
  if (!is_simple(area.corners)) return refuse("its sides touch or cross each other");
  if (size < 0) std::reverse(area.corners.begin() + 1, area.corners.end());
  return area;
}

}  // namespace adit::nav
