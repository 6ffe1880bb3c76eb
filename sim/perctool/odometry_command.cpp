// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/config/sensors_file.hpp"
#include "sim/drive/odometry_runner.hpp"
#include "sim/perctool/commands.hpp"
#include "sim/perctool/medians.hpp"
#include "sim/perctool/sensor_log.hpp"
#include "sim/rehearsal/program/report_error.hpp"

namespace adit::sim::perctool {
namespace {

/// Clouds without a platform: no return is of the body, and the lidar may be at any height.
Platform without_body(Platform platform) {
  platform.drive = Drive::aerial;
  platform.footprint.clear();
  platform.length = platform.width = 0.0;
  return platform;
}

/// Runs the odometry over recorded data; a line for each sweep.
class OdometryRun : public SensorSink {
 public:
  OdometryRun(const OdometryOptions& options, const Platform& platform,
              const perception::LidarOdometryParams& params, bool moves)
      : options_(options),
        runner_(without_body(platform), params, moves,
                [this](const OdometryRunner::Step& step) { take(step); }) {}

  void on_imu(const perception::ImuSample& sample) override { runner_.add(sample); }
  void on_wheels(const perception::BodyMotion& sample) override { runner_.add(sample); }
  Result<void> on_sweep(perception::Sweep&& sweep) override {
    runner_.add(std::move(sweep));
    return {};
  }
  void on_truth(const StampedPose& truth) override { truth_.push_back(truth); }

  void finish() { runner_.finish(); }
  const std::vector<StampedPose>& poses() const { return poses_; }
  const std::vector<StampedPose>& truth() const { return truth_; }
  const Medians& ms() const { return ms_; }
  Localisation health() const { return health_; }

 private:
  void take(const OdometryRunner::Step& step) {
    const perception::OdometryState& state = step.state;
    health_ = step.located ? state.health : Localisation::starting;
    const Pose3 pose = step.located ? state.pose : Pose3{};
    if (step.located && !first_) first_ = pose;
    // Clouds of a folder are numbered from 0 s on; a recording has the driver's clock.
    const double stamp = is_mcap(options_.log.clouds)
                             ? static_cast<double>(step.end) * 1e-9
                             : static_cast<double>(step.sweep.stamp - kLogStart) * 1e-9;
    poses_.push_back({stamp, first_ ? first_->inverse() * pose : Pose3{}});
    ms_.add(step.ms);
    if (!options_.json) return;
    const nlohmann::ordered_json line{
        {"sweep", poses_.size() - 1},         {"ms", step.ms},         {"health", name(health_)},
        {"points", step.sweep.points.size()}, {"used", state.used},    {"matched", state.matched},
        {"iterations", state.iterations},     {"sigma", state.sigma()}};
    std::printf("%s\n", line.dump().c_str());
  }

  const OdometryOptions& options_;
  OdometryRunner runner_;
  std::optional<Pose3> first_{};
  std::vector<StampedPose> poses_{}, truth_{};
  Medians ms_{};
  Localisation health_{Localisation::starting};
};

/// Sensors by --sensor, else as the recording says.
Result<void> read_sensors(const OdometryOptions& options, Platform& platform) {
  Sensors sensors;
  if (!options.sensor.empty()) {
    auto read = config::load_sensors_file(options.sensor);
    if (!read) return read.error();
    sensors = std::move(*read);
  } else if (is_mcap(options.log.clouds)) {
    const auto text = recorded_sensors(options.log.clouds);
    if (!text) return text.error();
    if (text->empty()) return {};
    auto root = config::parse(*text, options.log.clouds);
    if (!root) return root.error();
    sensors = config::read_sensors(*root, LidarConfig{}, false);
    if (auto done = root->finish(); !done) return done.error();
  } else {
    return {};
  }
  platform.lidars = std::move(sensors.lidars);
  platform.imu = sensors.imu;
  return {};
}

/// The same folder with its wheels and IMU has other parameters than clouds alone.
perception::LidarOdometryParams params_of(const OdometryOptions& options, const Platform& platform) {
  const bool mcap = is_mcap(options.log.clouds);
  const bool wheels = mcap || !options.log.wheels.empty(), imu = mcap || !options.log.imu.empty();
  const LidarConfig lidar = platform.lidar();
  if (!wheels && !imu)
    return perception::LidarOdometryParams::clouds_only(lidar.noise, lidar.min_range, lidar.max_range);
  perception::LidarOdometryParams params = perception::LidarOdometryParams::of(platform, wheels);
  params.motion.has_imu = imu;
  params.max_speed = 0.0;
  return params;
}

}  // namespace

int odometry(const OdometryOptions& options) {
  Platform platform;
  platform.lidars = {LidarConfig{}};  // At base_link: poses are the lidar's then.
  if (const auto known = read_sensors(options, platform); !known)
    return report_error("perctool", known.error());
  const perception::LidarOdometryParams params = params_of(options, platform);
  const bool moves = is_mcap(options.log.clouds) || !options.log.wheels.empty() || !options.log.imu.empty();
  OdometryRun run(options, platform, params, moves);
  if (const auto played = play_log(options.log, run); !played)
    return report_error("perctool", played.error());
  run.finish();
  if (run.poses().empty())
    return report_error("perctool", Error{Reason::cannot_read, options.log.clouds + ": no clouds there"});
  if (const auto written = write_tum(options.out, run.poses()); !written)
    return report_error("perctool", written.error());
  if (!options.truth.empty())
    if (const auto written = write_tum(options.truth, run.truth()); !written)
      return report_error("perctool", written.error());
  double length = 0.0;
  for (std::size_t n = 1; n < run.poses().size(); ++n)
    length += (run.poses()[n].pose.position - run.poses()[n - 1].pose.position).norm();
  if (options.json) {
    const nlohmann::ordered_json last{{"sweeps", run.poses().size()},
                                      {"ms_median", run.ms().median()},
                                      {"ms_p99", run.ms().quantile(0.99)},
                                      {"length", length},
                                      {"health", name(run.health())}};
    std::printf("%s\n", last.dump().c_str());
  } else {
    std::printf("%zu sweeps, %.2f m, %.2f ms each (p99 %.2f), %s\n", run.poses().size(), length,
                run.ms().median(), run.ms().quantile(0.99), name(run.health()));
  }
  return run.health() == Localisation::lost ? kExitFailed : 0;
}

}  // namespace adit::sim::perctool
