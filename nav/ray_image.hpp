#pragma once
#include <cstdint>
#include <vector>

namespace adit::nav {

/// How far one scan saw in each direction, from the sensor and with the vertical upright: what it saw
/// through is free. Directions are binned by a bearing that needs no trigonometry (the "diamond angle") and
/// by the tangent of the elevation; a bin keeps its shortest range, so that a ray which ended near wins over
/// one that slipped past.
class RayImage {
 public:
  RayImage();
  void clear();

  /// A return at (dx, dy, dz) from the sensor; `range` is its horizontal distance. All in metres.
  void add(float dx, float dy, float dz, float range) {
    const float tangent = dz / range;
    if (tangent < lowest_) lowest_ = tangent;
    const int row = row_of(tangent);
    if (row < 0 || row >= kRows) return;
    std::uint16_t& bin = bins_[row * kColumns + column_of(dx, dy)];
    const float centimetres = range * 100.0f;
    const auto value = centimetres < 65000.0f ? static_cast<std::uint16_t>(centimetres) : kFar;
    if (value < bin) bin = value;
  }

  /// Whether a ray went through the upright line at (dx, dy) between the heights z_low and z_high (from the
  /// sensor), at `range`, and at least `beyond` metres further.
  bool saw_through(float dx, float dy, float z_low, float z_high, float range, float beyond) const;

  /// The tangent of the lowest ray of this scan: what stands lower at some range cannot be seen there.
  float lowest() const { return lowest_; }

 private:
  static constexpr int kColumns = 256;
  static constexpr int kRows = 100;
  static constexpr std::uint16_t kEmpty = 0xffff;
  static constexpr std::uint16_t kFar = 0xfffe;

  static int row_of(float tangent) { return static_cast<int>(tangent * 50.0f + 50.5f); }  // 0.02 a row
  static int column_of(float dx, float dy) {
    const float ax = dx < 0 ? -dx : dx, ay = dy < 0 ? -dy : dy;
    const float t = dy / (ax + ay);            // -1 .. 1
    const float turn = dx < 0 ? 2.0f - t : t;  // -1 .. 3, monotone in the bearing
    return static_cast<int>(turn * (kColumns / 4) + kColumns) & (kColumns - 1);
  }

  std::vector<std::uint16_t> bins_;
  float lowest_{};
};

}  // namespace adit::nav
