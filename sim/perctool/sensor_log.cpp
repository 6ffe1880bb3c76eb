// SPDX-License-Identifier: Apache-2.0
#include "sim/perctool/sensor_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

namespace adit::sim::perctool {
namespace {

constexpr double kBeside = 1.0;     ///< Motion so long before or after the clouds is of them, too, s.
constexpr double kSince1970 = 1e9;  ///< Later stamps count from 1970, s.
constexpr double kLatest = 9e9;     ///< Stamps are ns in 64 bits.

std::uint64_t stamp_of(double seconds) {
  return kLogStart + static_cast<std::uint64_t>(std::llround(seconds * 1e9));
}

/// Seven numbers with commas between them.
bool parse_numbers(const std::string& line, std::array<double, 7>& out) {
  const char *at = line.data(), *end = line.data() + line.size();
  for (std::size_t n = 0; n < out.size(); ++n) {
    while (at != end && *at == ' ') ++at;
    const auto [rest, error] = std::from_chars(at, end, out[n]);
    if (error != std::errc{} || !std::isfinite(out[n])) return false;
    at = rest;
    while (at != end && (*at == ' ' || *at == '\r')) ++at;
    if (n + 1 < out.size() && (at == end || *at++ != ',')) return false;
  }
  return at == end;
}

/// Motion that is given must lie in the time of the clouds; otherwise none of it would be used, without a
/// word.
Result<void> in_the_time_of_clouds(const std::string& file, double first, double last, double end) {
  if (last >= -kBeside && first <= end + kBeside) return {};
  return {Reason::out_of_range,
          fmt::format(
              "{}: its stamps go from {:.3f} to {:.3f} s, those of the clouds from 0 to {:.3f} s, so that "
              "nothing of it would be used; stamps count from the first cloud{}",
              file, first, last, end, first > kSince1970 ? ": subtract its time since 1970 from each" : "")};
}

Result<void> play_folder(const SensorLogOptions& options, SensorSink& sink) {
  const auto files = cloud_files(options.clouds);
  if (!files) return files.error();
  std::vector<perception::ImuSample> imu;
  std::vector<StampedPose> wheels;
  if (!options.imu.empty()) {
    auto read = read_imu_csv(options.imu);
    if (!read) return read.error();
    imu = std::move(*read);
  }
  if (!options.wheels.empty()) {
    auto read = read_tum(options.wheels);
    if (!read) return read.error();
    wheels = std::move(*read);
  }
  const double length = static_cast<double>(files->size()) / options.rate;
  const auto since_start = [](std::uint64_t stamp) {
    return static_cast<double>(static_cast<std::int64_t>(stamp - kLogStart)) * 1e-9;
  };
  if (!imu.empty())
    if (const auto fits = in_the_time_of_clouds(options.imu, since_start(imu.front().stamp),
                                                since_start(imu.back().stamp), length);
        !fits)
      return fits;
  if (!wheels.empty())
    if (const auto fits =
            in_the_time_of_clouds(options.wheels, wheels.front().stamp_s, wheels.back().stamp_s, length);
        !fits)
      return fits;
  constexpr double kLead = 0.05;  // s: motion that comes with a sweep, beyond its end
  const double period = 1.0 / options.rate;
  std::size_t i = 0, w = 0;
  const auto motion_until = [&](double end) {
    for (; i < imu.size() && imu[i].stamp <= stamp_of(end); ++i) sink.on_imu(imu[i]);
    for (; w < wheels.size() && wheels[w].stamp_s <= end; ++w)
      sink.on_wheels({stamp_of(wheels[w].stamp_s), wheels[w].pose});
  };
  for (std::size_t n = 0; n < files->size(); ++n) {
    auto cloud = read_cloud_file((*files)[n], period);
    if (!cloud) return cloud.error();
    const double at = static_cast<double>(n) * period;
    cloud->sweep.stamp = stamp_of(at);
    motion_until(at + (cloud->sweep.timed ? period : 0.0) + kLead);
    if (auto taken = sink.on_sweep(std::move(cloud->sweep)); !taken) return taken;
  }
  motion_until(static_cast<double>(files->size()) * period + 1.0);
  return {};
}

}  // namespace

Result<std::vector<perception::ImuSample>> read_imu_csv(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) return {Reason::cannot_read, file.string() + ": cannot be read"};
  std::vector<perception::ImuSample> out;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.empty() || line[0] == '#') continue;
    std::array<double, 7> v{};
    const bool header = number == 1 && std::isalpha(static_cast<unsigned char>(line[0]));
    if (header) continue;
    if (!parse_numbers(line, v) || v[0] < -1e6 || v[0] > kLatest)
      return {Reason::syntax,
              fmt::format("{}:{}: expected stamp_s,gx,gy,gz,ax,ay,az", file.string(), number)};
    if (!out.empty() && stamp_of(v[0]) < out.back().stamp)
      return {Reason::syntax, fmt::format("{}:{}: the stamp is before the last one", file.string(), number)};
    if (v[0] >= -1e2) out.push_back({stamp_of(v[0]), {v[1], v[2], v[3]}, {v[4], v[5], v[6]}});
  }
  return out;
}

bool is_mcap(const std::string& file) { return file.ends_with(".mcap"); }

Result<void> play_log(const SensorLogOptions& options, SensorSink& sink) {
  if (!is_mcap(options.clouds)) return play_folder(options, sink);
  if (!options.imu.empty() || !options.wheels.empty())
    return {Reason::bad_argument, options.clouds + " has its own IMU and wheels"};
  return play_mcap(options.clouds, sink);
}

}  // namespace adit::sim::perctool
