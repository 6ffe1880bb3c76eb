// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/program/check.hpp"

#include <algorithm>
#include <condition_variable>
#include <fstream>
#include <iostream>
#include <mutex>

#include "core/exec/live_runtime.hpp"
#include "core/wire/component_io.hpp"
#include "robot_agent/check/sensor_check.hpp"

namespace adit::agent {
namespace {

int failed(const Error& error) {
  std::cerr << "robot_agent: " << error.text << "\n";
  return 2;
}

std::uint64_t largest_buffer() {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  std::uint64_t bytes = 0;
  file >> bytes;
  return bytes;
}

/// Lets one thread wait for another one.
class Gate {
 public:
  void open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void wait(Duration limit) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, limit, [this] { return open_; });
  }

 private:
  std::mutex mutex_{};
  std::condition_variable changed_{};
  bool open_{false};
};

}  // namespace

int check_sensors(const RobotConfig& config, const wire::FastDdsParams& robot, const CheckParams& params) {
  auto lines = ConfigLines::load(params.file);
  if (!lines) return failed(lines.error());
  wire::FastDdsParams named = robot;
  named.name += "-check";
  auto wire = wire::open_fastdds(named);
  if (!wire) return failed(wire.error());
  SensorCheck check(config.platform, std::move(*lines));
  Gate never, begun, turned, reported;  // They outlive the strand.
  std::vector<CheckLine> report;
  const bool turn = params.turning > Duration::zero() && config.platform.imu.has_value();
  {
    LiveRuntime runtime;
    const auto strand = runtime.strand("check");
    const wire::ComponentIo io{**wire, *strand, nullptr};
    auto readers = read_sensors(
        io, config.platform, [&check] { return &check; }, std::make_shared<OneSource>());
    if (!readers) return failed(readers.error());
    std::unique_ptr<wire::RawReader> battery;
    if (const auto opened =
            io.open(battery, wire::topics::kBattery,
                    [&check](const sensor_msgs::msg::BatteryState& sample, const wire::SampleInfo& info) {
                      check.take(sample, info.sender);
                    });
        !opened)
      return failed(opened.error());
    std::cout << "Leave the robot standing on level ground for " << seconds(params.standing) << " s.\n"
              << std::flush;
    never.wait(params.standing);
    Timer watch;
    if (turn) {
      std::cout << "Now turn it on the spot, a quarter turn or more, by its own remote control, within "
                << seconds(params.turning) << " s.\n"
                << std::flush;
      strand->post([&] {
        check.begin_turn();
        watch = strand->every(50ms, [&] {
          if (check.turned()) turned.open();
        });
        begun.open();
      });
      begun.wait(1s);
      turned.wait(params.turning);
    }
    strand->post([&] {
      watch = {};
      check.look(**wire, config.velocity);
      report = check.report(turn);
      reported.open();
    });
    reported.wait(2s);
  }
  report.push_back(judge_buffer(largest_buffer()));
  std::cout << to_text(report) << std::flush;
  const bool all = std::all_of(report.begin(), report.end(), [](const CheckLine& line) { return line.ok; });
  return all ? 0 : 1;
}

}  // namespace adit::agent
