// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/lidar.hpp"

namespace adit::sim {

/// One return of a sweep, in the lidar's own frame, laid out as drivers send it.
struct SweepPoint {
  float x{}, y{}, z{};     ///< m
  float intensity{};       ///< Reflectivity, [0, 255].
  float t{};               ///< Time since the sweep's begin, s.
  std::uint16_t ring{};    ///< Beam, 0 is the lowest; of a rosette: the laser, 0 to 3.
  std::uint16_t unused{};  ///< Keeps the layout free of holes.
  Eigen::Vector3f position() const { return {x, y, z}; }
};
static_assert(sizeof(SweepPoint) == 24);

/// How wrong a lidar is, beyond its range noise.
struct LidarErrors {
  double noise{1.0};       ///< Scale of all errors, also of the range noise; 0 is the truth.
  double bias{0.0};        ///< Of every range, m.
  double mixed{0.05};      ///< Share of the beams on an edge that see both sides at once, [0, 1].
  double dropouts{0.003};  ///< Share of the beams without return on bright ground, [0, 1].
  /// Ranges deviate up to this many times more on surfaces far away or seen at a grazing angle.
  double grazing{2.5};
  /// Share of the beams that meet a dust particle, [0, 0.5]: it takes the place of a farther return, or of
  /// none.
  double dust{0.0};
};

/// Time that the points of a lost column state: 0, NaN, nearly 2^32 ns (a negative offset that wrapped), or
/// their own.
enum class LostTime { zero, nan, wrapped, kept };

/// By LostTime, as they are written in a scenario.
const std::vector<std::string>& lost_time_words();

/// Columns of a sweep whose packets were lost: their points have no return, all coordinates are 0.
struct ColumnLoss {
  double share{};  ///< Of the columns, [0, 1].
  LostTime time{LostTime::zero};
  bool operator==(const ColumnLoss&) const = default;
};

/// All that one sweep of a lidar depends on, by value: trace() may run on another thread, later.
struct SweepJob {
  std::shared_ptr<const World> world{};
  std::shared_ptr<const LidarPattern> lidar{};
  LidarErrors errors{};
  /// True poses of the lidar, at least two, at equal intervals from the sweep's begin to its end.
  std::vector<Pose3> T_world_lidar{};
  std::vector<std::vector<BodyBox>> others{};  ///< In each interval.
  double duration{};                           ///< Of the sweep, s.
  std::uint64_t seed{};
  std::optional<ColumnLoss> loss{};
  bool covered{};  ///< Something lies on the lidar: every beam returns within kCover.

  static constexpr double kCover = 0.3;  ///< m
  /// Traces each column from the pose at its own time; it begins behind and turns counter-clockwise. At most
  /// lidar->size() points, column by column, in each from the lowest beam up; beams without return are left
  /// out, but for those of lost columns.
  std::vector<SweepPoint> trace() const;
};

}  // namespace adit::sim
