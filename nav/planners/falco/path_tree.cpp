// SPDX-License-Identifier: Apache-2.0
#include "nav/planners/falco/path_tree.hpp"

#include <algorithm>
#include <cmath>

namespace adit::nav {
namespace {

/// Curvature at `s` metres along a path whose generations have the curvatures `c`. It changes linearly over
/// `blend` at the start of the second and third segment; the first segment is curved from its start.
double curvature_at(double s, const std::array<double, 3>& c, const PathTreeParams& p) {
  const int segment = std::min(2, static_cast<int>(s / p.segment));
  if (segment == 0) return c[0];
  const double before = c[segment - 1];
  const double into = (s - segment * p.segment) / p.blend;
  return into >= 1.0 ? c[segment] : before + (c[segment] - before) * into;
}

}  // namespace

PathTree::PathTree(const PathTreeParams& params) : params_(params) {
  constexpr std::array<double, kStages> kEnds{0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0};
  const auto steps = static_cast<std::size_t>(std::lround(3.0 * params_.segment / params_.spacing));
  per_path_ = steps + 1;
  const double ds = 3.0 * params_.segment / static_cast<double>(steps);
  for (int i = 0; i < kStages; ++i) {
    stage_end_[i] = kEnds[i] * params_.segment;
    last_pose_[i] = static_cast<std::size_t>(std::lround(stage_end_[i] / ds));
  }

  poses_.reserve(per_path_ * kPaths);
  constexpr int kHalf = kFan / 2;
  for (int path = 0; path < kPaths; ++path) {
    const std::array<int, 3> child{path / (kFan * kFan), path / kFan % kFan, path % kFan};
    std::array<double, 3> bend{};
    for (int i = 0; i < 3; ++i) bend[i] = params_.curvature[i] * (child[i] - kHalf) / kHalf;
    Pose2 pose{};
    poses_.push_back(pose);
    for (std::size_t i = 0; i < steps; ++i) {
      // The midpoint rule is exact to a millimetre over three metres at steps of five centimetres.
      const double turn = ds * curvature_at((static_cast<double>(i) + 0.5) * ds, bend, params_);
      pose.x += ds * std::cos(pose.yaw + turn / 2);
      pose.y += ds * std::sin(pose.yaw + turn / 2);
      pose.yaw = wrap_angle(pose.yaw + turn);
      poses_.push_back(pose);
    }
  }

  bearing_.resize(kFirstBit[kStages]);
  for (int stage = 0; stage < kStages; ++stage)
    for (int node = 0; node < kNodes[stage]; ++node) {
      const Pose2& end = this->path(path_through(stage, node))[last_pose_[stage]];
      bearing_[kFirstBit[stage] + node] = static_cast<float>(std::atan2(end.y, end.x) * 180.0 / M_PI);
    }
}

int PathTree::stage_for(double distance) const {
  for (int stage = 0; stage < kStages; ++stage)
    if (stage_end_[stage] >= distance) return stage;
  return kStages - 1;
}

}  // namespace adit::nav
