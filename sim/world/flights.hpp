// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/geometry/staircase.hpp"
#include "sim/world/generate.hpp"

namespace adit::sim {

/// Three flights with landings between them, in three lanes beside each other, up to a room on an upper
/// floor. World frame, m.
///
///     y 12 |  hall on the lower floor      | upper floor | room |
///          |     ________________________  |             |      |
///       6  |    | landing 2  << flight 3 >> corridor     |      |
///          |    |            << flight 2   | landing 1 |_|______|
///       0  |      hall          flight 1 >>|           |
///        x 0    10           12            15       16  18      24
struct FlightsWorld {
  GeneratedWorld world{};
  std::array<Staircase, 3> stairs{};     ///< The truth, from below; the standard deviations are 0.
  Eigen::Vector3d room{20.0, 8.0, 4.8};  ///< A free place in the room on the upper floor.
  Eigen::Vector2d hall{6.0, 9.0};        ///< A free place in the hall.
  bool ramp{};                           ///< Whether a ramp leads to the upper floor, too.
};

/// Seeds vary the rise (0.145 to 0.178 m), the run (0.25 or 0.30 m: columns of a world are 0.05 m wide), the
/// width of the lanes (1.2 to 1.9 m) and the number of steps of each flight. Worlds of even seeds have a ramp
/// of 24 % along the far side of the hall, which wheeled platforms take.
FlightsWorld generate_flights(std::uint64_t seed);

}  // namespace adit::sim
