// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/falco/correspondence.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace adit::nav {
namespace {

/// Tolerance, m: driving straight along a wall does not count as moving deeper.
constexpr float kSlack = 0.002f;

/// Four rays at a time: a planner library is built at each start of an agent.
using Lanes = float __attribute__((vector_size(16)));
constexpr int kLanes = 4;

/// Rasterises the sweep of the body: marks the cells that it covers at a pose.
class SweepRasteriser {
 public:
  SweepRasteriser(std::vector<PathMask>& masks, int rings, const Footprint& body)
      : masks_(masks), rings_(rings), body_(body), radius_(body.radius()) {
    for (std::size_t i = 0; i < cos_.size(); ++i) {
      const double angle = (static_cast<int>(i) % kAngles + 0.5) * 2.0 * M_PI / kAngles;
      cos_[i] = static_cast<float>(std::cos(angle));
      sin_[i] = static_cast<float>(std::sin(angle));
    }
    start_rings_ = std::min(rings, static_cast<int>(std::ceil(radius_ / CorrespondenceGrid::kRing)));
    for (int ring = 0; ring < start_rings_; ++ring)
      for (int a = 0; a < kAngles; ++a)
        start_.push_back(kSlack + std::max(0.0f, body.depth(range(ring) * cos_[a], range(ring) * sin_[a])));
  }

  void paint(const Pose2& pose, int bit) {
    const double distance = std::hypot(pose.x, pose.y);
    int half = kAngles / 2;
    if (distance > radius_) half = static_cast<int>(std::asin(radius_ / distance) * 180.0 / M_PI) + 2;
    const int middle = static_cast<int>(std::floor(std::atan2(pose.y, pose.x) * 180.0 / M_PI));
    const auto c = static_cast<float>(std::cos(pose.yaw)), s = static_cast<float>(std::sin(pose.yaw));
    const auto x0 = static_cast<float>(pose.x), y0 = static_cast<float>(pose.y);
    const float bx = c * x0 + s * y0, by = c * y0 - s * x0;
    const int end = middle + half + kAngles;
    for (int i = middle - half + kAngles; i < end; i += kLanes) {
      Lanes cosine, sine;
      std::memcpy(&cosine, &cos_[i], sizeof cosine);
      std::memcpy(&sine, &sin_[i], sizeof sine);
      // Along a ray the body's coordinates are linear in the range, so the body covers one interval of
      // ranges.
      const Lanes ux = c * cosine + s * sine, uy = c * sine - s * cosine;
      Lanes from{}, to = from + range(rings_);
      for (const Footprint::Edge& e : body_.edges())
        clip(e.nx * ux + e.ny * uy, e.offset - kSlack + e.nx * bx + e.ny * by, from, to);
      for (int lane = 0; lane < std::min(kLanes, end - i); ++lane) {
        if (to[lane] < from[lane] - 2 * kRing) continue;
        const int first = static_cast<int>(std::ceil(from[lane] / kRing - 0.5f));
        const int last = std::min(rings_ - 1, static_cast<int>(to[lane] / kRing - 0.5f));
        const int angle = (i + lane) % kAngles;
        for (int ring = first; ring <= std::min(last, start_rings_ - 1); ++ring) {
          const int index = ring * kAngles + angle;
          if (masks_[index].test(bit)) continue;
          const float r = range(ring);
          if (body_.depth(r * ux[lane] - bx, r * uy[lane] - by) > start_[index]) masks_[index].set(bit);
        }
        mark(angle, std::max(first, start_rings_), last, bit);
      }
    }
  }

 private:
  static constexpr int kAngles = CorrespondenceGrid::kAngles;
  static constexpr auto kRing = static_cast<float>(CorrespondenceGrid::kRing);
  static float range(int ring) { return (static_cast<float>(ring) + 0.5f) * kRing; }
  /// Marks these rings; those that the pose before marked are not written again.
  void mark(int angle, int first, int last, int bit) {
    Marked& marked = marked_[angle];
    if (marked.bit != bit || first > marked.last || last < marked.first) marked = {bit, first, first - 1};
    for (int ring = first; ring < marked.first; ++ring) masks_[ring * kAngles + angle].set(bit);
    for (int ring = marked.last + 1; ring <= last; ++ring) masks_[ring * kAngles + angle].set(bit);
    marked = {bit, std::min(marked.first, first), std::max(marked.last, last)};
  }
  /// Narrows [from, to] to the ranges r with r * slope <= most.
  static void clip(const Lanes& slope, float most, Lanes& from, Lanes& to) {
    constexpr float kLevel = 1e-6f;
    const Lanes bound = most / slope;
    if (most < 0) to = slope > -kLevel && slope < kLevel ? Lanes{} - 1.0f : to;
    to = slope >= kLevel && bound < to ? bound : to;
    from = slope <= -kLevel && bound > from ? bound : from;
  }

  /// Rings of one ray, without a gap.
  struct Marked {
    int bit{-1}, first{}, last{-1};
  };

  std::vector<PathMask>& masks_;
  int rings_;
  Footprint body_;
  double radius_;
  int start_rings_{};
  /// Of each ray, from one turn before the first to two after it.
  std::array<float, 2 * kAngles + kLanes> cos_{}, sin_{};
  std::array<Marked, kAngles> marked_{};
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
