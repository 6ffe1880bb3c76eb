// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "perception/map/block.hpp"

/// Occupancy of a voxel in one byte: OctoMap's model (A. Hornung et al. 2013) with its default probabilities,
/// hit 0.7, miss 0.4, clamped to 0.12 and 0.97. One step is 0.0368 of log-odds, the scale below 127 steps at
/// which hit (23.00) and miss (11.00) are nearest to whole numbers, so that sums of both have the sign that
/// OctoMap's have.
namespace adit::perception::log_odds {

constexpr int kHit = 23, kMiss = 11, kMin = -54, kMax = 95;

/// Stored values: 0 is unknown; v > 0 are log-odds of v - kZero steps.
constexpr int kZero = 1 - kMin;
constexpr std::uint8_t kUnknown = 0;
constexpr std::uint8_t kSurelyFree = kMin + kZero;      ///< 1
constexpr std::uint8_t kLeastOccupied = kZero;          ///< As OctoMap: log-odds of 0 are occupied.
constexpr std::uint8_t kSurelyOccupied = kMax + kZero;  ///

constexpr Voxel classify(std::uint8_t value) {
  return value == kUnknown ? Voxel::unknown : value >= kLeastOccupied ? Voxel::occupied : Voxel::free;
}

/// Sixteen voxels at once, in the compiler's portable vectors.
using Lanes [[gnu::vector_size(16)]] = std::uint8_t;

inline Lanes splat(int value) { return Lanes{} + static_cast<std::uint8_t>(value); }

/// Sets lane i to 0xff where bit i is set.
inline Lanes spread(std::uint64_t bits) {
  constexpr std::uint64_t kRepeat = 0x0101010101010101u, kDiagonal = 0x8040201008040201u;
  const std::uint64_t halves[2]{(bits & 0xffu) * kRepeat & kDiagonal,
                                (bits >> 8 & 0xffu) * kRepeat & kDiagonal};
  Lanes lanes;
  std::memcpy(&lanes, halves, sizeof lanes);
  return reinterpret_cast<Lanes>(lanes != Lanes{});
}

/// Values after a hit where `hit` is set and a miss where `miss` is; no lane has both.
inline Lanes update(Lanes old, Lanes hit, Lanes miss) {
  const Lanes unknown = reinterpret_cast<Lanes>(old == Lanes{});
  const Lanes known = old | (unknown & splat(kZero));
  const Lanes capped = known < splat(kSurelyOccupied - kHit) ? known : splat(kSurelyOccupied - kHit);
  const Lanes floored = known > splat(kSurelyFree + kMiss) ? known : splat(kSurelyFree + kMiss);
  return ((capped + splat(kHit)) & hit) | ((floored - splat(kMiss)) & miss) | (old & ~(hit | miss));
}

}  // namespace adit::perception::log_odds
