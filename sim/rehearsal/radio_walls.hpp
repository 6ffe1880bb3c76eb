// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <map>

#include "core/wire/link.hpp"
#include "sim/world/world.hpp"

namespace adit::sim {

/// What the world's walls take from a radio between two machines: so many dB a metre of what is solid on the
/// straight way. Remembers what it found by cells of a quarter of a metre; bounded. Not for several threads.
class RadioWalls {
 public:
  static constexpr double kAntenna = 0.5;           ///< Height of the antenna above the machine's place, m.
  static constexpr double kMaxAttenuation = 300.0;  ///< Attenuation limit, dB; more makes no difference.
  static constexpr double kCell = 0.25;             ///< m
  static constexpr std::size_t kMaxPairs = 4096;    ///< Bound on stored pairs of cells.

  /// `per_metre`: dB, > 0. The world must outlive it.
  RadioWalls(const World& world, double per_metre) : world_(world), per_metre_(per_metre) {}

  /// Attenuation between two machines' places (m), dB; symmetric.
  double operator()(const wire::Position& a, const wire::Position& b);

 private:
  const World& world_;
  double per_metre_;
  std::map<std::array<int, 6>, double> known_{};
};

}  // namespace adit::sim
