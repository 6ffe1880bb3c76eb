// SPDX-License-Identifier: Apache-2.0
// Lidar-inertial odometry on simulated drives: one row for each kind of trouble.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/nav/calibration.hpp"
#include "bench/perception/street_row.hpp"
#include "bench/perception/telemetry_rows.hpp"
#include "core/config/platform_file.hpp"
#include "sim/cloud/evaluation.hpp"
#include "sim/drive/drive_recording.hpp"
#include "sim/drive/odometry_runner.hpp"
#include "sim/world/generate.hpp"

namespace {

using namespace adit;
using namespace adit::sim;

constexpr double kStanding = 600.0;  ///< At the end of the row `level`, s.

/// Outcome of one drive.
struct Outcome {
  std::vector<StampedPose> truth{}, estimate{};
  std::vector<double> ms{};
  double way{};                    ///< m
  double largest{};                ///< Error of the position, m.
  double largest_z{};              ///< Error of the height, m.
  double standing_z{};             ///< Largest less smallest one while the robot stands at the end, m.
  Pose3 end_error{};               ///< T_truth_estimate at the end.
  std::size_t within{}, judged{};  ///< Poses whose squared normalised error is below the 95 % bound.
  std::vector<double> nees{};      ///< Squared normalised error of x, y and yaw.
  std::size_t lost{}, weak{};      ///< Sweeps.
};

/// Runs the odometry while the robot drives.
class Locating : public DriveSink {
 public:
  explicit Locating(const Platform& platform)
      : runner_(platform, perception::LidarOdometryParams::of(platform, true), true,
                [this](const OdometryRunner::Step& step) { take(step); }) {}
  void on_imu(const perception::ImuSample& sample) override { runner_.add(sample); }
  void on_wheels(const WheelSample& sample) override {
    runner_.add(perception::BodyMotion{sample.stamp, sample.pose});
  }
  void on_sweep(perception::Sweep&& sweep) override { runner_.add(std::move(sweep)); }
  void on_truth(const TruthSample& truth) override { truth_.on_truth(truth); }

  Outcome finish() {
    runner_.finish();
    out_.way = truth_.distance();
    if (steps_.empty()) return out_;
    std::vector<std::pair<double, double>> heights;  // s, m
    // Both frames are level.
    const Pose3 first = truth_.truth_at(steps_.front().stamp), stated = steps_.front().pose;
    const Pose3 T_world_odom =
        Pose3::level(first.planar() * stated.planar().inverse(), first.position.z() - stated.position.z());
    for (const Located& step : steps_) {
      const Pose3 truth = truth_.truth_at(step.stamp), estimate = T_world_odom * step.pose;
      const double seconds = static_cast<double>(step.stamp - kDriveStart) * 1e-9;
      out_.truth.push_back({seconds, truth});
      out_.estimate.push_back({seconds, estimate});
      const Eigen::Vector3d error = estimate.position - truth.position;
      out_.largest = std::max(out_.largest, error.norm());
      out_.largest_z = std::max(out_.largest_z, std::abs(error.z()));
      heights.emplace_back(seconds, error.z());
      // Of x, y and yaw, in odom. The truth is that of the body, while lidar and clock are off by up to 1 cm
      // and 0.3 degrees: so far the first pose, which ties both frames, is itself wrong.
      Eigen::Vector3d off;
      off.head<2>() = (T_world_odom.orientation.conjugate() * error).head<2>();
      off[2] = wrap_angle(estimate.yaw() - truth.yaw());
      constexpr double kFloor = 0.01, kFloorYaw = 0.003;
      const Eigen::Matrix3d P =
          step.covariance + Eigen::Vector3d(kFloor * kFloor, kFloor * kFloor, kFloorYaw * kFloorYaw)
                                .asDiagonal()
                                .toDenseMatrix();
      const double nees = off.dot(P.ldlt().solve(off));
      constexpr double kBound = 7.815;  // 95 % of chi-square with three degrees of freedom
      ++out_.judged;
      out_.within += nees <= kBound;
      out_.nees.push_back(nees);
      out_.end_error = truth.inverse() * estimate;
    }
    double low = heights.back().second, high = low;
    for (const auto& [seconds, height] : heights)
      if (seconds > heights.back().first - (kStanding - 10.0))
        low = std::min(low, height), high = std::max(high, height);
    out_.standing_z = high - low;
    return out_;
  }

 private:
  struct Located {
    std::uint64_t stamp{};
    Pose3 pose{};
    Eigen::Matrix3d covariance{};  ///< Of x, y and yaw.
  };
  void take(const OdometryRunner::Step& step) {
    if (!step.located) return;
    out_.ms.push_back(step.ms);
    out_.lost += step.state.health == Localisation::lost;
    out_.weak += step.state.health == Localisation::weak;
    const Eigen::Array3i axes(0, 1, 5);
    Eigen::Matrix3d covariance;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        covariance(row, column) = step.state.covariance(axes[row], axes[column]);
    steps_.push_back({step.end, step.state.pose, covariance});
  }
  DriveRecording truth_{};
  std::vector<Located> steps_{};
  Outcome out_{};
  OdometryRunner runner_;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

Result<Outcome> run(const DriveSpec& spec) {
  Locating locating(spec.platform);
  if (const Result<void> driven = drive(spec, locating); !driven) return driven.error();
  return locating.finish();
}

DriveSpec base_spec(const GeneratedWorld& world, const std::string& platform, std::uint64_t seed) {
  DriveSpec spec;
  spec.world = std::make_shared<const World>(make_box_world(world.boxes, 0.0, 3.0).value());
  spec.platform = config::load_platform(platform).value();
  spec.start = {world.start.x(), world.start.y(), 0.0};
  spec.seed = seed;
  spec.steps.emplace_back(StandFor{2.0});
  return spec;
}

/// A closed way between the boxes of a car park, without the ramp.
DriveSpec park(std::uint64_t seed) {
  DriveSpec spec = base_spec(generate_world("car_park", seed).value(), "wheeled", seed);
  for (int lap = 0; lap < 3; ++lap)
    for (const Eigen::Vector2d& place : {Eigen::Vector2d(37.5, 2.0), {37.5, 19.5}, {2.0, 19.5}, {2.0, 2.0}})
      spec.steps.emplace_back(DriveTo{place, 1.2});
  return spec;
}

DriveSpec street(std::uint64_t seed) {
  DriveSpec spec = base_spec(generate_world("blocks", seed).value(), "wheeled", seed);
  constexpr double a = 1.6, b = 12.8, c = 24.0, d = 35.2;
  for (int lap = 0; lap < 2; ++lap)
    for (const Eigen::Vector2d& place :
         {Eigen::Vector2d(d, a), {d, b}, {a, b}, {a, c}, {d, c}, {d, d}, {a, d}, {a, a}})
      spec.steps.emplace_back(DriveTo{place, 1.2});
  return spec;
}

DriveSpec tunnel(std::uint64_t seed) {
  DriveSpec spec = base_spec(generate_tunnel(130), "wheeled", seed);
  // The lidar must see an end before the smooth part begins, as on a robot that drives into a tunnel.
  spec.steps.emplace_back(DriveTo{{122.0, 1.5}, 1.5});
  spec.steps.emplace_back(StandFor{1.0});
  return spec;
}

DriveSpec turns(std::uint64_t seed) {
  DriveSpec spec = base_spec(generate_world("rooms", seed).value(), "wheeled", seed);
  spec.platform.max_turn = 2.0;
  spec.steps.emplace_back(TurnBy{20 * 2 * M_PI, M_PI / 2});
  spec.steps.emplace_back(StandFor{1.0});
  return spec;
}

DriveSpec stairs(std::uint64_t seed) {
  DriveSpec spec = base_spec(generate_world("stairs", seed).value(), "legged", seed);
  for (int flight = 0; flight < 3; ++flight) {
    spec.steps.emplace_back(DriveTo{{12.0, 2.5}, 0.6});
    if (flight < 2) spec.steps.emplace_back(DriveTo{{3.0, 2.5}, 0.6});
  }
  spec.steps.emplace_back(StandFor{1.0});
  return spec;
}

DriveSpec dusty(std::uint64_t seed, bool dust) {
  DriveSpec spec = street(seed);
  if (!dust) return spec;
  spec.dust = 0.2;
  spec.dropouts = 0.3;
  for (int n = 0; n < 5; ++n) {
    const double y = n < 3 ? 1.0 + 11.2 * n : 12.2 + 11.2 * (n - 3);
    spec.people.push_back({.path = {{5.0 + 2 * n, y - 0.4}, {25.0 - 2 * n, y - 0.4}}, .speed = 1.0});
  }
  return spec;
}

/// A ring of four smooth level corridors, 80 m and 60 m long, driven round once; then the robot stands.
DriveSpec level(std::uint64_t seed) {
  constexpr double kIn = 1.3, kOut = 1.6, kLong = 80.0, kShort = 60.0, kHigh = 3.0;
  GeneratedWorld ring;
  for (const double y : {-kOut, kShort + kIn})
    ring.boxes.push_back({-kOut, kLong + kOut, y, y + 0.3, 0, kHigh});
  for (const double x : {-kOut, kLong + kIn})
    ring.boxes.push_back({x, x + 0.3, -kOut, kShort + kOut, 0, kHigh});
  for (const double y : {kIn, kShort - kOut}) ring.boxes.push_back({kIn, kLong - kIn, y, y + 0.3, 0, kHigh});
  for (const double x : {kIn, kLong - kOut}) ring.boxes.push_back({x, x + 0.3, kIn, kShort - kIn, 0, kHigh});
  DriveSpec spec = base_spec(ring, "wheeled", seed);
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(80, 0), {80, 60}, {0, 60}, {0, 0}})
    spec.steps.emplace_back(DriveTo{place, 2.0});
  spec.steps.emplace_back(StandFor{kStanding});
  return spec;
}

/// Lidars of more beams, on one side of the streets.
DriveSpec dense(std::uint64_t seed, int rings, int columns) {
  DriveSpec spec = base_spec(generate_world("blocks", seed).value(), "wheeled", seed);
  spec.lidar.columns = columns;
  spec.platform.lidars.resize(std::max<std::size_t>(1, spec.platform.lidars.size()), spec.platform.lidar());
  spec.platform.lidars[0].rings = rings;
  spec.steps.emplace_back(DriveTo{{24.0, 1.6}, 1.2});
  return spec;
}

struct Report {
  std::string command{};
  bool failed{};

  void print(const char* row, const Result<Outcome>& result, const std::string& what) {
    if (!result) {
      std::printf("%-10s %s\n", row, result.error().text.c_str());
      failed = true;
      return;
    }
    const double unit = bench::calibration_unit_ms();
    std::printf(
        "%-10s %6.1f m  median %5.2f ms (%.2f units), p99 %5.2f  NEES in band %5.1f %%, median %.2f  weak "
        "%zu lost %zu  "
        "%s\n",
        row, result->way, quantile(result->ms, 0.5), quantile(result->ms, 0.5) / unit,
        quantile(result->ms, 0.99),
        100.0 * static_cast<double>(result->within) /
            static_cast<double>(std::max<std::size_t>(1, result->judged)),
        quantile(result->nees, 0.5), result->weak, result->lost, what.c_str());
    std::fflush(stdout);
  }
};

double ate_percent(const Outcome& outcome) {
  const auto result = evaluate(outcome.truth, outcome.estimate, {});
  return result ? 100.0 * result->ate.rmse / outcome.way : 100.0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Lidar-inertial odometry on simulated drives.", "bench_perception"};
  int seeds = 1;
  std::vector<std::string> rows{"ate", "tunnel", "level", "turns", "stairs", "dense", "dust", "telemetry"};
  app.add_option("--seeds", seeds, "drives of each row")->capture_default_str()->check(CLI::Range(1, 1000));
  app.add_option("--rows", rows, "of ate tunnel level turns stairs dense dust telemetry")
      ->capture_default_str();
  std::string clouds;
  std::vector<std::string> peers;
  app.add_option("--clouds", clouds, "folder of real clouds for the row of the street");
  app.add_option("--peer", peers, "NAME=FILE.tum: a peer's trajectory on --clouds; repeatable");
  bench::TelemetryOptions telemetry;
  app.add_option("--only", telemetry.only, "worlds, robots and faults of the row telemetry");
  app.add_option("--scenarios", telemetry.scenarios, "folder for the scenarios of that row that fail");
  app.footer("Example: bench_perception --rows tunnel --seeds 20");
  CLI11_PARSE(app, argc, argv);
  const auto wanted = [&](const char* row) { return std::find(rows.begin(), rows.end(), row) != rows.end(); };
  Report report;
  std::size_t within = 0, judged = 0;
  const auto count = [&](const Result<Outcome>& result) {
    if (!result) return;
    within += result->within;
    judged += result->judged;
  };
  for (int n = 1; n <= seeds; ++n) {
    const auto seed = static_cast<std::uint64_t>(n);
    if (wanted("ate"))
      for (const bool parked : {true, false}) {
        const auto result = run(parked ? park(seed) : street(seed));
        report.print(parked ? "ate park" : "ate blocks", result,
                     result ? fmt::format("ATE {:.3f} % (must 0.3), end {:.2f} m", ate_percent(*result),
                                          result->end_error.position.norm())
                            : "");
        count(result);
      }
    if (wanted("tunnel")) {
      const auto result = run(tunnel(seed));
      report.print("tunnel", result,
                   result ? fmt::format("end error along the axis {:.3f} % (must 0.5)",
                                        100.0 * std::abs(result->end_error.position.x()) / result->way)
                          : "");
      count(result);
    }
    if (wanted("level")) {
      const auto result = run(level(seed));
      report.print(
          "level", result,
          result ? fmt::format("z off by {:.2f} m at most, {:.3f} % (must 0.2), {:.3f} m in ten minutes of "
                               "standing (must 0.01), end {:.2f} m",
                               result->largest_z, 100 * result->largest_z / result->way, result->standing_z,
                               result->end_error.position.norm())
                 : "");
      count(result);
    }
    if (wanted("turns")) {
      const auto result = run(turns(seed));
      report.print("turns", result,
                   result ? fmt::format("yaw after 20 turns {:.2f} degrees (must 1)",
                                        std::abs(result->end_error.yaw()) * 180.0 / M_PI)
                          : "");
      count(result);
    }
    if (wanted("stairs")) {
      const auto result = run(stairs(seed));
      const auto tilt = [&] {
        const Eigen::Vector3d up = result->end_error.orientation * Eigen::Vector3d::UnitZ();
        return std::acos(std::min(1.0, up.z())) * 180.0 / M_PI;
      };
      constexpr double kClimbed = 5 * 1.2;  // m: three times up and twice down
      report.print(
          "stairs", result,
          result ? fmt::format("z {:.2f} % of the height climbed (must 2), tilt {:.2f} degrees (must 0.5)",
                               100.0 * std::abs(result->end_error.position.z()) / kClimbed, tilt())
                 : "");
      count(result);
    }
    if (wanted("dense"))
      for (const bool most : {false, true}) {
        const auto result = run(dense(seed, most ? 64 : 32, most ? 1875 : 1800));
        report.print(most ? "64 x 1875" : "32 x 1800", result,
                     most ? "median must 12 ms, p99 twice that" : "median must 5 ms, p99 twice that");
      }
    if (wanted("dust")) {
      const auto clean = run(dusty(seed, false)), result = run(dusty(seed, true));
      report.print("dust", result,
                   result && clean
                       ? fmt::format("ATE {:.3f} %, {:.2f} times the clean error (must 1.5, or 0.1 %)",
                                     ate_percent(*result), ate_percent(*result) / ate_percent(*clean))
                       : "");
      count(result);
    }
  }
  if (wanted("telemetry")) {
    telemetry.seeds = seeds;
    const auto honest = bench::print_telemetry(telemetry);
    if (!honest) std::fprintf(stderr, "%s\n", honest.error().text.c_str());
    report.failed = report.failed || !honest || !*honest;
  }
  if (!clouds.empty())
    if (const auto printed = bench::print_street(clouds, peers); !printed) {
      std::fprintf(stderr, "%s\n", printed.error().text.c_str());
      report.failed = true;
    }
  if (judged > 0)
    std::printf("honest: NEES of %.1f %% of the poses within its 95 %% bound (must 85 to 99)\n",
                100.0 * static_cast<double>(within) / static_cast<double>(judged));
  std::printf("command: build/release/bin/bench_perception --seeds %d --rows %s\n", seeds,
              fmt::format("{}", fmt::join(rows, " ")).c_str());
  return report.failed ? 1 : 0;
}
