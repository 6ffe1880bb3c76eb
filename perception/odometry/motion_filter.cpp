// SPDX-License-Identifier: Apache-2.0
#include "perception/odometry/motion_filter.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace adit::perception {
namespace {

using S = MotionState;

constexpr std::uint64_t kStep = 10'000'000;               ///< ns
constexpr std::uint64_t kWheelPeriod = 40'000'000;        ///< Between two corrections by the wheels, ns.
constexpr double kStillSpeed = 0.005, kStillTurn = 0.01;  ///< Slower is rest, m/s, rad/s.
constexpr double kStillGyro = 0.03;                       ///< With its bias removed, rad/s.
constexpr double kRestSpeed = 0.005, kRestTurn = 0.002;   ///< Standard deviations at rest, m/s, rad/s.
/// Roll and pitch by the driver's attitude filter: their standard deviation, rad, and the time over which an
/// error keeps its value, s. Half a degree is what makers of attitude sensors state for a body that moves.
constexpr double kTiltSigma = 0.0087, kTiltTime = 2.0;
constexpr double kLeastTilt = 1e-6;         ///< Less is no measurement, rad.
constexpr double kForgetScale = 200.0;      ///< Way over which the scale may change, m.
constexpr double kOpenAcceleration = 0.05;  ///< Gravity of a tilt by 0.3 degrees, m/s2.
constexpr double kSilentPeriods = 2.5;      ///< Between two sweeps of a slow lidar that is heard.
constexpr double kSlowestSweeps = 2.0;      ///< Between two sweeps of one clock, s.
/// How long the body may have moved while its lidar's clock was set, s: two sweeps at least; without scans
/// autonomous modes stop after half a second.
constexpr double kLeastUnseen = 0.5, kMostUnseen = 2.0;
constexpr double kSteepest = 0.35;  ///< Slope of the ground that a body may have driven onto, rad.

}  // namespace

void MotionFilter::start(std::uint64_t stamp, const Pose3& T_odom_base, const Eigen::Vector3d& gyro_bias,
                         bool at_rest, double tilt_sigma) {
  state_ = {};
  state_.stamp = stamp;
  state_.rotation = T_odom_base.orientation.normalized();
  state_.position = T_odom_base * params_.imu_position;
  state_.gyro_bias = gyro_bias;
  // The frame begins here: position and heading are certain. A tilt of the frame is a tilt of gravity in it.
  const auto set = [&](int at, int count, double sigma) {
    state_.P.diagonal().segment(at, count).setConstant(sigma * sigma);
  };
  set(S::kP, 3, 1e-3);
  set(S::kR, 3, 1e-3);
  set(S::kV, 3, at_rest ? 0.01 : 1.0);
  set(S::kBg, 3, at_rest ? 5e-4 : params_.gyro_bias);
  set(S::kBa, 3, params_.accel_bias);
  set(S::kG, 2, tilt_sigma * kStandardGravity);
  set(S::kS, 1, params_.wheel_scale);
  pending_ = {};
  wheels_used_ = attitude_used_ = stamp;
  still_for_ = at_rest ? 1.0 : 0.0;
  slip_.clear();
  unseen_for_ = rolled_for_ = 0.0;
  gyro_.setZero();
  history_.assign(1, {stamp, T_odom_base});
}

void MotionFilter::add(const BodyMotion& sample) {
  const Eigen::Vector3d up = sample.pose.orientation.conjugate() * Eigen::Vector3d::UnitZ();
  if (up.head<2>().norm() > kLeastTilt) leans_ = true;
  wheels_.add(sample);
}

bool MotionFilter::covers(std::uint64_t stamp) const {
  return (!params_.has_imu || imu_.reaches(stamp)) && (!params_.has_wheels || wheels_.reaches(stamp));
}

Pose3 MotionFilter::base_pose(const MotionState& state) const {
  return {state.position - state.rotation * params_.imu_position, state.rotation};
}

Eigen::Vector3d MotionFilter::velocity() const {
  return state_.velocity - state_.rotation * gyro_.cross(params_.imu_position);
}

bool MotionFilter::carried_to(std::uint64_t stamp) const {
  return stamp > state_.stamp && ((params_.has_imu && imu_.cover(state_.stamp, stamp, kMaxImuGap)) ||
                                  (params_.has_wheels && wheels_.cover(state_.stamp, stamp, kMaxMotionGap)));
}

bool MotionFilter::advance(std::uint64_t stamp) {
  const double gap = seconds_between(state_.stamp, stamp);
  if (std::abs(gap) > std::max(seconds_between(0, kClockStep), kSilentPeriods * period_) &&
      !carried_to(stamp)) {
    // The next stamp shows whether the clock was set, or this one is bad.
    const double period = suspect_ != 0 ? seconds_between(suspect_, stamp) : 0.0;
    suspect_ = stamp;
    if (period <= 0 || period > kSlowestSweeps) return false;
    period_ = period;
    begin_again(stamp, std::clamp(gap, kLeastUnseen, kMostUnseen));
  } else if (gap > 0) {
    period_ = std::min(gap, kSlowestSweeps);
  }
  suspect_ = 0;
  while (state_.stamp < stamp) step(std::min(stamp, state_.stamp + kStep));
  propagate_covariance();
  use_attitude();
  // Samples are needed until the next advance() for interpolation, and no longer.
  imu_.forget(state_.stamp, state_.stamp);
  wheels_.forget(std::min(wheels_used_, state_.stamp), state_.stamp);
  return true;
}

void MotionFilter::begin_again(std::uint64_t stamp, double unseen) {
  state_.stamp = wheels_used_ = attitude_used_ = stamp;
  state_.velocity.setZero();
  gyro_.setZero();
  still_for_ = unseen_for_ = rolled_for_ = 0.0;
  history_.assign(1, {stamp, base_pose(state_)});
  ++clock_steps_;
  widen(unseen);
}

void MotionFilter::widen(double unseen) {
  // Whatever the body did meanwhile lies within these bounds; the standard deviation of what lies anywhere
  // within a bound is that bound by the square root of three.
  const auto square = [](double v) { return v * v / 3; };
  state_.P.middleRows<3>(S::kV).setZero();
  state_.P.middleCols<3>(S::kV).setZero();
  auto diagonal = state_.P.diagonal();
  diagonal.segment<3>(S::kP).array() += square(params_.max_speed * unseen);
  diagonal.segment<2>(S::kR).array() += square(std::min(kSteepest, params_.max_turn * unseen));
  diagonal[S::kR + 2] += square(std::min(M_PI, params_.max_turn * unseen));
  diagonal.segment<3>(S::kV).array() += square(params_.max_speed);
}

void MotionFilter::step(std::uint64_t stamp) {
  const double dt = seconds_between(state_.stamp, stamp);
  const std::uint64_t from = state_.stamp;
  const auto mean = params_.has_imu ? mean_of(imu_, from, stamp) : std::nullopt;
  std::optional<Pose3> a, b;
  if (!mean && params_.has_wheels) {
    a = pose_at(wheels_, from);
    b = pose_at(wheels_, stamp);
  }
  if (mean)
    step_by_imu(dt, *mean);
  else if (a && b)
    step_by_wheels(dt, *a, *b);
  else
    step_free(dt);
  free_for_ = mean || (a && b) ? 0.0 : free_for_ + dt;
  state_.stamp = stamp;
  if (mean && params_.has_wheels && stamp - wheels_used_ >= kWheelPeriod) use_wheels(wheels_used_, stamp);
  if (!mean) wheels_used_ = stamp;
  history_.push_back({stamp, base_pose(state_)});
  while (history_.size() > 1 && stamp - history_[1].stamp > kHistory) history_.pop_front();
}

void MotionFilter::step_by_imu(double dt, const ImuSample& mean) {
  const Eigen::Vector3d gyro = mean.gyro - state_.gyro_bias, accel = mean.accel - state_.accel_bias;
  const Eigen::Quaterniond half = state_.rotation * exp_so3(0.5 * dt * gyro);
  const Eigen::Vector3d acceleration = half * accel + state_.gravity_vector();
  state_.position += dt * state_.velocity + 0.5 * dt * dt * acceleration;
  state_.velocity += dt * acceleration;
  state_.rotation = (state_.rotation * exp_so3(dt * gyro)).normalized();
  gyro_ = gyro;
  pending_.velocity += dt * (pending_.rotation * accel);
  pending_.rotation = (pending_.rotation * exp_so3(dt * gyro)).normalized();
  pending_.dt += dt;
  pending_.turned += dt * gyro.norm();
}

void MotionFilter::step_by_wheels(double dt, const Pose3& from, const Pose3& to) {
  const Pose3 moved = from.inverse() * to;
  // The state's point is the IMU's, which a turn moves.
  const Eigen::Vector3d& r = params_.imu_position;
  const Eigen::Vector3d way = state_.wheel_scale * moved.position + moved.orientation * r - r;
  state_.position += state_.rotation * way;
  state_.velocity = state_.rotation * way / dt;
  state_.rotation = (state_.rotation * moved.orientation).normalized();
  gyro_ = log_so3(moved.orientation) / dt;
  pending_.rolled += pending_.rotation * moved.position;
  pending_.rotation = (pending_.rotation * moved.orientation).normalized();
  pending_.rolled_dt += dt;
  rolled_for_ += dt;
  pending_.turned += dt * gyro_.norm();
  pending_.way += moved.position.norm();
  const bool still = moved.position.norm() < kStillSpeed * dt && gyro_.norm() < kStillTurn;
  still_for_ = still ? still_for_ + dt : 0.0;
}

void MotionFilter::step_free(double dt) {
  state_.position += dt * state_.velocity;
  state_.rotation = (state_.rotation * exp_so3(dt * gyro_)).normalized();
  pending_.rotation = (pending_.rotation * exp_so3(dt * gyro_)).normalized();
  pending_.free_dt += dt;
  pending_.turned += dt * gyro_.norm();
}

void MotionFilter::propagate_covariance() {
  const double imu = pending_.dt, rolled = pending_.rolled_dt, free = pending_.free_dt;
  if (imu + rolled + free <= 0) return;
  // Rotation at the beginning of the pending motion.
  const Eigen::Matrix3d R = (state_.rotation * pending_.rotation.conjugate()).toRotationMatrix();
  const Eigen::Matrix3d Dt = pending_.rotation.conjugate().toRotationMatrix();
  S::Matrix F = S::Matrix::Identity();
  F.block<3, 3>(S::kR, S::kR) = Dt;
  if (imu > 0) {
    F.block<3, 3>(S::kR, S::kBg) = -imu * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d turned = -R * skew(pending_.velocity);
    F.block<3, 3>(S::kV, S::kR) = turned;
    F.block<3, 3>(S::kV, S::kBa) = -imu * R;
    F.block<2, 2>(S::kV, S::kG) = imu * Eigen::Matrix2d::Identity();
    F.block<3, 3>(S::kP, S::kR) = 0.5 * imu * turned;
    F.block<3, 3>(S::kP, S::kBa) = -0.5 * imu * imu * R;
    F.block<2, 2>(S::kP, S::kG) = 0.5 * imu * imu * Eigen::Matrix2d::Identity();
  }
  if (rolled > 0) {
    F.block<3, 3>(S::kP, S::kR) -= R * skew(state_.wheel_scale * pending_.rolled);
    F.block<3, 1>(S::kP, S::kS) = R * pending_.rolled;
  }
  F.block<3, 3>(S::kP, S::kV) = (imu + free) * Eigen::Matrix3d::Identity();
  state_.P = (F * state_.P * F.transpose()).eval();

  auto diagonal = state_.P.diagonal();
  const auto square = [](double v) { return v * v; };
  const double turn = square(params_.gyro_scale * pending_.turned);
  if (imu > 0) {
    diagonal.segment<3>(S::kR).array() += square(params_.gyro_noise) * imu + turn;
    diagonal.segment<3>(S::kV).array() += square(params_.accel_noise) * imu;
    diagonal.segment<3>(S::kP).array() += square(params_.accel_noise) * imu * imu * imu / 3;
    if (slip_.slipping()) {
      // Nothing holds the velocity: the error of tilt and bias adds up.
      const double unseen = unseen_for_ + imu;
      diagonal.segment<3>(S::kV).array() +=
          square(kOpenAcceleration) * (square(unseen) - square(unseen_for_));
      unseen_for_ = unseen;
    }
    diagonal.segment<3>(S::kBg).array() += square(params_.gyro_walk) * imu;
    diagonal.segment<3>(S::kBa).array() += square(params_.accel_walk) * imu;
  }
  if (rolled > 0) {
    // Tilt of an attitude filter: 0.5 degrees over 2 s. Heading: skid and drift, 20 % of a turn.
    diagonal.segment<2>(S::kR).array() += square(0.009) * rolled;
    diagonal[S::kR + 2] +=
        square(0.02 * pending_.way) + square(0.2 * pending_.turned) + square(0.002) * rolled;
    const double slip = square(std::max(params_.wheel_slip, 0.1) * pending_.way) + square(0.01) * rolled;
    diagonal.segment<3>(S::kP).array() += slip;
    // A slip goes on: its error grows with the time since the lidar saw the way.
    const double unseen = unseen_for_ + rolled;
    diagonal.segment<3>(S::kP).array() +=
        slip_.bound().squaredNorm() * (square(unseen) - square(unseen_for_));
    unseen_for_ = unseen;
    diagonal.segment<3>(S::kV).array() += square(params_.max_acceleration * rolled);
  }
  if (free > 0) {
    diagonal.segment<3>(S::kR).array() +=
        square(params_.max_turn_acceleration * free * free) + square(0.01) * free;
    diagonal.segment<3>(S::kV).array() += square(params_.max_acceleration * free);
    diagonal.segment<3>(S::kP).array() += square(0.5 * params_.max_acceleration * free * free);
  }
  pending_ = {};
}

void MotionFilter::use_wheels(std::uint64_t from, std::uint64_t to) {
  const auto a = pose_at(wheels_, from), b = pose_at(wheels_, to);
  wheels_used_ = to;
  if (!a || !b) return;
  const double dt = seconds_between(from, to);
  const Pose3 moved = a->inverse() * *b;
  const Eigen::Vector3d rolled = moved.position / dt;
  const double wheel_turn = std::abs(log_so3(moved.orientation).z()) / dt;
  // The driver's tilt may wander at rest; only its heading counts.
  const bool still = rolled.norm() < kStillSpeed && wheel_turn < kStillTurn && gyro_.norm() < kStillGyro;
  still_for_ = still ? still_for_ + dt : 0.0;
  propagate_covariance();

  const Eigen::Matrix3d R_inverse = state_.rotation.conjugate().toRotationMatrix();
  const Eigen::Vector3d lever = gyro_.cross(params_.imu_position);
  const Eigen::Vector3d in_body = R_inverse * state_.velocity;
  Eigen::Matrix<double, 3, S::kSize> H = Eigen::Matrix<double, 3, S::kSize>::Zero();
  H.block<3, 3>(0, S::kV) = R_inverse;
  H.block<3, 3>(0, S::kR) = skew(in_body);
  if (at_rest()) {
    slip_.rest(dt);
    const Eigen::Vector3d rest = Eigen::Vector3d::Constant(kRestSpeed * kRestSpeed);
    if (!update(H, -in_body, rest, 1e9)) return;
    Eigen::Matrix<double, 3, S::kSize> G = Eigen::Matrix<double, 3, S::kSize>::Zero();
    G.block<3, 3>(0, S::kBg).setIdentity();
    update(G, gyro_, Eigen::Vector3d::Constant(kRestTurn * kRestTurn / dt), 1e9);
    return;
  }
  const bool has_scale = rolled.head<2>().norm() > 0.05;
  if (has_scale) H.block<3, 1>(0, S::kS) = -rolled;
  state_.P(S::kS, S::kS) += std::pow(params_.wheel_scale, 2) * rolled.norm() * dt / kForgetScale;
  // rolled * scale = R^T v - w x r; a body that cannot drive sideways slips so in turns.
  const Eigen::Vector3d expected = in_body - lever;
  Eigen::Vector3d measured = state_.wheel_scale * rolled;
  const double speed = rolled.norm(), slip = params_.wheel_slip * speed + 0.01;
  const double turn_slip = slip + 0.05 * gyro_.norm();
  Eigen::Vector3d sigma(turn_slip, params_.sideways ? turn_slip : turn_slip + 0.02 * speed,
                        0.1 + 0.05 * speed);
  if (params_.flies) sigma.setConstant(0.1 + 0.05 * speed);
  if (!params_.flies) measured.z() = 0.0;
  const Eigen::Vector3d residual = measured - expected, usual = sigma.cwiseAbs2();
  if (!slip_.slipping() && update(H, residual, usual, SlipWatch::kGate)) return;
  const Eigen::Vector3d known = (H * state_.P * H.transpose()).diagonal();
  slip_.compare(residual, known, usual, dt);
  // The contradiction bounds the error of the speed: it says something only where less is known, and never
  // more.
  Eigen::Vector3d variance = usual;
  for (int axis = 0; axis < 3; ++axis) {
    const double bound = slip_.bound()[axis] * slip_.bound()[axis];
    if (bound > usual[axis])
      variance[axis] = known[axis] > bound ? bound * known[axis] / (known[axis] - bound) : 1e6;
  }
  update(H, residual, variance, 1e9);
}

void MotionFilter::compare_wheels(const Eigen::Vector3d& off, double by_lidar, double by_wheels) {
  unseen_for_ = 0.0;
  const double dt = std::exchange(rolled_for_, 0.0);
  if (dt <= 0) return;
  const auto speed = [dt](double way) { return Eigen::Vector3d::Constant(way / (dt * dt)); };
  slip_.compare(state_.rotation.conjugate() * off / dt, speed(by_lidar), speed(by_wheels), dt);
}

void MotionFilter::use_attitude() {
  if (!leans_ || state_.stamp <= attitude_used_) return;
  const auto driver = pose_at(wheels_, state_.stamp);
  if (!driver) return;
  const double dt = std::min(kTiltTime, seconds_between(attitude_used_, state_.stamp));
  attitude_used_ = state_.stamp;
  if (params_.has_imu && !imu_.samples().empty()) return;  // Its accelerometer knows better.
  // The driver's attitude is what an accelerometer would measure that feels no motion.
  const Eigen::Matrix3d R_inverse = state_.rotation.conjugate().toRotationMatrix();
  const Eigen::Vector3d expected = -(R_inverse * state_.gravity_vector());
  const Eigen::Vector3d measured =
      kStandardGravity * (driver->orientation.conjugate() * Eigen::Vector3d::UnitZ());
  Eigen::Matrix<double, 3, S::kSize> H = Eigen::Matrix<double, 3, S::kSize>::Zero();
  H.block<3, 3>(0, S::kR) = skew(expected);
  H.block<3, 3>(0, S::kBa).setIdentity();
  H.block<3, 2>(0, S::kG) = -R_inverse.leftCols<2>();
  // Errors that keep their value say the same again: their mean is that of one for each two times it.
  const double variance = std::pow(kTiltSigma * kStandardGravity, 2) * (1.0 + 2.0 * kTiltTime / dt);
  // The length of gravity says nothing.
  update(H, measured - expected - state_.accel_bias, {variance, variance, 1e3}, 1e9);
}

bool MotionFilter::update(const Eigen::Matrix<double, 3, S::kSize>& H, const Eigen::Vector3d& residual,
                          const Eigen::Vector3d& variance, double gate) {
  const Eigen::Matrix<double, S::kSize, 3> PHt = state_.P * H.transpose();
  const Eigen::Matrix3d expected = H * PHt + Eigen::Matrix3d(variance.asDiagonal());
  if ((residual.array().square() / expected.diagonal().array()).maxCoeff() > gate) return false;
  Eigen::Matrix<double, S::kSize, 3> K = PHt * expected.inverse();
  if (!learn_scale_) K.row(S::kS).setZero();
  state_.add(K * residual);
  // Joseph's form also holds for the gain without its last row.
  const S::Matrix A = S::Matrix::Identity() - K * H;
  state_.P = (A * state_.P * A.transpose() + K * variance.asDiagonal() * K.transpose()).eval();
  return true;
}

Result<Pose3> MotionFilter::at(std::uint64_t stamp) const {
  if (history_.empty() || stamp < history_.front().stamp)
    return {Reason::out_of_range, "the odometry has no pose at that time"};
  if (stamp > history_.back().stamp) {
    if (stamp - history_.back().stamp > kMaxExtrapolation)
      return {Reason::out_of_range, "the odometry has no pose yet at that time"};
    const double dt = seconds_between(history_.back().stamp, stamp);
    return Pose3{history_.back().pose.position + dt * velocity(),
                 (history_.back().pose.orientation * exp_so3(dt * gyro_)).normalized()};
  }
  const auto after =
      std::find_if(history_.begin(), history_.end(), [&](const Stamped& s) { return s.stamp >= stamp; });
  if (after->stamp == stamp) return after->pose;
  const auto before = std::prev(after);
  const double part = seconds_between(before->stamp, stamp) / seconds_between(before->stamp, after->stamp);
  return Pose3{before->pose.position + part * (after->pose.position - before->pose.position),
               before->pose.orientation.slerp(part, after->pose.orientation)};
}

void MotionFilter::correct(const MotionState& state) {
  if (!state.P.allFinite() || state.P.diagonal().minCoeff() <= 0 || !state.position.allFinite() ||
      !state.rotation.coeffs().allFinite() || !state.velocity.allFinite()) {
    const Pose3 here = base_pose(state_);
    const std::uint64_t stamp = state_.stamp;
    start(stamp, here, {0, 0, 0}, false, kSteepest);
    return widen(kMostUnseen);
  }
  const Pose3 before = base_pose(state_);
  state_ = state;
  // The poses on the way keep their shape and end at the corrected one.
  const Pose3 correction = base_pose(state_) * before.inverse();
  for (Stamped& each : history_) each.pose = correction * each.pose;
}

S::Matrix after_registration(const S::Matrix& P, const Eigen::Matrix<double, 6, 6>& information,
                             bool learn_scale) {
  // With I = L L^T the cloud measures L^T x with unit variances: Joseph's form with the gain B.
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  const Eigen::SelfAdjointEigenSolver<Matrix6> split(information);
  const Matrix6 L = split.eigenvectors() * split.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const Eigen::Matrix<double, S::kSize, 6> PL = P.leftCols<6>() * L;
  const Matrix6 expected = Matrix6::Identity() + L.transpose() * PL.topRows<6>();
  Eigen::Matrix<double, S::kSize, 6> B = PL * expected.ldlt().solve(Matrix6::Identity());
  if (!learn_scale) B.row(S::kS).setZero();
  S::Matrix A = S::Matrix::Identity();
  A.leftCols<6>() -= B * L.transpose();
  const S::Matrix next = A * P * A.transpose() + B * B.transpose();
  return 0.5 * (next + next.transpose());
}

}  // namespace adit::perception
