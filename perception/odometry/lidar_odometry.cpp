// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/lidar_odometry.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "perception/voxel/planar.hpp"

namespace adit::perception {
namespace {

using S = MotionState;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kInsertWay = 0.2,
                 kInsertTurn = 0.05;  ///< Motion after which a cloud enters the map, m, rad.
constexpr int kSearchPeriod = 10;     ///< Clouds between two comparisons with the map before it was lost.
constexpr int kFirstClouds = 10;      ///< All of them enter the map.
constexpr double kLeastWay = 0.02;    ///< A shorter way is noise of the registrations, m.
constexpr double kLevelRate = 0.003;  ///< How fast the frame is levelled, rad/s.
constexpr std::uint64_t kImuPatience = 2'000'000'000;  ///< Wait for the first sample of an IMU, ns.

// Per axis, of the widest ranges that sensors have: 16 g and 2000 degrees/s. The sample is in the body's
// axes, so the bound is that of the vector.
const double kMaxForce = std::sqrt(3.0) * 16 * kStandardGravity,
             kMaxRate = std::sqrt(3.0) * 2000 * M_PI / 180;

/// Whether a sensor can measure it; false also for NaN.
bool is_plausible(const ImuSample& sample) {
  return sample.accel.norm() <= kMaxForce && sample.gyro.norm() <= kMaxRate;
}

Eigen::Matrix3d rotation_of(const Pose3& pose) { return pose.orientation.toRotationMatrix(); }

}  // namespace

LidarOdometry::LidarOdometry(const LidarOdometryParams& params)
    : params_(params),
      filter_(params.motion),
      registration_(params.registration),
      map_(params.map),
      dense_(params.dense),
      thinner_(params.thin),
      window_(params.first_window) {}

void LidarOdometry::add(const ImuSample& sample) {
  if (!params_.motion.has_imu) return;
  if (!is_plausible(sample)) {
    ++refused_samples_;
    return;
  }
  if (!filter_.started()) watch_.add(sample);
  filter_.add(sample);
}

void LidarOdometry::add(const BodyMotion& sample) {
  if (!params_.motion.has_wheels) return;
  if (!sample.pose.position.allFinite() || !sample.pose.orientation.coeffs().allFinite()) {
    ++refused_samples_;
    return;
  }
  if (!filter_.started()) watch_.add(sample);
  if (!newest_wheels_ || sample.stamp > newest_wheels_->stamp ||
      !same_clock(sample.stamp, newest_wheels_->stamp))
    newest_wheels_ = sample;
  filter_.add(sample);
}

bool LidarOdometry::start(std::uint64_t stamp) {
  if (params_.motion.has_wheels && !newest_wheels_) return false;
  if (first_imu_wait_ == 0) first_imu_wait_ = stamp;
  Pose3 at;
  // The heading is the wheels', so that both frames begin alike.
  if (newest_wheels_) at = newest_wheels_->pose;
  StartAttitude attitude{at.orientation, {0, 0, 0}, false};
  const auto judged = params_.motion.has_imu ? watch_.judge(stamp) : std::nullopt;
  const bool waits = params_.motion.has_imu && !judged;
  if (waits && stamp - first_imu_wait_ < kImuPatience) return false;
  double tilt_sigma = 0.02;
  if (judged) {
    attitude = *judged;
    // The body's heading after it is levelled by its accelerometer.
    const double yaw = at.yaw() - Pose3{{0, 0, 0}, attitude.level_from_base}.yaw();
    at.orientation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * attitude.level_from_base;
    tilt_sigma = attitude.at_rest ? params_.motion.accel_bias / kStandardGravity : 0.05;
  }
  filter_.start(stamp, at, attitude.gyro_bias, attitude.at_rest, tilt_sigma);
  return true;
}

bool LidarOdometry::advance(std::uint64_t stamp) {
  if (!filter_.started()) return start(stamp);
  const int steps = filter_.clock_steps();
  if (!filter_.advance(stamp)) return false;
  if (steps != filter_.clock_steps()) {
    last_stamp_ = stamp;
    window_ = kMaxWindow;
    good_ = 0;
  }
  return true;
}

Result<Pose3> LidarOdometry::at(std::uint64_t stamp) const {
  auto local = filter_.at(stamp);
  if (!local) return local;
  return odom_pose(*local);
}

const OdometryState& LidarOdometry::update(std::span<const Eigen::Vector3f> points,
                                           std::span<const std::uint8_t> skipped, bool deskewed) {
  if (!filter_.started()) return state_;
  std::span<const Eigen::Vector3f> used = points;
  if (skipped.size() == points.size() && !points.empty()) {
    static_points_.clear();
    for (std::size_t n = 0; n < points.size(); ++n)
      if (skipped[n] == 0) static_points_.push_back(points[n]);
    used = static_points_;
  }
  const std::vector<Eigen::Vector3f>& dense = dense_.thin(used);
  const std::vector<Eigen::Vector3f>& thinned = thinner_.thin(dense);
  body_points_.clear();
  const Eigen::Vector3f shift = params_.motion.imu_position.cast<float>();
  double range = 0;
  for (const Eigen::Vector3f& p : thinned) {
    body_points_.push_back(p - shift);
    range += p.norm();
  }
  if (!thinned.empty()) reach_ += 0.1 * (range / static_cast<double>(thinned.size()) - reach_);

  ++clouds_;
  Registered found;
  const bool first = map_.size() == 0;
  if (first) {
    const bool placed = thinned.size() >= kLeastMatches && !state_.unplaced;
    state_.health = placed ? Localisation::ok : Localisation::weak;
  } else {
    const Pose3 prior{filter_.state().position, filter_.state().rotation};
    const Matrix6 information = filter_.state().P.topLeftCorner<6, 6>().inverse();
    registration_.set_smear(deskewed ? Smear{} : smear());
    widen_window();
    found = registration_.align(map_, body_points_, prior, information, window_);
    judge(found);
    if (before_ && clouds_ % kSearchPeriod == 0) search_before();
  }
  state_.matched = found.matched;
  state_.used = thinned.size();
  state_.iterations = found.iterations;
  report();
  if (state_.health == Localisation::lost || (bad_ > 0 && !first)) return state_;
  const Pose3 moved = inserted_at_ ? inserted_at_->inverse() * filter_.pose() : Pose3{};
  if (clouds_ <= kFirstClouds || !inserted_at_ || moved.position.norm() > kInsertWay ||
      log_so3(moved.orientation).norm() > kInsertTurn)
    insert(dense);
  return state_;
}

void LidarOdometry::widen_window() {
  const MotionState& now = filter_.state();
  if (last_stamp_ == 0 || same_clock(now.stamp, last_stamp_)) return;
  // Three standard deviations of where the other sensors brought a point since the last cloud.
  const auto P = now.P.diagonal();
  const double shift = P.segment<2>(S::kP).sum(), turn = P.segment<3>(S::kR).sum() * reach_ * reach_;
  window_ = std::clamp(3.0 * std::sqrt(shift + turn), window_, kMaxWindow);
}

Smear LidarOdometry::smear() const {
  if (!last_pose_) return {};
  // The times are anywhere in the sweep, and a sweep lasts from cloud to cloud: a uniform distribution.
  const double part = 1.0 / std::sqrt(12.0);
  const Pose3 moved = last_pose_->inverse() * filter_.pose();
  const Eigen::Vector3d turn = log_so3(moved.orientation);
  return {part * (moved.position + turn.cross(params_.motion.imu_position)), part * turn};
}

void LidarOdometry::apply(const Registered& found) {
  S next = filter_.state();
  const Matrix6 P = next.P.topLeftCorner<6, 6>();
  const Eigen::Matrix<double, 6, 1> innovation = next.to(found.pose);
  // The scale of the wheels is learned from directions that the lidar determines, and only there.
  const Eigen::Vector3d v = filter_.velocity();
  bool seen = true;
  for (int axis = 0; axis < 3 && v.norm() > 0.05; ++axis)
    if (found.localizability.t[static_cast<std::size_t>(axis)] != Observability::strong &&
        std::abs(found.localizability.axes_t.col(axis).dot(v)) > 0.3 * v.norm())
      seen = false;
  filter_.learn_scale(seen);
  Eigen::Matrix<double, S::kSize, 6> K = next.P.leftCols<6>() * P.inverse();
  if (!seen) K.row(S::kS).setZero();
  next.add(K * innovation);
  next.position = found.pose.position;
  next.rotation = found.pose.orientation;
  next.P = after_registration(next.P, found.information, seen);
  filter_.correct(next);
  state_.localizability = found.localizability;
}

void LidarOdometry::insert(std::span<const Eigen::Vector3f> points) {
  const Eigen::Matrix3d R = filter_.state().rotation.toRotationMatrix();
  const Eigen::Vector3d t = filter_.state().position;
  map_points_.clear();
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d at = R * (p.cast<double>() - params_.motion.imu_position) + t;
    if (params_.planar)
      add_piece_of_wall(map_points_, at);
    else
      map_points_.push_back(at);
  }
  state_.refused = map_.insert(map_points_, filter_.pose().position, travelled_);
  map_.forget(travelled_);
  space_.add(t, map_points_, travelled_);
  space_.forget(travelled_);
  inserted_at_ = filter_.pose();
}

void LidarOdometry::report() {
  const S& s = filter_.state();
  const Pose3 local = filter_.pose();
  const double dt = last_stamp_ != 0 ? static_cast<double>(s.stamp - last_stamp_) * 1e-9 : 0.0;
  // Of position and rotation in the axes of odom.
  Matrix6 turn = Matrix6::Identity();
  turn.block<3, 3>(3, 3) = rotation_of(local);
  const Matrix6 now = turn * s.P.topLeftCorner<6, 6>() * turn.transpose();
  if (last_pose_) {
    const Pose3 moved = last_pose_->inverse() * local;
    if (!way_pose_ || (local.position - *way_pose_).norm() > kLeastWay) {
      travelled_ += way_pose_ ? (local.position - *way_pose_).norm() : 0.0;
      way_pose_ = local.position;
    }
    if (dt > 0 && filter_.free_for() >= dt)
      filter_.set_rates((local.position - last_pose_->position) / dt, log_so3(moved.orientation) / dt);
  }
  if (bad_ == 0) {
    // What does not enter the map is no drift of it: where the next cloud fits, it is found again.
    if (!drift_pose_) drift_pose_ = local;
    const Eigen::Vector3d moved = local.position - drift_pose_->position;
    const double turned = log_so3(drift_pose_->orientation.conjugate() * local.orientation).norm();
    const bool counts = moved.norm() > kLeastWay || turned * reach_ > kLeastWay;
    drift_.add(counts ? moved : Eigen::Vector3d::Zero(), counts ? turned : 0.0, reach_, state_.localizability,
               pose_covariance_, now);
    if (counts) drift_pose_ = local;
    pose_covariance_ = now;
  }
  last_pose_ = local;
  last_stamp_ = s.stamp;
  if (dt > 0) level(dt);
  state_.stamp = s.stamp;
  state_.pose = odom_pose(local);
  state_.velocity = T_odom_local_.orientation * filter_.velocity();
  state_.wheels_slip = filter_.wheels_slip_lasts();
  state_.gyro_bias = s.gyro_bias;
  state_.accel_bias = s.accel_bias;
  state_.wheel_scale = s.wheel_scale;
  state_.covariance = drift_.covariance() + now;
  if (bad_ >= kBadForDoubt)
    state_.covariance.diagonal() += doubt().cwiseAbs2();
  else if (!state_.unplaced)
    state_.sigma_seen = state_.sigma();
}

void LidarOdometry::level(double dt) {
  const S& s = filter_.state();
  const Eigen::Vector3d up = T_odom_local_.orientation * -s.gravity_vector() / kStandardGravity;
  const Eigen::Vector3d off = up.cross(Eigen::Vector3d::UnitZ());
  const double angle = off.norm();
  if (angle < 1e-6) return;
  const Eigen::Quaterniond turn = exp_so3(off * std::min(1.0, kLevelRate * dt / angle));
  const Eigen::Vector3d here = odom_pose(filter_.pose()).position;
  T_odom_local_ = Pose3{here - turn * here, turn} * T_odom_local_;
  T_odom_local_.orientation.normalize();
}

}  // namespace adit::perception
