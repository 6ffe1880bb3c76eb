// SPDX-License-Identifier: Apache-2.0
#include "sim/cloud/evaluation.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace adit::sim {
namespace {

constexpr double kPerRadian = 180.0 / M_PI;

struct Matched {
  std::vector<Pose3> truth{}, estimate{};
};

/// Index of the stamp nearest to `stamp`, the first of equally near ones.
std::size_t nearest(std::span<const StampedPose> poses, bool sorted, double stamp) {
  std::size_t begin = 0, end = poses.size();
  if (sorted) {
    const auto by_stamp = [](const StampedPose& p, double s) { return p.stamp_s < s; };
    const auto after = std::lower_bound(poses.begin(), poses.end(), stamp, by_stamp);
    end = std::min<std::size_t>(static_cast<std::size_t>(after - poses.begin()) + 1, poses.size());
    begin = end - 1;
    if (after != poses.begin())
      begin = static_cast<std::size_t>(
          std::lower_bound(poses.begin(), after, (after - 1)->stamp_s, by_stamp) - poses.begin());
  }
  std::size_t best = begin;
  for (std::size_t n = begin + 1; n < end; ++n)
    if (std::abs(poses[n].stamp_s - stamp) < std::abs(poses[best].stamp_s - stamp)) best = n;
  return best;
}

Matched associate(std::span<const StampedPose> truth, std::span<const StampedPose> estimate,
                  double max_diff) {
  const bool estimate_longer = estimate.size() > truth.size();
  const auto longer = estimate_longer ? estimate : truth, shorter = estimate_longer ? truth : estimate;
  Matched out;
  if (longer.empty()) return out;
  const bool sorted =
      std::is_sorted(longer.begin(), longer.end(),
                     [](const StampedPose& a, const StampedPose& b) { return a.stamp_s < b.stamp_s; });
  for (const StampedPose& pose : shorter) {
    const StampedPose& other = longer[nearest(longer, sorted, pose.stamp_s)];
    if (!(std::abs(other.stamp_s - pose.stamp_s) <= max_diff)) continue;
    out.truth.push_back((estimate_longer ? pose : other).pose);
    out.estimate.push_back((estimate_longer ? other : pose).pose);
  }
  return out;
}

std::vector<Eigen::Vector3d> positions(std::span<const Pose3> poses) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(poses.size());
  for (const Pose3& pose : poses) out.push_back(pose.position);
  return out;
}

/// The poses between which relative errors are taken, each with the next one.
std::vector<std::size_t> marks(std::span<const Pose3> poses, const EvaluationParams& params) {
  std::vector<std::size_t> out;
  if (!params.delta_in_metres) {
    const auto step = static_cast<std::size_t>(std::max(1.0, params.delta));
    for (std::size_t n = 0; n < poses.size(); n += step) out.push_back(n);
    return out;
  }
  double path = 0.0;
  for (std::size_t n = 1; n < poses.size(); ++n) {
    path += (poses[n].position - poses[n - 1].position).norm();
    if (path < params.delta) continue;
    out.push_back(n);
    path = 0.0;
  }
  return out;
}

double angle_deg(const Eigen::Quaterniond& q) {
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w())) * kPerRadian;
}

}  // namespace

ErrorStatistics statistics(std::span<const double> errors) {
  ErrorStatistics out;
  const auto count = static_cast<double>(errors.size());
  for (const double e : errors) out.sse += e * e;
  out.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  double spread = 0.0;
  for (const double e : errors) spread += (e - out.mean) * (e - out.mean);
  out.std = std::sqrt(spread / count);
  out.rmse = std::sqrt(out.sse / count);
  std::vector<double> sorted(errors.begin(), errors.end());
  std::sort(sorted.begin(), sorted.end());
  out.min = sorted.front();
  out.max = sorted.back();
  const std::size_t half = sorted.size() / 2;
  out.median = sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
  return out;
}

Result<Pose3> umeyama(std::span<const Eigen::Vector3d> from, std::span<const Eigen::Vector3d> to) {
  if (from.size() < 3 || from.size() != to.size())
    return {Reason::bad_argument, "an alignment needs three points of each"};
  Eigen::Vector3d mean_from = Eigen::Vector3d::Zero(), mean_to = mean_from;
  for (const Eigen::Vector3d& p : from) mean_from += p;
  for (const Eigen::Vector3d& p : to) mean_to += p;
  mean_from /= static_cast<double>(from.size());
  mean_to /= static_cast<double>(to.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t n = 0; n < from.size(); ++n)
    covariance += (to[n] - mean_to) * (from[n] - mean_from).transpose();
  covariance /= static_cast<double>(from.size());
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()(1) > std::numeric_limits<double>::epsilon()))
    return {Reason::bad_argument, "the path lies on one line: it cannot be aligned"};
  Eigen::Vector3d sign(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) sign.z() = -1;
  const Eigen::Matrix3d rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  return Pose3{mean_to - rotation * mean_from, Eigen::Quaterniond(rotation)};
}

Result<Evaluation> evaluate(std::span<const StampedPose> truth, std::span<const StampedPose> estimate,
                            const EvaluationParams& params) {
  Matched matched = associate(truth, estimate, params.max_diff);
  if (matched.truth.empty())
    return {Reason::bad_argument,
            fmt::format("no stamps of the two trajectories are within {} s of each other", params.max_diff)};
  Evaluation out;
  out.poses = matched.truth.size();
  if (params.align) {
    const Result<Pose3> aligned = umeyama(positions(matched.estimate), positions(matched.truth));
    if (!aligned) return aligned.error();
    out.T_truth_estimate = *aligned;
    for (Pose3& pose : matched.estimate) pose = *aligned * pose;
  }
  std::vector<double> metres, degrees;
  for (std::size_t n = 0; n < out.poses; ++n) {
    const Pose3 &t = matched.truth[n], &e = matched.estimate[n];
    metres.push_back((e.position - t.position).norm());
    degrees.push_back(angle_deg(e.orientation.conjugate() * t.orientation));
    if (n > 0) out.length += (t.position - matched.truth[n - 1].position).norm();
  }
  out.ate = statistics(metres);
  out.ate_deg = statistics(degrees);
  metres.clear();
  degrees.clear();
  const std::vector<std::size_t> ids = marks(matched.estimate, params);
  for (std::size_t n = 1; n < ids.size(); ++n) {
    const std::size_t i = ids[n - 1], j = ids[n];
    const Pose3 by_truth = matched.truth[i].inverse() * matched.truth[j];
    const Pose3 error = by_truth.inverse() * (matched.estimate[i].inverse() * matched.estimate[j]);
    metres.push_back(error.position.norm());
    degrees.push_back(angle_deg(error.orientation));
  }
  if (metres.empty())
    return {Reason::bad_argument, fmt::format("no two of {} poses are {} {} apart", out.poses, params.delta,
                                              params.delta_in_metres ? "m" : "poses")};
  out.pairs = metres.size();
  out.rpe = statistics(metres);
  out.rpe_deg = statistics(degrees);
  return out;
}

}  // namespace adit::sim
