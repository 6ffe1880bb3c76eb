#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace adit::nav {

/// The whole number below: without SSE 4.1, which the build does not assume, std::floor is a call, and this
/// runs for every point.
inline int floor_int(float v) {
  const int i = static_cast<int>(v);
  return i - (v < static_cast<float>(i));
}

struct GroundMapParams {
  double slope{0.35};      ///< steepest ground that is still ground, rise per run, [0, 1]
  double tolerance{0.06};  ///< largest rise from one cell to the next, m, [0.01, 0.5]
  double memory{30.0};     ///< how long a height that is not measured again is kept, s, (0, 600]
};

/// A first height map: the lowest return of each 20 cm cell, in a grid that rolls with the robot in the
/// odometry frame; and from it the ground around the robot, grown outwards from under its feet. A cell's
/// height counts as ground when it follows from its inner neighbours by no more than slope and tolerance;
/// else (a wall, a hole, nothing seen) the cell inherits from them.
class GroundMap {
 public:
  static constexpr float kCell = 0.2f;  ///< m
  static constexpr int kHalf = 24;      ///< the ground is known this many cells around the robot

  explicit GroundMap(const GroundMapParams& params = {});

  void begin_scan(double stamp_s);
  /// A return at (x, y, z) in the odometry frame.
  void add(float x, float y, float z) {
    const int ix = cell(x), iy = cell(y);
    Cell& c = cells_[slot(ix, iy)];
    if (c.ix != ix || c.iy != iy || c.scan != scan_) {
      c = {z, ix, iy, scan_, stamp_};
    } else if (z < c.lowest) {
      c.lowest = z;
    }
  }
  /// Works out the ground around a robot that stands on it at (x, y, z), odometry frame.
  void grow(double x, double y, double z);

  /// Height of the ground at (x, y), odometry frame, m; beyond the known area that of its edge.
  float at(float x, float y) const {
    const int i = std::min(std::max(cell(x) - centre_x_, -kHalf), kHalf) + kHalf;
    const int j = std::min(std::max(cell(y) - centre_y_, -kHalf), kHalf) + kHalf;
    return ground_[i * kSide + j];
  }

 private:
  static constexpr int kTorus = 64;
  static constexpr int kSide = 2 * kHalf + 1;

  struct Cell {
    float lowest{};
    int ix{INT32_MIN};
    int iy{INT32_MIN};
    std::uint32_t scan{};
    double stamp{};
  };
  /// A cell of the area, by offsets from the middle, and the neighbours that are nearer to the middle.
  struct Step {
    int index, dx, dy, inner_a, inner_b;
  };

  static int cell(float v) { return floor_int(v * (1.0f / kCell)); }
  static std::size_t slot(int ix, int iy) {
    return static_cast<std::size_t>((ix & (kTorus - 1)) * kTorus + (iy & (kTorus - 1)));
  }

  GroundMapParams params_;
  std::vector<Cell> cells_;
  std::vector<Step> steps_{};  ///< the area from the middle outwards
  std::vector<float> ground_;
  std::uint32_t scan_{0};
  double stamp_{};
  int centre_x_{}, centre_y_{};
};

}  // namespace adit::nav
