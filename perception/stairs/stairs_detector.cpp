// SPDX-License-Identifier: Apache-2.0
#include "perception/stairs/stairs_detector.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/pose.hpp"

namespace adit::perception {
namespace {

constexpr float kBeyond = 1.8f;                  // A region's neighbourhood along it, m.
constexpr float kBesidePlane = 0.9f;             // Of the points that are looked at, m.
constexpr double kLeastPeriodic = 0.45;          // Of the squares about a plane; steps have 0.6 and more.
constexpr float kSlice = 0.1f;                   // Along a region, m.
constexpr std::size_t kPeriods = 3;              // That are tried: a half or a double one may be stronger.
constexpr std::size_t kMostInSlice = 60;         // Points for the fit.
constexpr std::size_t kMostForDirection = 5000;  // Points for the search of the direction.
constexpr double kUnequal = 0.015;    // Root mean square of the faces' offsets from equal steps, m.
constexpr double kBetter = 1.25;      // Than a plane, in spread: many points make any difference certain.
constexpr double kMostSpread = 0.04;  // m: range noise of 3 cm, and the odometry's errors meanwhile.
constexpr double kLeastClean = 0.6;

}  // namespace

void StairsDetector::gather(const SlopeRegion& region, std::span<const Eigen::Vector3f> points) {
  float reach = 0.0f;
  for (const Eigen::Vector3f& cell : region.cells) reach = std::max(reach, cell.head<2>().squaredNorm());
  reach = std::sqrt(reach) + kBeyond;
  gathered_.clear();
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f d = point - region.centre;
    if (d.head<2>().squaredNorm() > reach * reach) continue;
    if (std::abs(d.z() - region.slope * d.head<2>().dot(region.uphill)) > kBesidePlane) continue;
    gathered_.push_back(d);
  }
}

void StairsDetector::collect(const SlopeRegion& region, const Eigen::Vector2f& uphill, std::size_t stride) {
  const Eigen::Vector2f left(-uphill.y(), uphill.x());
  extent_ = extent(region, uphill);
  around_.clear();
  core_.clear();
  for (std::size_t n = 0; n < gathered_.size(); n += stride) {
    const Eigen::Vector3f& d = gathered_[n];
    const SlopePoint p(d.head<2>().dot(uphill), d.head<2>().dot(left), d.z());
    around_.push_back(p);
    if (p.y() >= extent_.right && p.y() <= extent_.left && p.x() >= extent_.begin - 0.1f &&
        p.x() <= extent_.end + 0.1f)
      core_.push_back(p);
  }
  thin_core();
}

/// Cells at the borders of a region lean towards what lies beside it: its direction is that in which its
/// steps show.
bool StairsDetector::find_direction(const SlopeRegion& region, Eigen::Vector2f& uphill) {
  constexpr double widest = 0.64, step = 0.08;  // rad
  const std::size_t stride = gathered_.size() / kMostForDirection + 1;
  Eigen::Vector2f best = uphill;
  double most = -1.0;
  for (double turn = -widest; turn <= widest + 1e-9; turn += step) {
    const Eigen::Vector2f turned = Eigen::Rotation2Df(static_cast<float>(turn)) * uphill;
    collect(region, turned, stride);
    const double periodic = fitter_.periodicity(core_, region.slope);
    if (periodic > most) {
      most = periodic;
      best = turned;
    }
  }
  uphill = best;
  return most > kLeastPeriodic;
}

std::optional<Staircase> StairsDetector::judge(const SlopeRegion& region,
                                               std::span<const Eigen::Vector3f> points,
                                               const Eigen::Vector3f& eye, bool hides) {
  gather(region, points);
  const auto place_of_eye = [&](const Eigen::Vector2f& along) -> SlopePoint {
    constexpr float everywhere = 1e6f;  // Above all treads and before all risers.
    if (!hides) return {-everywhere, 0.0f, everywhere};
    const Eigen::Vector3f d = eye - region.centre;
    return {d.head<2>().dot(along), along.x() * d.y() - along.y() * d.x(), d.z()};
  };
  Eigen::Vector2f uphill = region.uphill;
  if (!find_direction(region, uphill)) return std::nullopt;
  for (int round = 0; round < 2; ++round) {
    collect(region, uphill, 1);
    const std::vector<StepFit>& fits = fitter_.fit(core_, region.slope, place_of_eye(uphill), 1);
    const auto best_fit =
        std::min_element(fits.begin(), fits.end(),
                         [](const StepFit& one, const StepFit& other) { return one.cost() < other.cost(); });
    if (best_fit == fits.end() || std::abs(best_fit->model.turn) < 0.02 ||
        std::abs(best_fit->model.turn) > 0.3)
      break;
    uphill = Eigen::Rotation2Df(static_cast<float>(best_fit->model.turn)) * uphill;
  }
  collect(region, uphill, 1);
  const Eigen::Vector2f left(-uphill.y(), uphill.x());
  std::optional<Staircase> best;
  double least_cost = 0.0;
  for (const StepFit& fit : fitter_.fit(core_, region.slope, place_of_eye(uphill), kPeriods)) {
    const StepModel& m = fit.model;
    if (m.run < Staircase::kLeastRun || m.run > Staircase::kMostRun || m.rise < Staircase::kLeastRise ||
        m.rise > Staircase::kMostRise || std::abs(m.turn) > 0.3)
      continue;
    const auto seen = evidence_.weigh(fit, around_, extent_.right, extent_.left);
    if (!seen) continue;
    const double width = seen->left - seen->right;
    if (width < Staircase::kLeastWidth || seen->clean < kLeastClean) continue;
    // Deviations below a centimetre are those of any building.
    constexpr double floor = 0.01;
    const double n = seen->independent, s = std::hypot(seen->spread, floor);
    const double better = std::hypot(seen->plane_spread, floor) / s;
    const double against_plane = 2 * n * std::log(better) - 2 * std::log(n);
    if (!(against_plane > 10.0) || better < kBetter || seen->spread > kMostSpread || seen->unequal > kUnequal)
      continue;
    if (best && fit.cost() >= least_cost) continue;
    least_cost = fit.cost();
    Staircase stairs;
    const double u = m.riser_u(seen->first), v = (seen->left + seen->right) / 2;
    // Back from along and across to the region's axes.
    const double x = u - m.turn * v, y = v + m.turn * u;
    const Eigen::Vector2d place =
        (region.centre.head<2>() + uphill * static_cast<float>(x) + left * static_cast<float>(y))
            .cast<double>();
    stairs.foot = {place.x(), place.y(), region.centre.z() + m.tread_h(seen->first) - m.rise / 2};
    stairs.heading = wrap_angle(std::atan2(uphill.y(), uphill.x()) + m.turn);
    stairs.rise = m.rise, stairs.run = m.run, stairs.width = width;
    stairs.steps = seen->last - seen->first + 1;
    const double noise = std::max(seen->spread, 0.01);
    stairs.sigma = {.place = std::max(0.01, noise * std::sqrt(fit.run_covariance(0, 0))),
                    .heading = noise * std::sqrt(fit.run_covariance(2, 2)),
                    .rise = noise * std::sqrt(fit.rise_covariance(1, 1)),
                    .run = noise * std::sqrt(fit.run_covariance(1, 1)),
                    .width = 0.05};
    if (valid(stairs)) best = stairs;
  }
  return best;
}

/// Near surfaces have a hundred times as many points as far ones, which say as much.
void StairsDetector::thin_core() {
  slices_.assign(static_cast<std::size_t>((extent_.end - extent_.begin + 0.4f) / kSlice) + 1, 0);
  const auto slice = [&](const SlopePoint& p) -> std::size_t& {
    return slices_[std::min(slices_.size() - 1,
                            static_cast<std::size_t>(std::max(0.0f, p.x() - extent_.begin + 0.2f) / kSlice))];
  };
  for (const SlopePoint& p : core_) ++slice(p);
  for (std::size_t& count : slices_) count = count / kMostInSlice + 1;
  std::size_t kept = 0;
  for (std::size_t n = 0; n < core_.size(); ++n)
    if (n % slice(core_[n]) == 0) core_[kept++] = core_[n];
  core_.resize(kept);
}

std::vector<Staircase> StairsDetector::detect(std::span<const Eigen::Vector3f> points,
                                              const Eigen::Vector3f& eye, bool hides) {
  std::vector<Staircase> found;
  cells_.build(points, eye);
  for (const SlopeRegion& region : regions_.find(cells_)) {
    if (auto stairs = judge(region, cells_.points(), eye, hides)) found.push_back(*stairs);
  }
  std::stable_sort(found.begin(), found.end(), [&](const Staircase& a, const Staircase& b) {
    return (a.foot - eye.cast<double>()).norm() < (b.foot - eye.cast<double>()).norm();
  });
  return found;
}

}  // namespace adit::perception
