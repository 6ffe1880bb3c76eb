// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "core/result/result.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {

/// A world to try navigation in: boxes for make_box_world on a floor at 0, closed by walls all around, with
/// free ground around `start`. Metres.
struct GeneratedWorld {
  std::vector<Box> boxes{};
  Eigen::Vector2d start{0.0, 0.0};  ///< Free for 1 m around.
  Eigen::Vector2d size{0.0, 0.0};   ///< Inner size, from (0, 0), m.
  double ceiling{3.0};              ///< For make_box_world, m.
};

/// Every kind, in the order of the documentation (docs/rehearsal.md).
std::span<const std::string_view> world_kinds();
/// Those of them that try navigation anywhere: all but `flights`, and `tunnel` and `loop`, which try
/// perception.
std::span<const std::string_view> navigation_kinds();

/// The world of that kind; the same seed gives the same world on every machine. Reason::bad_argument for a
/// kind that is none of world_kinds().
Result<GeneratedWorld> generate_world(std::string_view kind, std::uint64_t seed);

constexpr int kShortestTunnel = 20, kLongestTunnel = 300, kUsualTunnel = 120;  ///< m

/// A smooth tunnel along x, `length` m long ([kShortestTunnel, kLongestTunnel]) and 3 m wide and high, with
/// closed ends and nothing in it: along it a lidar sees no motion.
GeneratedWorld generate_tunnel(int length);

constexpr int kLeastBlocks = 2, kMostBlocks = 9;

/// `size` x `size` blocks of 8 m ([kLeastBlocks, kMostBlocks]) with streets of 3.2 m between and around them,
/// in which ten boxes of 0.5 m stand, 0.9 m high. Seed 0 has the boxes of the worlds that TARE was measured
/// in, where there is one of that size (3 and 5; docs/references.md); others are drawn.
GeneratedWorld generate_blocks(int size, std::uint64_t seed);

}  // namespace adit::sim
