// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/fence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nav/routing/tile.hpp"

namespace adit::agent {
namespace {

constexpr double kSigmas = 3.0;
constexpr double kMostMargin = 10.0;  // m: of a robot that does not know its place at all.

/// The distance that is left to a body with that clearance.
double within(double clearance) { return (std::floor(clearance / Fence::kStep) - 1) * Fence::kStep; }

}  // namespace

double Fence::margin(double sigma) {
  const double wanted = nav::AreaSet::kMargin + kSigmas * sigma;
  if (!(wanted < kMostMargin)) return kMostMargin;  // Also for NaN.
  // A little less, so that rounding makes no step.
  return std::max(nav::AreaSet::kMargin, std::ceil(wanted / kStep - 1e-6) * kStep);
}

void Fence::convert(const nav::AreaSet& areas, const Frames& frames) {
  const bool others = !source_.same(areas);
  source_ = areas;
  map_epoch_ = frames.map_epoch();
  all_ = source_.in_frame(frames.T_map_odom().inverse(), frames.to_map(Eigen::Vector3d(0, 0, 0)).z());
  std::vector<Part> parts;
  nav::AreaSet inside = all_.only([](const nav::Area& a) { return a.kind == nav::AreaKind::keep_in; });
  if (!inside.empty()) parts.push_back({std::move(inside)});
  for (const nav::Area& area : all_.all())
    if (area.kind == nav::AreaKind::keep_out)
      parts.push_back({all_.only([&](const nav::Area& a) { return a.name == area.name; })});
  for (std::size_t i = 0; i < parts.size() && !others; ++i) parts[i].margin = parts_[i].margin;
  parts_ = std::move(parts);
}

nav::AreaSet Fence::with_margins(double farther) const {
  return all_.with_margins([&](const nav::Area& area) {
    for (const Part& part : parts_)
      if (part.areas.find(area.name)) return *part.margin < margin_ ? *part.margin - farther : margin_;
    return margin_;
  });
}

void Fence::update(const nav::AreaSet& areas, const Frames& frames, double sigma, bool bound) {
  if (areas.empty() && all_.empty()) return;
  const bool moved = !source_.same(areas) || map_epoch_ != frames.map_epoch();
  if (moved) convert(areas, frames);
  bool changed = moved || margin_ != margin(sigma);
  margin_ = margin(sigma);
  const auto body = nav::outline(platform_, frames.T_odom_base().planar());
  out_ = -std::numeric_limits<double>::infinity();
  for (Part& part : parts_) {
    const double clearance = part.areas.clearance(body, frames.T_odom_base().position.z());
    out_ = std::max(out_, -clearance);
    double left = std::min(margin_, within(clearance));
    if (bound && part.margin && !(moved && clearance < *part.margin - kStep))
      left = std::max(left, std::min(*part.margin, margin_));
    changed = changed || left != part.margin;
    part.margin = left;
  }
  if (!changed) return;
  all_ = all_.with_margin(margin_);
  binding_ = with_margins(0.0);
  routable_ = with_margins(nav::kRouteCell + kStep);
}

std::vector<Eigen::Vector2f> Fence::border(const Frames& frames, double range) const {
  std::vector<Eigen::Vector2f> points;
  nav::sample_border(binding_, frames.T_odom_base().position, range, points);
  return points;
}

}  // namespace adit::agent
