// SPDX-License-Identifier: Apache-2.0
// Whether a cloud fits the map, and what is said of the pose when it does not.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "perception/odometry/lidar_odometry.hpp"

namespace adit::perception {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kLeastShare = 0.25;  ///< Of the points with a plane nearby that match it, and of Agreement.
constexpr double kFoundShare = 0.5;   ///< Of Agreement, after it was lost: more for than against it.
constexpr double kLeastAgainst =
    20.0;                             ///< Points that contradict; fewer are a person, or a door that opened.
constexpr int kBadForLost = 5;        ///< Clouds in a row that do not fit.
constexpr double kNewMapAfter = 5.0;  ///< Of clouds that do not fit, in a row, it begins a new map, s.
constexpr int kGoodForFound = 3;      ///< Clouds in a row that fit again.
constexpr double kMaxInnovation = 30.0;  ///< Squared standard deviations for each of six numbers.
constexpr int kFirstMotion = 5;          ///< Clouds in a row that fit, after which the motion is known.
constexpr double kLeastWindow = 0.05;    ///< m
constexpr double kMaxFree = 0.5;         ///< Without sensors of motion that the robot should have, s.
constexpr double kCarried = 2.0;         ///< Speed of a body that is carried or slides, m/s.
constexpr double kSlid = 0.5;            ///< A turn beyond what a registration finds, rad.

}  // namespace

void LidarOdometry::judge(const Registered& found) {
  const MotionState& prior = filter_.state();
  const Vector6 innovation = prior.to(found.pose);
  const Matrix6 P = prior.P.topLeftCorner<6, 6>();
  const double distance = innovation.dot(P.ldlt().solve(innovation)) / 6.0;
  const double share =
      static_cast<double>(found.matched) / static_cast<double>(std::max<std::size_t>(1, found.near));
  const double dt = last_stamp_ != 0 ? static_cast<double>(prior.stamp - last_stamp_) * 1e-9 : 0.0;
  const bool too_fast =
      params_.max_speed > 0 && dt > 0 && last_pose_ &&
      (found.pose.position - prior.rotation * params_.motion.imu_position - last_pose_->position).norm() >
          1.5 * params_.max_speed * dt + 0.2;
  const double wanted = state_.health == Localisation::lost ? kFoundShare : kLeastShare;
  const Agreement known =
      agreement(map_, space_, body_points_, found.pose, params_.registration.range_noise, wanted);
  const bool contradicted = known.contradict >= kLeastAgainst && known.share() < wanted;
  if (found.near < kLeastMatches && !contradicted) {
    // An open place: there is nothing to compare with, and nothing that contradicts the other sensors.
    state_.localizability = {};
    filter_.learn_scale(false);
    good_ = 0;
    if (state_.health != Localisation::lost) state_.health = Localisation::weak;
    return;
  }
  if (!contradicted && share >= kLeastShare) compare_wheels(found);
  if (contradicted || too_fast || share < kLeastShare || !(distance < kMaxInnovation)) return miss(dt);
  const bool was_lost = state_.health == Localisation::lost;
  ++good_;
  if (was_lost && good_ == 1) ++state_.steps;  // The first cloud that fits draws the pose to the map.
  if (!was_lost || good_ >= kGoodForFound) {
    bad_ = 0;
    missed_for_ = 0.0;
  }
  // What the prediction was off by at the distance of the points, as in KISS-ICP (Vizzo et al. 2023).
  const double off = innovation.head<3>().norm() + innovation.tail<3>().norm() * reach_;
  window_ = std::clamp(0.9 * window_ + 0.1 * 3.0 * off, std::max(kLeastWindow, std::min(off, kMaxWindow)),
                       kMaxWindow);
  // By then the first motion is known, and clouds that do not fit must not slip in.
  if (good_ == kFirstMotion) {
    window_ = std::max(kLeastWindow, std::min(window_, 3.0 * off));
    established_ = true;
  }
  apply(found);
  if (bad_ > 0) return;
  bool strong = true;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    const bool horizontal = std::abs(found.localizability.axes_t(2, axis)) < 0.7;
    const bool yaw = std::abs(found.localizability.axes_r(2, axis)) > 0.7;
    if (horizontal && found.localizability.t[n] != Observability::strong) strong = false;
    if (yaw && found.localizability.r[n] != Observability::strong) strong = false;
  }
  const bool moved = filter_.free_for() < kMaxFree || (!params_.motion.has_imu && !params_.motion.has_wheels);
  state_.health = strong && moved && !state_.unplaced ? Localisation::ok : Localisation::weak;
}

void LidarOdometry::compare_wheels(const Registered& found) {
  const MotionState& prior = filter_.state();
  const Vector6 innovation = prior.to(found.pose);
  Eigen::Vector3d off(0, 0, 0);
  double by_lidar = 0, by_wheels = 0;
  bool seen = true;
  const Eigen::Vector3d forward = prior.rotation * Eigen::Vector3d::UnitX();
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    const Eigen::Vector3d u = found.localizability.axes_t.col(axis);
    if (found.localizability.t[n] != Observability::strong) {
      seen = seen && std::abs(u.dot(forward)) < 0.3;
      continue;
    }
    // The registration went only a part of the way to where the cloud alone would lie.
    const double P = u.dot(prior.P.block<3, 3>(0, 0) * u);
    const double R = found.localizability.sigma_t[axis] * found.localizability.sigma_t[axis] +
                     DriftAccount::kBiasT * DriftAccount::kBiasT;
    off -= (P + R) / P * u.dot(innovation.head<3>()) * u;
    by_lidar = std::max(by_lidar, R);
    // What is usual of the wheels, not what the slip adds.
    by_wheels = std::max(by_wheels, filter_.wheels_slip() ? DriftAccount::kBiasT * DriftAccount::kBiasT : P);
  }
  if (seen) filter_.compare_wheels(off, by_lidar, by_wheels);
}

void LidarOdometry::miss(double dt) {
  ++bad_;
  good_ = 0;
  missed_for_ += dt;
  // KISS-ICP's rule alone never opens again after a bad start.
  if (bad_ % 5 == 0) window_ = std::min(1.5 * window_, kMaxWindow);
  if (bad_ >= kBadForDoubt && state_.health == Localisation::ok) state_.health = Localisation::weak;
  if (bad_ >= kBadForLost) state_.health = Localisation::lost;
  state_.localizability = {};
  filter_.learn_scale(false);
  if (missed_for_ < kNewMapAfter - 1e-6) return;
  if (established_) {
    // Of two maps that it lost, the place of the first is known.
    if (!state_.unplaced) before_.emplace(Before{std::move(map_), std::move(space_), drift_});
    state_.unplaced = true;
    drift_.raise(doubt());
  }
  begin_map();
}

void LidarOdometry::begin_map() {
  map_ = VoxelPlanes(params_.map);
  space_ = {};
  inserted_at_.reset();
  bad_ = good_ = 0;
  missed_for_ = 0.0;
  established_ = false;
}

Vector6 LidarOdometry::doubt() const {
  // A place within the window would have been found, so the body is farther away.
  const double way = kMaxWindow + std::max(kCarried, 1.5 * params_.max_speed) * missed_for_;
  const double turn = std::min(M_PI, kSlid + params_.motion.max_turn * missed_for_);
  Vector6 sigma;
  sigma << way, way, way, 0.0, 0.0, turn;
  return sigma;
}

void LidarOdometry::search_before() {
  const Pose3 prior{filter_.state().position, filter_.state().rotation};
  const Registered found =
      registration_.align(before_->map, body_points_, prior, Matrix6::Zero(), kMaxWindow);
  const Agreement known = agreement(before_->map, before_->space, body_points_, found.pose,
                                    params_.registration.range_noise, kFoundShare);
  const bool fits =
      found.near >= kLeastMatches && known.share() >= kFoundShare && found.localizability.all_strong();
  before_->found = fits ? before_->found + 1 : 0;
  if (before_->found < kGoodForFound) return;
  map_ = std::move(before_->map);
  space_ = std::move(before_->space);
  drift_ = before_->drift;
  before_.reset();
  state_.unplaced = false;
  ++state_.steps;
  bad_ = 0;
  missed_for_ = 0.0;
  established_ = true;
  MotionState at = filter_.state();
  at.position = found.pose.position;
  at.rotation = found.pose.orientation;
  at.P.diagonal().head<6>().array() += kMaxWindow * kMaxWindow;
  filter_.correct(at);
  apply(found);
  inserted_at_.reset();
  drift_pose_.reset();
  last_pose_.reset();
  way_pose_.reset();
}

bool LidarOdometry::relocalised(const Pose3& correction, double sigma, double sigma_heading,
                                std::optional<std::uint32_t> steps) {
  if (steps && *steps != state_.steps) return false;
  T_odom_local_ = correction * T_odom_local_;
  T_odom_local_.orientation.normalize();
  drift_.clear();
  Vector6 known;
  known << sigma, sigma, sigma, 0.0, 0.0, sigma_heading;
  drift_.raise(known);
  before_.reset();
  state_.unplaced = false;
  ++state_.relocalised;
  ++state_.steps;
  // The map lies where the body was believed to be.
  if (state_.health == Localisation::lost) {
    begin_map();
    state_.health = Localisation::weak;
  }
  state_.pose = odom_pose(filter_.pose());
  state_.covariance = drift_.covariance() + pose_covariance_;
  return true;
}

}  // namespace adit::perception
