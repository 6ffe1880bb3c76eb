// SPDX-License-Identifier: Apache-2.0
#include "perception/input/scan_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

namespace adit::perception {
namespace {

constexpr std::uint64_t kClockSetBack =
    1'000'000'000;                  ///< An older sweep is of a clock that was set back, ns.
constexpr double kOldSweeps = 1.5;  ///< Of its period, that another lidar's sweep is merged.
constexpr double kReach =
    30;  ///< A lowest beam that meets level ground within so far must return something, m.
constexpr float kFalls = 0.05f;           ///< A ray that falls by more of its length points below the lidar.
constexpr std::size_t kManyBelow = 30;    ///< So many returns below it show that a lidar sees the ground.
constexpr std::size_t kManyPoints = 200;  ///< Of fewer nothing is concluded.
constexpr double kFewBelow = 0.01;        ///< Of all returns: fewer below the lidar are not the ground.
constexpr int kOvertaken = 10;            ///< More than one sweep in so many that is late is no accident.
constexpr int kMostOvertaken = 40, kTooOften = 30;
constexpr int kPatience = 10;  ///< Scans in a row without another sensor, before that is a warning.

/// The best time of points, of which there is at least one, s. Four candidates, as each comparison waits for
/// the one before it.
template <class Better>
float best_time(std::span<const TimedPoint> points, Better better) {
  constexpr std::size_t kChains = 4;
  std::array<float, kChains> best{};
  best.fill(points.front().time);
  const auto take = [&better](float& best_yet, float time) {
    best_yet = better(time, best_yet) ? time : best_yet;
  };
  std::size_t n = 0;
  for (; n + kChains <= points.size(); n += kChains)
    for (std::size_t chain = 0; chain < kChains; ++chain) take(best[chain], points[n + chain].time);
  for (; n < points.size(); ++n) take(best[0], points[n].time);
  for (const float time : best) take(best[0], time);
  return best[0];
}

double after(std::uint64_t stamp, std::uint64_t than) {
  return static_cast<double>(static_cast<std::int64_t>(stamp - than)) * 1e-9;
}

}  // namespace

ScanInput::ScanInput(const Platform& platform) : platform_(platform), body_(platform) {
  for (const LidarConfig& lidar : platform.all_lidars()) {
    const double lowest = lidar.mounting.upside_down() ? lidar.highest : -lidar.lowest;
    const double down = std::tan(lowest * M_PI / 180);
    const bool sees_ground = !platform.flies() && !platform.lidars.empty() && lidar.rings > 1 &&
                             down * kReach > lidar.mounting.z && lidar.max_range >= kReach;
    Source source;
    source.lidar = lidar;
    source.must_return = sees_ground;
    sources_.push_back(std::move(source));
  }
  if (platform.imu) tilt_.emplace(platform.imu->mounting);
}

Result<Pose3> ScanInput::find(const std::string& frame) const {
  const std::string name = frame_name(frame);
  if (name == "base_link" || name.empty()) return Pose3{};
  for (const Source& source : sources_)
    if (source.lidar.frame == name) return source.lidar.mounting.pose();
  if (platform_.imu && platform_.imu->frame == name) return platform_.imu->mounting.pose();
  if (auto T_base_frame = tree_.find("base_link", name)) return T_base_frame;
  return Error{Reason::frame_unknown,
               "the frame '" + frame + "' is neither in `sensors` of the platform's file nor in tf_static"};
}

Result<Pose3> ScanInput::mounting_of_imu(const std::string& frame) const {
  const bool own = frame.empty() || frame_name(frame) == platform_.imu->frame;
  return own ? Result<Pose3>(platform_.imu->mounting.pose()) : find(frame);
}

Result<void> ScanInput::add(const ImuSample& sample, const std::string& frame) {
  if (!tilt_) return {};
  auto added = filter(sample, frame);
  imu_refused_ = imu_refused_ || !added;
  return added;
}

Result<void> ScanInput::filter(const ImuSample& sample, const std::string& frame) {
  const std::string name = frame.empty() ? platform_.imu->frame : frame_name(frame);
  if (name != imu_frame_ || imu_frame_.empty()) {
    const auto T_base_imu = mounting_of_imu(frame);
    if (!T_base_imu) return T_base_imu.error();
    const Eigen::Vector3d angles = T_base_imu->orientation.toRotationMatrix().eulerAngles(2, 1, 0);
    tilt_.emplace(Mounting{T_base_imu->position.x(), T_base_imu->position.y(), T_base_imu->position.z(),
                           angles[2], angles[1], angles[0]});
    imu_frame_ = name;
  }
  if (sample.stamp == 0)
    return {Reason::sensor_times, "the samples of the IMU on the topic '" + platform_.imu->topic +
                                      "' have no stamp: its driver must set the time of each in the header"};
  return tilt_->add(sample);
}

void ScanInput::add_odometry(std::uint64_t stamp, const Eigen::Vector3d& velocity, double yaw) {
  if (!tilt_) return;
  tilt_->set_velocity(stamp, velocity);
  tilt_->set_yaw(stamp, yaw);
}

std::uint64_t ScanInput::end_of(const Sweep& sweep) {
  if (!sweep.timed || sweep.stamp == 0) return sweep.stamp;
  const float last = best_time(sweep.points, std::greater<>());
  return sweep.stamp +
         static_cast<std::uint64_t>(static_cast<std::int64_t>(std::llround(double{last} * 1e9)));
}

Result<std::optional<Eigen::Quaterniond>> ScanInput::attitude_at(std::uint64_t stamp) const {
  using Attitude = std::optional<Eigen::Quaterniond>;
  if (!tilt_ || tilt_->newest() == 0 || stamp == 0) return Attitude{};
  const auto attitude = tilt_->at(stamp);
  if (attitude) return Attitude{*attitude};
  // An IMU that is silent leaves the attitude to the odometry; one that is mounted otherwise knows that
  // nothing fits.
  if (attitude.reason() == Reason::imu_mounting) return attitude.error();
  return Attitude{};
}

Result<void> ScanInput::in_order(Source& source, std::uint64_t stamp) {
  if (stamp != 0 && stamp < source.newest && source.newest - stamp < kClockSetBack) {
    source.overtaken = std::min(source.overtaken + kOvertaken, kMostOvertaken);
    if (source.overtaken > kTooOften)
      return {Reason::sensor_times,
              "many scans of the topic '" + source.lidar.topic +
                  "' come after newer ones; is there one driver on it, with one clock?"};
    return {Reason::sample_stale, "a scan came after a newer one"};
  }
  source.overtaken = std::max(source.overtaken - 1, 0);
  source.newest = stamp;
  return {};
}

Result<void> ScanInput::plausible(Source& source, const Sweep& sweep, const Scan& scan,
                                  std::size_t below) const {
  if (platform_.flies() || sweep.planar) return {};
  const std::size_t used = scan.counts.used;
  // A lidar that may see nothing has shown before that it works, and did not look at the ground.
  if (used == 0 && (source.must_return || source.saw_ground || (!source.returned && !sweep.points.empty())))
    return {Reason::scan_empty, "none of the scan's " + std::to_string(sweep.points.size()) +
                                    " points is a return; is the lidar covered?"};
  if (source.must_return && used >= kManyPoints &&
      static_cast<double>(below) < kFewBelow * static_cast<double>(used))
    return {Reason::lidar_mounting,
            "the lidar '" + source.lidar.frame +
                "' sees no ground below it; is it mounted as `sensors: lidar:` says, or "
                "the other way up?"};
  source.returned |= used > 0;
  source.saw_ground |= below >= kManyBelow;
  return {};
}

void ScanInput::note_attitude(Scan& scan) {
  // Samples that cannot be used are reported with their reason.
  const bool refused = std::exchange(imu_refused_, false);
  if (!tilt_ || scan.attitude || scan.stamp == 0 || refused) {
    without_imu_ = 0;
    return;
  }
  if (++without_imu_ < kPatience) return;
  without_imu_ = kPatience;
  scan.warnings.push_back(
      {"sensor_silent", Reason::sensor_silent,
       tilt_->newest() == 0 ? "the IMU on the topic '" + platform_.imu->topic +
                                  "' sends nothing; roll and pitch are those of the odometry"
                            : "the IMU has no samples of the time of the scans: it is silent, or has another "
                              "clock; roll and pitch are those of the odometry"});
}

ScanInput::SweepMotion ScanInput::motion_of(const Sweep& sweep, const PoseFunction& pose,
                                            const Pose3& T_base_sensor, Scan& scan) const {
  SweepMotion motion{Deskew::none(T_base_sensor)};
  if (!sweep.timed || sweep.stamp == 0) return motion;
  motion.first = best_time(sweep.points, std::less<>());
  const std::uint64_t from =
      sweep.stamp +
      static_cast<std::uint64_t>(static_cast<std::int64_t>(std::llround(double{motion.first} * 1e9)));
  if (from == scan.stamp) return motion;
  // Roll and pitch of the IMU turn the sweep, too.
  const PoseFunction leaning = [&](std::uint64_t stamp) -> Result<Pose3> {
    auto T_odom_base = pose(stamp);
    if (!T_odom_base || !scan.attitude) return T_odom_base;
    const auto R_level_base = attitude_at(stamp);
    if (R_level_base && *R_level_base)
      T_odom_base->orientation = with_attitude(*T_odom_base, **R_level_base).orientation;
    return T_odom_base;
  };
  if (auto made = Deskew::over(from, scan.stamp, leaning, T_base_sensor)) {
    motion.deskew = std::move(*made);
    scan.deskewed = true;
  }
  return motion;
}

std::size_t ScanInput::add_points(const Source& source, const Sweep& sweep, const SweepMotion& motion,
                                  bool moved, const Eigen::Vector3f& mounted, Scan& scan) {
  const auto least2 = static_cast<float>(source.lidar.min_range * source.lidar.min_range);
  const auto most2 = static_cast<float>(source.lidar.max_range * source.lidar.max_range);
  const Eigen::Vector3f origin = moved ? mounted : Eigen::Vector3f(0, 0, 0);
  scan.points.reserve(sweep.points.size());
  std::size_t below = 0;
  const std::vector<std::uint8_t>* isolated =
      marks_isolated_ && &source == &sources_.front() && !moved ? &isolated_.find(sweep) : nullptr;
  if (isolated) scattered_ = isolated_.scattered() ? std::min(scattered_ + 1, kPatience) : 0;
  if (isolated && isolated->empty()) isolated = nullptr;
  if (scattered_ >= kPatience && &source == &sources_.front())
    scan.warnings.push_back({"returns_scattered", Reason::none,
                             "more than 40 % of the lidar's returns have no neighbour, as in thick dust or "
                             "rain: the odometry uses all of them"});
  for (const TimedPoint& point : sweep.points) {
    const float range2 = (point.position - origin).squaredNorm();
    if (!std::isfinite(range2)) {
      ++scan.counts.not_finite;
      continue;
    }
    if (range2 < least2 || range2 > most2) {
      ++scan.counts.out_of_range;
      continue;
    }
    const Eigen::Vector3f at = motion.deskew(point.position, point.time - motion.first);
    if (body_.contains(at)) {
      ++scan.counts.own_body;
      continue;
    }
    const float fall = mounted.z() - at.z();
    below += fall > 0 && fall * fall > kFalls * kFalls * range2;
    scan.points.push_back(at);
    if (isolated)
      scan.isolated.push_back((*isolated)[static_cast<std::size_t>(&point - sweep.points.data())]);
  }
  scan.counts.used = scan.points.size();
  return below;
}

bool ScanInput::is_planar(const Sweep& sweep, std::size_t index, const std::string& frame) const {
  constexpr float kFlat = 1e-3f;  // m; the coordinates of one ring are computed, and agree but for rounding.
  if (sweep.planar || index >= sources_.size()) return sweep.planar;
  const bool in_base = frame_name(frame) == "base_link" || frame.empty();
  const auto height = in_base ? static_cast<float>(sources_[index].lidar.mounting.z) : 0.0f;
  bool any = false;
  for (const TimedPoint& point : sweep.points) {
    if (!point.position.allFinite()) continue;
    if (std::abs(point.position.z() - height) > kFlat) return false;
    any = true;
  }
  return any;
}

Result<std::optional<Scan>> ScanInput::add(const Sweep& sweep, std::size_t index, const std::string& frame,
                                           const PoseFunction& pose) {
  if (index >= sources_.size()) return Error{Reason::bad_argument, "the platform has no such lidar"};
  Source& source = sources_[index];
  const auto T_base_sensor = find(frame);
  if (!T_base_sensor) return T_base_sensor.error();
  // What arrives in base_link was measured from the lidar, all the same.
  const bool moved = frame_name(frame) == "base_link" || frame.empty();
  const Eigen::Vector3d mounted = moved ? source.lidar.mounting.position() : T_base_sensor->position;
  if (!platform_.flies() && mounted.z() <= 0)
    return Error{Reason::lidar_mounting, "the lidar '" + frame + "' would be " +
                                             std::to_string(-mounted.z()) +
                                             " m under the floor, by the transform of its frame"};
  if (const auto ordered = in_order(source, sweep.stamp); !ordered) return ordered.error();

  Scan scan;
  scan.stamp = end_of(sweep);
  scan.planar = index == 0 && is_planar(sweep, index, frame);
  auto attitude = attitude_at(scan.stamp);
  if (!attitude) return attitude.error();
  scan.attitude = *attitude;

  const SweepMotion motion = motion_of(sweep, pose, *T_base_sensor, scan);
  const std::size_t below = add_points(source, sweep, motion, moved, mounted.cast<float>(), scan);
  if (const auto fits = plausible(source, sweep, scan, below); !fits) return fits.error();
  if (index > 0) {
    source.stamp = scan.stamp;
    source.points = std::move(scan.points);
    source.origin = mounted;
    return std::optional<Scan>{};
  }
  scan.parts = {{mounted, scan.points.size()}};
  note_attitude(scan);
  for (std::size_t n = 1; n < sources_.size(); ++n) merge(sources_[n], pose, scan);
  return std::optional<Scan>(std::move(scan));
}

void ScanInput::merge(Source& other, const PoseFunction& pose, Scan& scan) {
  if (other.stamp != scan.stamp &&
      std::fabs(after(scan.stamp, other.stamp)) > kOldSweeps / other.lidar.rate) {
    if (++other.missed < kPatience) return;
    other.missed = kPatience;
    scan.warnings.push_back(
        {"sensor_silent", Reason::sensor_silent,
         "no scan of the lidar on the topic '" + other.lidar.topic +
             "' is of the time of the first lidar's: it is silent, or has another clock"});
    return;
  }
  other.missed = 0;
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
  const auto now = pose(scan.stamp), then = pose(other.stamp);
  if (now && then) {
    const Pose3 T_now_then = now->inverse() * *then;
    T.linear() = T_now_then.orientation.toRotationMatrix().cast<float>();
    T.translation() = T_now_then.position.cast<float>();
  }
  for (const Eigen::Vector3f& p : other.points) scan.points.push_back(T * p);
  scan.parts.push_back({(T * other.origin.cast<float>()).cast<double>(), other.points.size()});
  if (!scan.isolated.empty()) scan.isolated.resize(scan.points.size(), 0);
  scan.counts.used = scan.points.size();
}

Pose3 with_attitude(const Pose3& T_odom_base, const Eigen::Quaterniond& R_level_base) {
  return {T_odom_base.position,
          Eigen::Quaterniond(Eigen::AngleAxisd(T_odom_base.yaw(), Eigen::Vector3d::UnitZ())) * R_level_base};
}

PointCloud levelled(const Scan& scan) {
  if (!scan.attitude) return scan.points;
  const Eigen::Matrix3f R = scan.attitude->toRotationMatrix().cast<float>();
  PointCloud out;
  out.reserve(scan.points.size());
  for (const Eigen::Vector3f& p : scan.points) out.push_back(R * p);
  return out;
}

}  // namespace adit::perception
