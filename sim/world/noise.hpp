// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/time/random.hpp"

namespace adit::sim {

/// Mean 0, deviation 1, never beyond 3.5: the sum of four 16-bit uniforms (Irwin-Hall). It costs one draw and
/// calls nothing of the mathematics library, whose last digit differs between machines.
inline double gaussian(Random& random) {
  const std::uint64_t z = random.next();
  const std::uint64_t sum = (z & 0xffff) + (z >> 16 & 0xffff) + (z >> 32 & 0xffff) + (z >> 48);
  constexpr double scale = 1.7320508075688772 / 65536.0;
  return (static_cast<double>(sum) - 2.0 * 65535.0) * scale;
}

/// The seed of the generator number `part`, independent of that of any other part.
inline std::uint64_t derive_seed(std::uint64_t seed, std::uint64_t part) {
  return Random(seed).fork(part).next();
}

}  // namespace adit::sim
