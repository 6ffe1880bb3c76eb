#pragma once
#include <cstdint>

namespace adit::sim {

/// A small seeded generator: splitmix64 (Steele, Lea and Flood, 2014). The same seed gives the same numbers
/// on every machine and thread.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  /// Mean 0, deviation 1, never beyond 3.5: the sum of four 16-bit uniforms (Irwin-Hall), which costs one
  /// draw and calls nothing of the mathematics library.
  double gaussian() {
    const std::uint64_t z = next();
    const std::uint64_t sum = (z & 0xffff) + (z >> 16 & 0xffff) + (z >> 32 & 0xffff) + (z >> 48);
    constexpr double scale = 1.7320508075688772 / 65536.0;
    return (static_cast<double>(sum) - 2.0 * 65535.0) * scale;
  }

 private:
  std::uint64_t state_;
};

/// A seed for the `b`-th of independent generators that all derive from `a`.
inline std::uint64_t derive_seed(std::uint64_t a, std::uint64_t b) {
  Random random(a ^ (b * 0xd1342543de82ef95u + 0x2545f4914f6cdd1du));
  random.next();
  return random.next();
}

}  // namespace adit::sim
