// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace adit {

/// A seeded generator (splitmix64, Steele et al. 2014), the only source of randomness of a component. The
/// same seed gives the same sequence on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// Uniform over all 64-bit values.
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in [0, n); n > 0.
  std::uint64_t below(std::uint64_t n) { return next() % n; }
  bool chance(double probability) { return uniform() < probability; }
  /// Returns an independent generator for a named part, so that the draws of one part never affect another.
  Random fork(std::uint64_t salt) { return Random(next() ^ (salt * 0xd1342543de82ef95ULL)); }

 private:
  std::uint64_t state_;
};

}  // namespace adit
