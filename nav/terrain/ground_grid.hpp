// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "nav/terrain/ray_image.hpp"

namespace adit::nav {

struct GroundParams {
  float slope{0.35f};   ///< steepest ground, rise per run, [0, 1.5]
  float rise{0.06f};    ///< largest rise from one cell to the next, m, [0.01, 0.5]
  float drop{0.2f};     ///< ground that falls by more is none, m, [0.05, 2]
  float most{0.35f};    ///< above the ground before it a first return may be ground, m: a wall that one level
                        ///< ring sees is none, (0, 5]
  float memory{60.0f};  ///< how long a height that is not measured again is kept, s, (0, 600]
};

/// Heights of the ground around the robot, in 10 cm cells of a grid that rolls with it. The lowest return of
/// each cell is its height, averaged over scans; from the robot's feet the ground is grown outwards: a cell's
/// height is ground when it follows from its inner neighbours, and from how the body leans, by no more than
/// slope, rise and drop allow; else (a wall, a hole, nothing seen) the cell inherits from them.
///
/// Heights are those of a map of its own: where odometry does not know its height (wheels) or drifts in it,
/// the map goes along, by the median of what the scan and the map disagree about (the drift compensation of
/// P. Fankhauser et al., *Probabilistic terrain mapping for mobile robots with uncertain localization*, 2018,
/// made simple).
class GroundGrid {
 public:
  static constexpr float kCell = 0.1f;         ///< m
  static constexpr int kHalf = 48;             ///< known this many cells around the robot
  static constexpr int kSide = 2 * kHalf + 1;  ///< of the window
  static constexpr int kTorus = 128;           ///< more than a window
  static constexpr int kKept =
      kTorus / 2 - 1;                          ///< what was measured is kept this many cells around the robot
  static constexpr std::uint8_t kNever = 200;  ///< gap of a cell with no measured one on the way to it

  explicit GroundGrid(const GroundParams& params = {});
  void clear();

  /// Begins a scan of a robot at (x, y), `now` seconds after some start, not decreasing.
  void begin_scan(float x, float y, float now);
  /// A return at (x, y, z), within 4.7 m of the robot.
  void add(float x, float y, float z) {
    float& low = low_[slot(cell(x), cell(y))];
    low = z < low ? z : low;
  }
  /// How much higher than its returns say the scan lies in the map, m: to be added to all of them.
  float disagreement();
  /// Takes the scan's heights, raised by `lift`, and works out the ground around a robot that stands at
  /// height `z`, leaning by `tilt` (rise per metre along x and y).
  void grow(float lift, float z, const Eigen::Vector2f& tilt);

  /// Height of the ground at (x, y), m; beyond the window that of its edge.
  float at(float x, float y) const { return ground_[static_cast<std::size_t>(window(x, y))]; }
  /// The same, but no higher than slope leads to from the cells before it: what a robot has to climb from.
  float before(float x, float y) const { return floor_[static_cast<std::size_t>(window(x, y))]; }
  /// Whether the ground was measured in the cell of (x, y): is not inherited.
  bool measured(float x, float y) const { return gap_[static_cast<std::size_t>(window(x, y))] == 0; }

  // By index in the window: kSide columns along y for each step along x.
  float height(int index) const { return ground_[static_cast<std::size_t>(index)]; }
  bool measured(int index) const { return gap_[static_cast<std::size_t>(index)] == 0; }
  /// Measured by the newest scan.
  bool fresh(int index) const { return fresh_[static_cast<std::size_t>(index)] != 0; }
  const std::uint8_t* gaps() const { return gap_.data(); }
  const float* heights() const { return ground_.data(); }
  /// The nearest cell of the window.
  int window(float x, float y) const {
    const int i = std::min(std::max(cell(x) - centre_x_, -kHalf), kHalf) + kHalf;
    const int j = std::min(std::max(cell(y) - centre_y_, -kHalf), kHalf) + kHalf;
    return i * kSide + j;
  }
  Eigen::Vector2f middle(int index) const {
    return {(static_cast<float>(centre_x_ + index / kSide - kHalf) + 0.5f) * kCell,
            (static_cast<float>(centre_y_ + index % kSide - kHalf) + 0.5f) * kCell};
  }
  /// Where a cell of the window is kept as long as it stays in it: an index below kTorus * kTorus.
  std::size_t place(int index) const {
    return slot(centre_x_ + index / kSide - kHalf, centre_y_ + index % kSide - kHalf);
  }
  /// Calls `forget(place)` for each cell that came into the window with this scan.
  template <class Forget>
  void entered(const Forget& forget) const {
    for (const std::size_t place : entered_) forget(place);
  }

 private:
  /// A cell of the window and the two before it on the way outwards.
  struct Step {
    std::uint16_t index, inner_a, inner_b;
    std::int8_t dx, dy;
    std::int8_t from_a_x, from_a_y, from_b_x, from_b_y;  ///< the way from those two
  };
  static constexpr float kNothing = 1e9f;

  static int cell(float v) { return floor_int(v * (1.0f / kCell)); }
  static std::size_t slot(int ix, int iy) {
    return static_cast<std::size_t>(((ix & (kTorus - 1)) * kTorus) | (iy & (kTorus - 1)));
  }
  void roll(int x, int y);

  GroundParams params_;
  std::vector<Step> steps_{};  ///< the window from the middle outwards
  /// Allowed where the last measured cell is so many away: as ground to climb, to fall, and by slope alone.
  std::array<float, 256> rise_{}, fall_{}, climb_{};
  // On the torus.
  std::vector<float> low_;     ///< of this scan
  std::vector<float> height_;  ///< of the map
  std::vector<float> stamp_;   ///< measured last
  std::vector<std::uint8_t> is_ground_;
  // In the window.
  std::vector<float> ground_, floor_;
  std::vector<std::uint8_t> gap_, fresh_;
  std::vector<float> differences_{};
  std::vector<std::size_t> entered_{};
  int centre_x_{}, centre_y_{};
  bool placed_{false};
  float now_{};
};

}  // namespace adit::nav
