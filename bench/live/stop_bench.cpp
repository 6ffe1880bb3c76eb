// SPDX-License-Identifier: Apache-2.0
// How long a stop takes from the operator's station to the first zero at the driver, over Fast DDS, while the
// robot has to work out large scans, or sends a large map to stations that come late. A program steers the
// robot in the mode `external`; the station stops it again and again. Run it in a network of its own:
// tests/live/isolated.sh.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <thread>

#include "basestation/station/station.hpp"
#include "core/exec/live_runtime.hpp"
#include "core/wire/fastdds/fastdds_participant.hpp"
#include "core/wire/topics.hpp"
#include "core/wire/typed.hpp"
#include "geometry_msgs/msg/Twist.h"
#include "nav_msgs/msg/Odometry.h"
#include "robot_agent/agent.hpp"
#include "sensor_msgs/msg/PointCloud2.h"
#include "tests/agent/large_map.hpp"
#include "tests/point_cloud.hpp"

namespace adit::bench {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr unsigned kRadio = 30, kInner = 31;
constexpr std::size_t kMapBlocks = 190'000;
constexpr Duration kLateEvery = 12s;  // Between two stations that come late.

[[noreturn]] void give_up(const std::string& what) {
  std::fprintf(stderr, "bench_stop: %s\n", what.c_str());
  std::_Exit(2);
}

double now_ms() { return std::chrono::duration<double, std::milli>(Clock::now().time_since_epoch()).count(); }

std::unique_ptr<wire::Participant> join(unsigned domain, bool inner) {
  wire::FastDdsParams params;
  params.domain = domain;
  params.large_samples = inner;
  auto opened = wire::open_fastdds(params);
  if (!opened) give_up(opened.error().text);
  return std::move(*opened);
}

/// Runs the work on the strand and waits for its end.
template <class Work>
void on(Executor& strand, Work work) {
  std::atomic<bool> done{false};
  strand.post([&] {
    work();
    done = true;
    done.notify_all();
  });
  done.wait(false);
}

bool wait_for(const std::function<bool()>& what, double limit_ms) {
  for (const double begin = now_ms(); now_ms() - begin < limit_ms;) {
    if (what()) return true;
    std::this_thread::sleep_for(200us);
  }
  return what();
}

/// The walls of a square room and its floor, as so many points.
sensor_msgs::msg::PointCloud2 room(std::size_t points) {
  std::vector<float> numbers;
  for (std::size_t i = 0; i < points; ++i) {
    const double bearing = 2 * M_PI * static_cast<double>(i % 2048) / 2048;
    const double slope =
        -0.25 + 0.5 * static_cast<double>(i / 2048) / (static_cast<double>(points) / 2048 + 1);
    const double wall = 6.0 / std::max(std::fabs(std::cos(bearing)), std::fabs(std::sin(bearing)));
    const double floor = slope < 0 ? 0.5 / -slope : 1e3;  // The lidar is half a metre above it.
    const double range = std::min(wall, floor);
    numbers.insert(numbers.end(),
                   {static_cast<float>(range * std::cos(bearing)),
                    static_cast<float>(range * std::sin(bearing)), static_cast<float>(0.5 + slope * range)});
  }
  auto cloud = cloud_of(numbers);
  cloud.header().frame_id("base_link");
  return cloud;
}

/// A robot that stands whatever velocity it gets, so that nothing comes near; its driver and its lidar.
class TestRobot {
 public:
  TestRobot(std::size_t points, Duration scan_period, std::shared_ptr<store::Disk> disk)
      : driver_strand_(driver_runtime_.strand("driver")),
        lidar_strand_(driver_runtime_.strand("lidar")),
        radio_(join(kRadio, false)),
        inner_(join(kInner, true)),
        driver_(join(kInner, true)),
        cloud_(room(points)) {
    agent::AgentParams params;
    params.name = "r1";
    params.perception = disk ? PerceptionLevel::slam : PerceptionLevel::off;
    params.disk = std::move(disk);
    agent_ = std::make_unique<agent::Agent>(params, agent_runtime_, *radio_, *inner_);
    if (const auto started = agent_->start(); !started) give_up(started.error().text);
    odom_ = wire::Writer<nav_msgs::msg::Odometry>::make(*driver_, wire::topics::kOdom).value();
    points_ = wire::Writer<sensor_msgs::msg::PointCloud2>::make(*driver_, wire::topics::kPoints).value();
    wish_ = wire::Writer<geometry_msgs::msg::Twist>::make(*driver_, wire::topics::kExternalCmdVel).value();
    reader_ = wire::make_reader(*driver_, wire::topics::kCmdVel, *driver_strand_,
                                [this](const geometry_msgs::msg::Twist& twist, const wire::SampleInfo&) {
                                  const bool zero = twist.linear().x() == 0.0;
                                  if (zero && moves_) zero_at_ = now_ms();
                                  moves_ = !zero;
                                })
                  .value();
    on(*driver_strand_, [this] {
      drive_ = driver_strand_->every(20ms, [this] {
        nav_msgs::msg::Odometry o;
        stamp(o.header());
        o.pose().pose().orientation().w(1.0);
        (void)odom_.write(o);
        geometry_msgs::msg::Twist wish;
        wish.linear().x(0.1);
        (void)wish_.write(wish);
      });
    });
    on(*lidar_strand_, [this, scan_period] {
      scan_ = lidar_strand_->every(scan_period, [this] {
        stamp(cloud_.header());
        (void)points_.write(cloud_);
      });
    });
  }
  ~TestRobot() {
    reader_.reset();
    on(*driver_strand_, [this] { drive_ = {}; });
    on(*lidar_strand_, [this] { scan_ = {}; });
  }

  std::atomic<bool> moves_{false};
  std::atomic<double> zero_at_{0};

 private:
  static void stamp(std_msgs::msg::Header& header) {
    const auto ns = Clock::now().time_since_epoch() / 1ns;
    header.stamp().sec(static_cast<std::int32_t>(ns / 1'000'000'000));
    header.stamp().nanosec(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }

  LiveRuntime driver_runtime_{}, agent_runtime_{};
  std::shared_ptr<Executor> driver_strand_, lidar_strand_;
  std::unique_ptr<wire::Participant> radio_, inner_, driver_;
  sensor_msgs::msg::PointCloud2 cloud_;
  std::unique_ptr<agent::Agent> agent_{};
  wire::Writer<nav_msgs::msg::Odometry> odom_{};
  wire::Writer<sensor_msgs::msg::PointCloud2> points_{};
  wire::Writer<geometry_msgs::msg::Twist> wish_{};
  std::unique_ptr<wire::RawReader> reader_{};
  Timer drive_{}, scan_{};
};

/// A station on a strand and a participant of its own.
class TestStation {
 public:
  TestStation(LiveRuntime& runtime, const std::string& name, std::uint8_t id)
      : strand_(runtime.strand(name)), radio_(join(kRadio, false)) {
    station::StationParams params;
    params.name = name;
    params.id[0] = id;
    on(*strand_, [&] {
      station_ = std::make_unique<station::Station>(params, *strand_, *radio_);
      if (const auto started = station_->start(); !started) give_up(started.error().text);
    });
  }
  ~TestStation() {
    on(*strand_, [this] { station_.reset(); });
  }
  /// Whether the command is accepted in time.
  bool ask(const std::string& line, double limit_ms = 1000) {
    const auto code = std::make_shared<std::atomic<int>>(-1);
    strand_->post([this, line, code] {
      station_->execute(line, [code](const station::Outcome& outcome) { *code = outcome.exit_code; });
    });
    return wait_for([&] { return *code >= 0; }, limit_ms) && *code == 0;
  }
  std::size_t blocks() {
    std::size_t blocks = 0;
    on(*strand_, [&] { blocks = station_->map().blocks(); });
    return blocks;
  }

 private:
  std::shared_ptr<Executor> strand_;
  std::unique_ptr<wire::Participant> radio_;
  std::unique_ptr<station::Station> station_{};
};

struct Row {
  const char* name;
  std::size_t points;
  Duration scan_period;
  bool map;
};

void measure(const Row& row, int samples) {
  TestRobot robot(row.points, row.scan_period,
                  row.map ? agent::disk_with_map("r1", kMapBlocks) : std::shared_ptr<store::MemoryDisk>{});
  LiveRuntime runtime;
  TestStation operator_station(runtime, "operator", 1);
  if (!wait_for([&] { return operator_station.ask("take r1"); }, 20e3)) give_up("take was not answered");
  std::unique_ptr<TestStation> late;
  std::size_t received = 0;
  double late_since = 0;
  std::uint8_t lates = 1;
  std::vector<double> times;
  int failed = 0;
  while (static_cast<int>(times.size()) < samples && failed < samples / 4 + 20) {
    if (row.map && now_ms() - late_since > seconds(kLateEvery) * 1e3) {
      if (late) received += late->blocks();
      late.reset();
      ++lates;
      late = std::make_unique<TestStation>(runtime, "late" + std::to_string(lates), lates);
      late_since = now_ms();
    }
    (void)operator_station.ask("reset r1");
    if (!operator_station.ask("mode r1 external") || !wait_for([&] { return robot.moves_.load(); }, 1000)) {
      ++failed;
      continue;
    }
    // At any moment of the beat and of the scans.
    std::this_thread::sleep_for(std::chrono::microseconds(20'000 + 7919 * times.size() % 50'000));
    robot.zero_at_ = 0;
    const double begin = now_ms();
    if (!operator_station.ask("stop r1") || !wait_for([&] { return robot.zero_at_.load() >= begin; }, 1000)) {
      ++failed;
      continue;
    }
    times.push_back(robot.zero_at_ - begin);
  }
  if (late) received += late->blocks();
  std::sort(times.begin(), times.end());
  const auto quantile = [&](double q) {
    return times.empty() ? std::nan("")
                         : times[static_cast<std::size_t>(q * static_cast<double>(times.size() - 1))];
  };
  std::printf("| %s | %zu | %.1f | %.1f | %.1f | %d | %zu |\n", row.name, times.size(), quantile(0.5),
              quantile(0.99), quantile(1.0), failed, received);
  std::fflush(stdout);
}

}  // namespace
}  // namespace adit::bench

int main(int argc, char** argv) {
  using namespace adit::bench;
  CLI::App app{"Time from a stop at the station to zero at the driver, under load."};
  int samples = 200;
  std::string only;
  app.add_option("--samples", samples, "stops of each row");
  app.add_option("--only", only, "the row of this name");
  CLI11_PARSE(app, argc, argv);
  const Row rows[] = {
      {"idle", 1'000, 100ms, false}, {"scans", 262'000, 50ms, false}, {"map", 1'000, 100ms, true}};
  std::printf("| row | stops | p50 ms | p99 ms | max ms | not measured | blocks received late |\n");
  std::printf("| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (const Row& row : rows)
    if (only.empty() || only == row.name) measure(row, samples);
  return 0;
}
