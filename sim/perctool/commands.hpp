// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core/geometry/pose.hpp"
#include "sim/perctool/sensor_log.hpp"

/// What perctool does; each gives the exit status: 0 done, 1 it did not converge or was lost, 2 something
/// cannot be read.
namespace adit::sim::perctool {

struct EvalOptions {
  std::string truth{}, estimate{};  ///< TUM files.
  bool align{false};
  double max_diff{0.01};  ///< s
  double delta{1.0};      ///< Between the poses of a relative error; see `unit`.
  std::string unit{"f"};  ///< Of `delta`: f (poses) or m.
  bool json{false};
};
int eval(const EvalOptions& options);

struct OdometryOptions {
  SensorLogOptions log{};
  std::string sensor{};  ///< File with the `sensors:` part of a platform's; empty: poses are of the lidar.
  std::string out{};     ///< TUM file.
  std::string truth{};   ///< TUM file for the true poses of an MCAP; empty: none.
  bool json{false};
};
int odometry(const OdometryOptions& options);

struct MapOptions {
  std::string clouds{}, poses{};  ///< File or folder; TUM, one pose a cloud.
  std::string sensor{};           ///< As of `odometry`.
  std::string out{};              ///< .bt, .ot, .pcd or .ply.
  double resolution{0.1};         ///< m, [0.01, 1]
  double range{20.0};             ///< Of each cloud, m.
  bool json{false};
};
int map(const MapOptions& options);

struct AlignOptions {
  std::string target{}, source{};
  Pose3 guess{};  ///< T_target_source.
  bool json{false};
};
int align(const AlignOptions& options);

struct StairsOptions {
  std::string clouds{};  ///< File or folder, in base_link: level, the ground under the robot near z = 0.
  std::string poses{};   ///< TUM, one a cloud; then the clouds are accumulated. Empty: each is judged alone.
  std::string sensor{};  ///< As of `odometry`: where the lidar was.
  double eye{0.6};       ///< Height of the lidar without `sensor`, m.
  bool json{false};
};
int stairs(const StairsOptions& options);

struct RecordOptions {
  std::string scenario{}, robot{}, out{};
  std::optional<std::uint64_t> seed{};  ///< Else the scenario's.
};
int record(const RecordOptions& options);

struct DiffOptions {
  std::string a{}, b{};  ///< OctoMap files.
  bool json{false};
};
int diff(const DiffOptions& options);

}  // namespace adit::sim::perctool
