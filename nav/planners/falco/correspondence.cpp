// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/falco/correspondence.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

/// Tolerance, m: driving straight along a wall does not count as moving deeper.
constexpr float kSlack = 0.002f;

/// Rasterises the sweep of the body: marks the cells that it covers at a pose.
class SweepRasteriser {
 public:
  SweepRasteriser(std::vector<PathMask>& masks, int rings, const Footprint& body)
      : masks_(masks), rings_(rings), body_(body), radius_(body.radius()) {
    for (int a = 0; a < CorrespondenceGrid::kAngles; ++a) {
      const double angle = (a + 0.5) * 2.0 * M_PI / CorrespondenceGrid::kAngles;
      cos_[a] = static_cast<float>(std::cos(angle));
      sin_[a] = static_cast<float>(std::sin(angle));
    }
    start_rings_ = std::min(rings, static_cast<int>(std::ceil(radius_ / CorrespondenceGrid::kRing)));
    for (int ring = 0; ring < start_rings_; ++ring)
      for (int a = 0; a < CorrespondenceGrid::kAngles; ++a)
        start_.push_back(kSlack + std::max(0.0f, body.depth(range(ring) * cos_[a], range(ring) * sin_[a])));
  }

  void paint(const Pose2& pose, int bit) {
    const double distance = std::hypot(pose.x, pose.y);
    int half = CorrespondenceGrid::kAngles / 2;
    if (distance > radius_) half = static_cast<int>(std::asin(radius_ / distance) * 180.0 / M_PI) + 2;
    const int middle = static_cast<int>(std::floor(std::atan2(pose.y, pose.x) * 180.0 / M_PI));
    const auto c = static_cast<float>(std::cos(pose.yaw)), s = static_cast<float>(std::sin(pose.yaw));
    const auto x0 = static_cast<float>(pose.x), y0 = static_cast<float>(pose.y);
    const float bx = c * x0 + s * y0, by = c * y0 - s * x0;
    for (int i = middle - half; i < middle + half; ++i) {
      const int a = (i + 2 * CorrespondenceGrid::kAngles) % CorrespondenceGrid::kAngles;
      // Along a ray the body's coordinates are linear in the range, so the body covers one interval of
      // ranges.
      const float ux = c * cos_[a] + s * sin_[a], uy = c * sin_[a] - s * cos_[a];
      float from = 0.0f, to = range(rings_);
      for (const Footprint::Edge& e : body_.edges())
        clip(e.nx * ux + e.ny * uy, e.offset - kSlack + e.nx * bx + e.ny * by, from, to);
      const int last = std::min(rings_ - 1, static_cast<int>(to / kRing - 0.5f));
      for (int ring = static_cast<int>(std::ceil(from / kRing - 0.5f)); ring <= last; ++ring) {
        const int index = ring * CorrespondenceGrid::kAngles + a;
        const float r = range(ring);
        if (ring < start_rings_ && body_.depth(r * ux - bx, r * uy - by) <= start_[index]) continue;
        masks_[index].set(bit);
      }
    }
  }

 private:
  static constexpr auto kRing = static_cast<float>(CorrespondenceGrid::kRing);
  static float range(int ring) { return (static_cast<float>(ring) + 0.5f) * kRing; }
  /// Narrows [from, to] to the ranges r with r * slope <= most.
  static void clip(float slope, float most, float& from, float& to) {
    if (std::fabs(slope) < 1e-6f) {
      if (most < 0) to = -1.0f;
    } else if (slope > 0) {
      to = std::min(to, most / slope);
    } else {
      from = std::max(from, most / slope);
    }
  }

  std::vector<PathMask>& masks_;
  int rings_;
  Footprint body_;
  double radius_;
  int start_rings_{};
  std::array<float, CorrespondenceGrid::kAngles> cos_{}, sin_{};
  std::vector<float> start_{};  ///< Permitted depth of each cell inside the margin: its depth at the start.
};

}  // namespace

CorrespondenceGrid::CorrespondenceGrid(const PathTree& tree, const Footprint& body) {
  const double reach = tree.length() + body.radius();
  rings_ = static_cast<int>(std::ceil(reach / kRing));
  masks_.resize(static_cast<std::size_t>(rings_) * kAngles);
  SweepRasteriser rasteriser(masks_, rings_, body);
  // Every second pose is rasterised: 10 cm apart, for a body several times as long.
  constexpr std::size_t kStride = 2;
  for (int stage = 0; stage < PathTree::kStages; ++stage) {
    const std::size_t begin = stage == 0 ? 0 : tree.last_pose(stage - 1);
    const std::size_t end = tree.last_pose(stage);
    for (int node = 0; node < PathTree::kNodes[stage]; ++node) {
      const auto path = tree.path(PathTree::path_through(stage, node));
      const int bit = PathTree::kFirstBit[stage] + node;
      for (std::size_t i = begin; i < end; i += kStride) rasteriser.paint(path[i], bit);
      rasteriser.paint(path[end], bit);
    }
  }
  half_angle_.assign(rings_, -1);
  for (int ring = 0; ring < rings_; ++ring)
    for (int a = 0; a < kAngles; ++a)
      if (at(ring, a).any()) half_angle_[ring] = std::max(half_angle_[ring], a < 180 ? a : kAngles - 1 - a);
}

}  // namespace adit::nav
