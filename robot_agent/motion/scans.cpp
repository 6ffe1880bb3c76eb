// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/motion/scans.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "nav_msgs/msg/Odometry.h"
#include "perception/input/point_layout.hpp"
#include "robot_agent/motion/sensor_messages.hpp"
#include "robot_agent/motion/sensor_readers.hpp"
#include "sensor_msgs/msg/Imu.h"
#include "sensor_msgs/msg/LaserScan.h"
#include "sensor_msgs/msg/PointCloud2.h"
#include "tf2_msgs/msg/TFMessage.h"

namespace adit::agent {
namespace {

constexpr Duration kScanDeadline = 500ms;            // an older scan says nothing of the terrain
constexpr std::uint64_t kLongestWait = 200'000'000;  // ns; farther ahead, the lidar has another clock
constexpr double kOdometryLate = 0.1;                // s; by the slowest odometry and its way here
constexpr Duration kPatience = 300ms;                // then no odometry comes
constexpr std::size_t kMaxWaiting = 16;              // sweeps; those of a lidar of 50 Hz meanwhile
constexpr std::uint64_t kImuWait = 60'000'000;       // ns; a longer gap is bridged by the driver's odometry
constexpr Duration kDrivesUnheard = 750ms;           // without odometry, until a robot gets zero
constexpr int kMaxNotDeskewed = 5;                   // consecutive scans before the operator is warned
constexpr Duration kFramesCome = 1s;                 // for the frames of /tf_static after the first scan
constexpr Duration kOdometryHeard = 200ms;           // two samples of the slowest odometry
constexpr double kClocksApart = 0.5;                 // s; longer than any delay of a scan in its driver
constexpr double kPairedWithin = 0.2;                // s; between a scan and the odometry heard with it
constexpr int kScansApart = 3;                       // consecutive scans; fewer are those of a busy computer

}  // namespace

Scans::Scans(Executor& strand, Log log, const Platform& platform, const ScanService& output, Report report,
             const std::vector<StaticFrames::Frame>& frames, std::uint32_t instance,
             FoundPlaceService* found_place)
    : Component("sensors", strand, std::move(log), {.beat = 100ms}),
      lidars_(platform.all_lidars()),
      output_(output),
      report_(std::move(report)),
      input_(platform),
      platform_(platform),
      bound_(platform),
      instance_(instance),
      found_place_(found_place),
      waiting_(lidars_.size()) {
  input_.mark_isolated(instance_ > 0);
  // What cannot be used was reported when it came.
  for (const StaticFrames::Frame& frame : frames)
    (void)input_.add_transform(frame.parent, frame.child, frame.T_parent_child);
}

Result<void> Scans::on_start() {
  if (found_place_ == nullptr) return {};
  offer(*found_place_, [this](const FoundPlace& found, const Reply<std::uint32_t>& reply) {
    if (!odometry_ || found.instance != instance_)
      return reply(Error{Reason::cancelled, "the odometry began again"});
    if (!odometry_->relocalised(found.correction, found.sigma, found.sigma_heading, found.steps))
      return reply(Error{Reason::cancelled, "the odometry found its place itself"});
    reply(odometry_->state().steps);
  });
  return {};
}

void Scans::take(const sensor_msgs::msg::PointCloud2& cloud, std::size_t lidar, Time received) {
  protect([&] {
    if (lidar < lidars_.size())
      take(to_sweep(cloud, 1.0 / lidars_[lidar].rate), lidar, cloud.header().frame_id(), received);
  });
}

void Scans::take(const sensor_msgs::msg::LaserScan& scan, Time received) {
  protect([&] {
    const std::string frame = perception::frame_name(scan.header().frame_id());
    // A scan in base_link is of a lidar above it.
    const bool above = frame.empty() || frame == "base_link";
    take(to_sweep(scan, above ? lidars_[0].mounting.z : 0.0, 1.0 / lidars_[0].rate), 0, frame, received);
  });
}

void Scans::take(const sensor_msgs::msg::Imu& imu, Time) {
  protect([&] {
    if (!platform_.imu) return;
    const auto added = input_.add(imu_sample_of(imu), imu.header().frame_id());
    if (!added) return refuse(platform_.imu->topic, added.error());
    if (odometry_) {
      // In the axes of base_link, in m/s2.
      const auto mount = input_.mounting_of_imu(imu.header().frame_id());
      perception::ImuSample sample = imu_sample_of(imu);
      if (input_.imu_in_g()) sample.accel *= perception::kStandardGravity;
      if (mount)
        odometry_->add(perception::ImuSample{sample.stamp, mount->orientation * sample.gyro,
                                             mount->orientation * sample.accel});
    }
    if (!input_.imu_in_g() || std::exchange(in_g_reported_, true)) return;
    warn(platform_.imu->topic, "imu_in_g", Reason::none,
         "the IMU measures in g instead of m/s2; its values are scaled");
  });
}

void Scans::take(const nav_msgs::msg::Odometry& odometry, Time received) {
  protect([&] {
    const auto& p = odometry.pose().pose().position();
    const Eigen::Quaterniond q = quaternion_of(odometry.pose().pose().orientation());
    const Eigen::Vector3d at(p.x(), p.y(), p.z());
    if (!at.allFinite() || !is_rotation(q)) return;  // The command component says so.
    const std::uint64_t stamp = nanoseconds_of(odometry.header());
    if (stamp == 0)
      return warn("odom", "not_deskewed", Reason::sensor_times,
                  "the odometry on /odom has no stamps: scans are not corrected for motion; its driver must "
                  "set the time of each in the header");
    odometry_heard_ = received;
    const bool set_back = stamp < history_.newest() && history_.newest() - stamp > 500'000'000;
    const OdometrySample sample{{at, q.normalized()}, stamp, received};
    const bool late = stamp < history_.newest() && !set_back;
    const bool began_again =
        newest_odometry_ && !late && !bound_.reachable(*newest_odometry_, sample, kDrivesUnheard);
    if (!late) newest_odometry_ = sample;
    if (set_back || began_again) {
      history_.clear();
      if (odometry_) odometry_->forget_wheels();
    }
    history_.add(stamp, {at, q.normalized()});
    if (odometry_) odometry_->add(perception::BodyMotion{stamp, {at, q.normalized()}});
    input_.add_odometry(stamp, vector_of(odometry.twist().twist().linear()), Pose3{at, q.normalized()}.yaw());
    pass_on_ready();
  });
}

void Scans::take(const tf2_msgs::msg::TFMessage& transforms, Time) {
  protect([&] {
    for (const StaticFrames::Frame& frame : frames_of(transforms)) {
      const auto set = input_.add_transform(frame.parent, frame.child, frame.T_parent_child);
      if (!set) refuse("tf_static", set.error());
    }
  });
}

void Scans::two_sources(const std::string& topic, const OneSource& source) {
  report_(agent::two_sources(topic, source));
}

void Scans::take(Result<perception::Sweep> sweep, std::size_t lidar, const std::string& frame,
                 Time received) {
  if (!sweep) return refuse(lidars_[lidar].topic, sweep.error());
  const std::uint64_t end = perception::ScanInput::end_of(*sweep);
  const double ahead = end > history_.newest() && history_.newest() != 0
                           ? static_cast<double>(end - history_.newest()) * 1e-9
                           : 0.0;
  waiting_[lidar].push_back({std::move(*sweep), end, ahead, frame, received});
  pass_on_ready();
}

bool Scans::must_wait(const std::deque<Waiting>& sweeps) const {
  return sweeps.empty() || (sweeps.size() <= kMaxWaiting && now() - sweeps.front().received < kPatience &&
                            is_ahead(sweeps.front()));
}

void Scans::pass_on_ready() {
  while (true) {
    // The first lidar's sweep takes in those of the others: of equal ends it comes last.
    std::optional<std::size_t> next;
    for (std::size_t n = waiting_.size(); n-- > 0;)
      if (!must_wait(waiting_[n]) && (!next || waiting_[n].front().end < waiting_[*next].front().end))
        next = n;
    if (!next) return;
    const Waiting first = std::move(waiting_[*next].front());
    waiting_[*next].pop_front();
    pass_on(*next, first);
  }
}

bool Scans::is_ahead(const Waiting& waiting) const {
  if ((!waiting.sweep.timed && instance_ == 0) || history_.newest() == 0) return false;
  const std::uint64_t end = waiting.end;
  if (end > history_.newest()) return end - history_.newest() <= kLongestWait;
  // The odometry of its own also waits for the IMU, which may have a gap.
  return odometry_ && !odometry_->covers(end) && history_.newest() - end < kImuWait;
}

bool Scans::advance_odometry(const Waiting& waiting) {
  if (instance_ == 0) return false;
  if (!odometry_) {
    auto params = perception::LidarOdometryParams::of(platform_);
    params.planar = input_.is_planar(waiting.sweep, 0, waiting.frame);
    odometry_.emplace(params);
  }
  return odometry_->advance(waiting.end);
}

std::optional<OdometryReport> Scans::locate(const perception::Scan& scan) {
  const perception::OdometryState& state = odometry_->update(scan.points, scan.isolated, scan.deskewed);
  // In a map of an unknown place the robot is as lost as without one.
  const Localisation at = state.unplaced ? Localisation::lost : state.health;
  OdometryReport report{.stamp = scan.stamp,
                        .T_local_base = state.pose,
                        .instance = instance_,
                        .health = at,
                        .sigma_seen = state.sigma_seen,
                        .wheels_slip = state.wheels_slip,
                        .relocalised = state.relocalised,
                        .steps = state.steps};
  double unsure = early_;  // Of the pose's time, s.
  // A pose of the stamp of another clock would be one of long ago.
  const bool other_clock = apart_ >= kScansApart && now() - odometry_heard_ <= kOdometryHeard;
  auto T_driver_base = other_clock ? Error{Reason::out_of_range} : history_.at(scan.stamp);
  if (!T_driver_base) {
    // The driver's frame began again, or it is silent: no pose. Or its clock is another one: what it sent
    // last is of about the time of the scan.
    T_driver_base = history_.at(history_.newest());
    if (!T_driver_base || !other_clock) return std::nullopt;
    report.stamp = history_.newest();
    unsure = kPairedWithin;
  }
  report.T_local_driver = state.pose * T_driver_base->inverse();
  if (unsure > 0 && at == Localisation::ok) report.health = Localisation::weak;
  report.sigma = std::hypot(state.sigma(), platform_.max_speed * unsure);
  return report;
}

void Scans::report_clock_steps() {
  if (!odometry_) return;
  const auto steps = odometry_->clock_steps(), before = std::exchange(clock_steps_, steps);
  const auto report = [this](const std::string& topic, const char* sensor) {
    warn(
        topic, "clock_stepped", Reason::sensor_times,
        std::string("the stamps of ") + sensor +
            " went on more than a second later or earlier: its clock was set, or it was silent; the odometry "
            "goes on from where it was");
  };
  if (steps.lidar != before.lidar) report(lidars_[0].topic, "the lidar");
  if (steps.imu != before.imu && platform_.imu) report(platform_.imu->topic, "the IMU");
  if (steps.wheels != before.wheels) report("odom", "the odometry");
}

void Scans::pass_on(std::size_t lidar, const Waiting& waiting) {
  // One clock for all, as without it nothing can be deskewed.
  const bool located = lidar == 0 && waiting.sweep.stamp != 0 && advance_odometry(waiting);
  report_clock_steps();
  if (lidar == 0) {
    compare_clocks(waiting.end);
    // A sweep that has not ended yet is of another clock; only an odometry that is late looks the same.
    early_ = waiting.ahead > kOdometryLate ? waiting.ahead : 0.0;
  }
  auto scan = input_.add(waiting.sweep, lidar, waiting.frame, [&](std::uint64_t stamp) {
    return located ? odometry_->at(stamp) : history_.at(stamp);
  });
  if (!scan) return refuse(lidars_[lidar].topic, scan.error());
  if (!*scan) return;  // A scan is made when the first lidar's sweep comes.
  perception::Scan& complete = **scan;
  judge_clock(waiting, complete.deskewed);
  for (const perception::ScanWarning& warning : complete.warnings)
    warn(lidars_[lidar].topic, warning.code, warning.reason, warning.text);
  std::optional<OdometryReport> report;
  if (located && complete.stamp != 0) report = locate(complete);
  // The odometry knows roll and pitch better than a filter of the IMU alone.
  const auto attitude = report && report->health != Localisation::lost ? std::nullopt : complete.attitude;
  call(output_,
       {std::make_shared<PointCloud>(std::move(complete.points)), complete.stamp, attitude, waiting.received,
        report, complete.planar, std::move(complete.isolated), std::move(complete.parts)},
       {.deadline = kScanDeadline}, [](const Result<void>&) {});
}

void Scans::compare_clocks(std::uint64_t end) {
  const std::uint64_t newest = history_.newest();
  ahead_.reset();
  // Odometry that is not heard any more says nothing about its clock.
  if (newest == 0 || now() - odometry_heard_ >= kOdometryHeard) return;
  ahead_ = end != 0 ? static_cast<double>(static_cast<std::int64_t>(end - newest)) * 1e-9 : 0.0;
  apart_ = *ahead_ > kPairedWithin || *ahead_ < -kClocksApart ? apart_ + 1 : 0;
}

void Scans::judge_clock(const Waiting& waiting, bool deskewed) {
  const bool stamped = waiting.end != 0, apart = apart_ >= kScansApart;
  // The first sweep begins before the first pose.
  const bool bad = ahead_ && (apart || (waiting.sweep.timed && !deskewed));
  not_deskewed_ = bad ? not_deskewed_ + 1 : 0;
  if (not_deskewed_ < kMaxNotDeskewed) return;
  char text[200];
  if (!stamped)
    std::snprintf(
        text, sizeof text,
        "the scans have no stamps, and are not corrected for motion: the lidar's driver must set the "
        "time of each in the header");
  else if (apart)
    std::snprintf(
        text, sizeof text,
        "lidar and odometry have different clocks, and %s: the scans are %.1f s %s the odometry; let both "
        "drivers use one clock",
        deskewed ? "the pose is weak" : "scans are not corrected for motion", std::abs(*ahead_),
        *ahead_ > 0 ? "ahead of" : "behind");
  else
    std::snprintf(text, sizeof text,
                  "the odometry has no poses for the times of the scans, which are not corrected for motion");
  warn(lidars_[0].topic, "not_deskewed", Reason::sensor_times, text);
}

void Scans::refuse(const std::string& topic, const Error& error) {
  // A message that came late is normal; only the newest counts.
  if (error.reason == Reason::sample_stale) return;
  // After a start the first scans may come before the frames.
  if (error.reason == Reason::frame_unknown) {
    if (!frame_unknown_) frame_unknown_ = now();
    if (now() - *frame_unknown_ < kFramesCome) return;
  }
  report_({topic, "sensor_refused", Severity::error, error});
}

void Scans::warn(const std::string& topic, const char* code, Reason reason, const std::string& text) {
  report_({topic, code, Severity::warning, {reason, text}});
}

Result<perception::Sweep> to_sweep(const sensor_msgs::msg::PointCloud2& cloud, double duration) {
  if (cloud.is_bigendian()) return Error{Reason::malformed, "the cloud is big endian"};
  std::vector<perception::PointField> fields;
  for (const auto& field : cloud.fields()) fields.push_back({field.name(), field.offset(), field.datatype()});
  const auto layout = perception::PointLayout::of(fields, cloud.point_step());
  if (!layout) return layout.error();
  return layout->unpack(cloud.data(), std::uint64_t{cloud.width()} * cloud.height(),
                        nanoseconds_of(cloud.header()), duration);
}

Result<perception::Sweep> to_sweep(const sensor_msgs::msg::LaserScan& scan, double height, double duration) {
  const double first = scan.angle_min(), step = scan.angle_increment();
  const std::size_t count = scan.ranges().size();
  if (!std::isfinite(first) || !std::isfinite(step) || std::abs(first) > 10.0 ||
      std::abs(step) * static_cast<double>(count) > 2.2 * std::numbers::pi)
    return Error{Reason::malformed, "the scan's angles are none of one turn"};
  perception::Sweep sweep;
  sweep.stamp = nanoseconds_of(scan.header());
  sweep.planar = true;
  sweep.points.reserve(count);
  const float each = scan.time_increment(), all = each * static_cast<float>(count);
  if (!std::isfinite(all) || std::abs(all) > perception::PointLayout::kLongest * duration) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "the scan's time_increment %.4g times its %zu rays is no sweep of %.3g s: it is in seconds",
                  static_cast<double>(each), count, duration);
    return Error{Reason::sensor_times, text};
  }
  sweep.timed = each > 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float range = scan.ranges()[i];
    if (!std::isfinite(range) || range < scan.range_min() || range > scan.range_max()) continue;
    const double angle = first + step * static_cast<double>(i);
    sweep.points.push_back(
        {Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), height).cast<float>(),
         sweep.timed ? each * static_cast<float>(i) : 0.0f, 0.0f, 0});
  }
  sweep.timed = sweep.timed && !sweep.points.empty();
  return sweep;
}

}  // namespace adit::agent
