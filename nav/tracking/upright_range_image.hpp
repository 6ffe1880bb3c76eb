// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "nav/geometry/ray.hpp"

namespace adit::nav {

/// Range image of one scan: the nearest return by direction from the sensor, with the vertical axis upright.
/// Bins span about 1.2 degrees of bearing (by the diamond angle) and 0.02 of the elevation's tangent.
///
/// spread() replaces each bin by the minimum of itself and its neighbours. "Saw past that place" then
/// requires that all rays around it went past, so edges, the spacing of the rings and small odometry errors
/// do not count.
class UprightRangeImage {
 public:
  static constexpr int kColumns = 288;
  static constexpr int kRows = 32;
  static constexpr int kBins = kColumns * kRows;

  UprightRangeImage() { clear(); }
  void clear() { bins_.fill(kNothing); }
  /// Index of the bin of a direction (kColumns bins a row); -1: outside of the image.
  static int bin_of(const Ray& ray) {
    const int row = row_of(ray.tangent);
    return row < 0 || row >= kRows ? -1 : row * kColumns + column_of(ray.bearing);
  }
  /// Adds a return at `range` (m) to a bin; 1: it is the nearest one there so far, else 0. By arithmetic: a
  /// branch would be mispredicted for every third return.
  int add(int bin, float range) {
    const float centimetres = range * 100.0f;
    const int value = centimetres < 65000.0f ? static_cast<int>(centimetres) : kFar;
    const int before = bins_[bin], closer = value - before;
    const auto nearer = static_cast<int>(static_cast<unsigned>(closer) >> 31);  // Its sign.
    bins_[bin] = static_cast<std::uint16_t>(before + nearer * closer);
    return nearer;
  }
  /// The same for a return in any direction. Gives the index of its bin if it is the nearest one there so
  /// far, else -1.
  int add(const Ray& ray) {
    const int bin = bin_of(ray);
    return bin >= 0 && add(bin, ray.range) == 1 ? bin : -1;
  }
  /// Whether a bin has a return; valid before spread() only.
  bool filled(int bin) const { return bins_[bin] != kNothing; }
  /// Replaces each bin by the minimum of its neighbourhood. Call it once, after the last add().
  void spread();
  /// Whether rays passed the place at the end of `ray` by at least `beyond` metres. Bins without a return
  /// prove nothing: false.
  bool saw_past(const Ray& ray, float beyond) const {
    const int at = bin_of(ray);
    if (at < 0) return false;
    const std::uint16_t bin = bins_[at];
    return bin != kNothing && bin > (ray.range + beyond) * 100.0f;
  }
  static int column_of(float bearing) {
    const int column = static_cast<int>((bearing + 1.0f) * (kColumns / 4));
    return column < kColumns ? column : 0;
  }

 private:
  static constexpr std::uint16_t kNothing = 0xffff;
  static constexpr std::uint16_t kFar = 0xfffe;
  static int row_of(float tangent) { return static_cast<int>(tangent * 50.0f + 116.5f) - 100; }

  std::array<std::uint16_t, kBins> bins_;
};

}  // namespace adit::nav
