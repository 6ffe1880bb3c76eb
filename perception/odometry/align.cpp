// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/align.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/geometry/round_down.hpp"
#include "perception/odometry/registration.hpp"

namespace adit::perception {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr double kSearchStep = 0.25, kSearchTurn = 0.045;  ///< Between poses that are tried, m, rad.
constexpr std::size_t kSearchPoints = 300;                 ///< Of the source, for comparing poses.
constexpr std::size_t kCoarsePoints = 1000;
constexpr std::size_t kCandidates = 6;  ///< Poses that are refined.
constexpr double kNear = 0.4;           ///< Distance from a plane that counts in a comparison, m.
constexpr double kOnPlane = 0.10;       ///< A point so near lies on its plane, m.
constexpr int kFineLevel = 1;           ///< Of the planes of the last search: half a metre.
constexpr double kFineWindow = 0.05;    ///< m
constexpr float kLevel = 0.9f;          ///< Vertical part of the normal of a floor.

/// Every n-th point, at most `wanted`.
Points some_of(const Points& points, std::size_t wanted) {
  Points out;
  const std::size_t step = std::max<std::size_t>(1, (points.size() + wanted - 1) / wanted);
  for (std::size_t n = 0; n < points.size(); n += step) out.push_back(points[n]);
  return out;
}

/// The mean of the points in each voxel, in the order in which the voxels were met.
Points means(std::span<const Eigen::Vector3f> points, float edge) {
  constexpr float kFar = 1e5f;                        // m
  FlatHash<std::uint32_t> voxels(points.size() / 8);  // Positions in `sums`, from 1 on.
  std::vector<Eigen::Vector4f> sums;
  const float scale = 1.0f / edge;
  std::uint64_t last_key = FlatHash<std::uint32_t>::kEmpty;
  std::uint32_t last = 0;
  for (const Eigen::Vector3f& p : points) {
    if (!(p.cwiseAbs().maxCoeff() < kFar)) continue;  // Also of NaN.
    const auto index = [scale](float v) { return round_down(v * scale); };
    const std::uint64_t key = voxel_key(index(p.x()), index(p.y()), index(p.z()));
    if (key != last_key) {
      std::uint32_t& at = voxels.at(key);
      if (at == 0) {
        sums.push_back(Eigen::Vector4f::Zero());
        at = static_cast<std::uint32_t>(sums.size());
      }
      last_key = key;
      last = at - 1;
    }
    sums[last] += Eigen::Vector4f(p.x(), p.y(), p.z(), 1.0f);
  }
  Points out;
  out.reserve(sums.size());
  for (const Eigen::Vector4f& sum : sums) out.push_back(sum.head<3>() / sum[3]);
  return out;
}

struct Candidate {
  Pose3 pose{};
  double score{};
};

/// How well points lie on the upright planes, a number in [0, 1].
double score_of(const VoxelPlanes& target, const Points& points, const Pose3& pose) {
  const Eigen::Matrix3d R = pose.orientation.toRotationMatrix();
  double sum = 0;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d place = R * p.cast<double>() + pose.position;
    const auto plane = target.find(place);
    if (!plane || std::abs(plane->normal.z()) > kLevel) continue;
    const double off = plane->normal.cast<double>().dot(place - plane->centre) / kNear;
    sum += std::max(0.0, 1.0 - off * off);
  }
  return points.empty() ? 0.0 : sum / static_cast<double>(points.size());
}

/// The guess and poses around it, the best first.
std::vector<Candidate> search(const VoxelPlanes& target, const Points& points, const Pose3& guess,
                              const AlignParams& params) {
  const int steps = static_cast<int>(std::ceil(params.search_distance / kSearchStep - 1e-9));
  const int turns = static_cast<int>(std::ceil(params.search_angle / kSearchTurn - 1e-9));
  std::vector<Candidate> all;
  if (steps + turns == 0) return {{guess, 0.0}};
  for (int turn = -turns; turn <= turns; ++turn) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(turn * kSearchTurn, Eigen::Vector3d::UnitZ()));
    for (int y = -steps; y <= steps; ++y)
      for (int x = -steps; x <= steps; ++x) {
        const Eigen::Vector3d shift(x * kSearchStep, y * kSearchStep, 0);
        const Pose3 pose{guess.position + shift, q * guess.orientation};
        all.push_back({pose, score_of(target, points, pose)});
      }
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  if (all.size() > kCandidates) all.resize(kCandidates);
  return all;
}

/// Overlap and residuals of a pose.
void assess(const VoxelPlanes& target, const Points& points, Alignment& out) {
  const Eigen::Matrix3d R = out.pose.orientation.toRotationMatrix();
  std::size_t upright = 0, level = 0;
  double squares = 0;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d place = R * p.cast<double>() + out.pose.position;
    const auto plane = target.find(place);
    if (!plane) continue;
    const double off = plane->normal.cast<double>().dot(place - plane->centre);
    if (std::abs(off) > kOnPlane) continue;
    squares += off * off;
    ++(std::abs(plane->normal.z()) > kLevel ? level : upright);
  }
  const std::size_t on = upright + level, others = points.size() - level;
  out.rmse = on > 0 ? std::sqrt(squares / static_cast<double>(on)) : 0.0;
  out.overlap = others > 0 ? static_cast<double>(upright) / static_cast<double>(others) : 0.0;
}

}  // namespace

VoxelPlanes align_target(std::span<const Eigen::Vector3f> points, double range_noise) {
  VoxelPlanes::Params params;
  params.levels = VoxelPlanes::kMaxLevels;
  params.noise = static_cast<float>(range_noise);
  params.max_voxels = 500'000;
  return VoxelPlanes::of(points, params);
}

Alignment align(const VoxelPlanes& target, std::span<const Eigen::Vector3f> source, const Pose3& guess,
                const AlignParams& params) {
  const Points points = means(source, params.voxel);
  const Points coarse = some_of(points, kCoarsePoints);
  RegistrationParams registering;
  registering.range_noise = params.range_noise;
  registering.bearing_noise = 0.001;
  registering.huber = 3.0;
  registering.has_prior = params.keeps_undetermined;
  registering.max_iterations = 20;
  Registration registration(registering);
  const Eigen::Matrix<double, 6, 6> no_prior = Eigen::Matrix<double, 6, 6>::Zero();
  const int top = target.levels() - 1;
  const auto refine = [&](const Points& on, const Pose3& from, int level, double window) {
    return registration.align(target, on, from, no_prior, window, std::max(0, std::min(level, top)));
  };

  Alignment best;
  best.overlap = -1.0;
  for (const Candidate& each : search(target, some_of(points, kSearchPoints), guess, params)) {
    Alignment found;
    found.pose = refine(coarse, each.pose, top, params.window).pose;
    found.pose = refine(coarse, found.pose, top - 1, 0.3 * params.window).pose;
    assess(target, coarse, found);
    if (found.overlap > best.overlap) best = found;
  }
  // Each search begins by matching the points again; in between that happens only after some motion.
  Registered found = refine(points, best.pose, kFineLevel, kFineWindow);
  for (int again = 0; again < 2; ++again) found = refine(points, found.pose, kFineLevel, kFineWindow);
  best.pose = found.pose;
  best.information = found.information;
  best.localizability = found.localizability;
  best.converged = found.converged;
  assess(target, points, best);
  return best;
}

}  // namespace adit::perception
