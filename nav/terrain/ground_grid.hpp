// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "nav/terrain/plane_fit.hpp"
#include "nav/terrain/ray_image.hpp"

namespace adit::nav {

struct GroundParams {
  float sigma_tilt{0.035f};  ///< standard deviation of the body's attitude, rad
  float slope{0.35f};        ///< steepest ground, rise per run, [0, 1.5]
  float rise{0.06f};         ///< largest rise from one cell to the next, m, [0.01, 0.5]
  float drop{0.2f};          ///< ground that falls by more is none, m, [0.05, 2]
  float sure{2.3f};     ///< rays that meet the ground nearer than this are steep and dense enough to tell an
                        ///< edge from a ramp; farther away it may fall by slope from one ring to the next, m
  float rings{0.035f};  ///< angle between two rings of the lidar, rad
  float range{4.5f};    ///< known this far around the robot, m, [1, 25]
  float most{0.35f};    ///< above the ground before it a first return may be ground, m: a wall that one level
                        ///< ring sees is none, (0, 5]
  float memory{60.0f};  ///< how long a height that is not measured again is kept, s, (0, 600]
};

/// Heights of the ground around the robot, in 10 cm cells of a grid that rolls with it. The lowest return of
/// each cell is its height, averaged over scans; from the robot's feet the ground is grown outwards: a cell's
/// height is ground when it follows from its inner neighbours, and from how the body leans, by no more than
/// slope, rise and drop allow; else (a wall, a hole, nothing seen) the cell inherits from them.
///
/// Around the robot the lidar sees no ground, and an error of the body's attitude grows with the distance to
/// the first ring. So the plane of the ground is fitted to what is known around the robot, with the body's
/// attitude as the prior: where nothing was measured the ground goes on like this plane, and until a first
/// cell is accepted the tolerance grows with the distance, by what is left of the plane's uncertainty.
///
/// Heights are those of a map of its own: where odometry does not know its height (wheels), drifts in it or
/// leans other than the body, the scan is registered to the map in height, roll and pitch, by a robust fit to
/// the heights' differences (after the drift compensation of P. Fankhauser et al., *Probabilistic terrain
/// mapping for mobile robots with uncertain localization*, 2018).
class GroundGrid {
 public:
  static constexpr float kCell = 0.1f;         ///< m
  static constexpr std::uint8_t kNever = 200;  ///< gap of a cell with no measured one on the way to it

  /// How a scan lies beside the map: to be added to its heights, from the robot's place on.
  struct Offset {
    float height{0};                 ///< m
    Eigen::Vector2f gradient{0, 0};  ///< rise per metre along x and y
    float sigma_gradient{0};         ///< of the gradient in its worse direction
    bool none() const { return height == 0.0f && gradient.isZero(0); }
  };

  explicit GroundGrid(const GroundParams& params = {});
  void clear();

  /// Begins a scan of a robot at (x, y), `now` seconds after some start, not decreasing.
  void begin_scan(float x, float y, float now);
  /// A return at (x, y, z), within range of the robot.
  void add(float x, float y, float z) {
    const std::size_t s = slot(cell(x), cell(y));
    low_[s] = z < low_[s] ? z : low_[s];
    high_[s] = z > high_[s] ? z : high_[s];
  }
  /// How the scan lies beside the map; nothing when too little of both is known.
  Offset disagreement();
  /// Takes the scan's heights, moved by `offset`, and works out the ground around a robot that stands at
  /// height `z`, leaning by `tilt` (rise per metre along x and y), with a lidar `lidar` metres above it.
  /// `blind`: horizontal distance to where the lowest ray meets level ground, m.
  void grow(const Offset& offset, float z, const Eigen::Vector2f& tilt, float lidar, float blind);
  /// The plane of the ground around the robot, in the last grow(); its height is that under the robot.
  const PlaneFit& plane() const { return plane_; }
  /// How far a place lies below that plane for certain, m: beyond the piece that it was fitted to the ground
  /// bends away from it.
  float below_plane(const Eigen::Vector3f& p) const;
  /// Whether there was one since the last clear().
  bool grown() const { return grown_; }

  /// Height of the ground at (x, y), m; beyond the window that of its edge.
  float at(float x, float y) const { return ground_[static_cast<std::size_t>(window(x, y))]; }
  /// The same, but no higher than slope leads to from the cells before it: what a robot has to climb from.
  float before(float x, float y) const { return floor_[static_cast<std::size_t>(window(x, y))]; }
  /// A return at (x, y) that lies lower than at() by more than this shows that the ground is missing, m.
  float drop_limit(int index) const {
    return limit_[static_cast<std::size_t>(gap_[static_cast<std::size_t>(index)])];
  }
  /// Whether the ground was measured in the cell of (x, y): is not inherited.
  bool measured(float x, float y) const { return gap_[static_cast<std::size_t>(window(x, y))] == 0; }

  /// Cells of the window along each axis; the robot's is in the middle.
  int side() const { return side_; }
  std::size_t cells() const { return ground_.size(); }
  /// Cells of the memory that place() indexes.
  std::size_t places() const { return low_.size(); }
  // By index in the window: side() columns along y for each step along x.
  float before(int index) const { return floor_[static_cast<std::size_t>(index)]; }
  float height(int index) const { return ground_[static_cast<std::size_t>(index)]; }
  bool measured(int index) const { return gap_[static_cast<std::size_t>(index)] == 0; }
  /// Measured by the newest scan.
  bool fresh(int index) const { return fresh_[static_cast<std::size_t>(index)] != 0; }
  const std::uint8_t* gaps() const { return gap_.data(); }
  const float* heights() const { return ground_.data(); }
  /// The nearest cell of the window.
  int window(float x, float y) const {
    const int i = std::min(std::max(cell(x) - centre_x_, -half_), half_) + half_;
    const int j = std::min(std::max(cell(y) - centre_y_, -half_), half_) + half_;
    return i * side_ + j;
  }
  bool inside(float x, float y) const {
    return std::abs(cell(x) - centre_x_) <= half_ && std::abs(cell(y) - centre_y_) <= half_;
  }
  Eigen::Vector2f middle(int index) const {
    return {(static_cast<float>(centre_x_ + index / side_ - half_) + 0.5f) * kCell,
            (static_cast<float>(centre_y_ + index % side_ - half_) + 0.5f) * kCell};
  }
  /// Where a cell of the window is kept as long as it stays in it: an index below places().
  std::size_t place(int index) const {
    return slot(centre_x_ + index / side_ - half_, centre_y_ + index % side_ - half_);
  }
  /// Calls `forget(place)` for each cell that came into the window with this scan.
  template <class Forget>
  void entered(const Forget& forget) const {
    for (const std::size_t place : entered_) forget(place);
  }

 private:
  /// A cell of the window and the two before it on the way outwards.
  struct Step {
    std::uint32_t index, inner_a, inner_b;
    std::int16_t dx, dy;
    std::int8_t from_a_x, from_a_y, from_b_x, from_b_y;  ///< the way from those two
  };
  static constexpr float kNothing = 1e9f;

  static int cell(float v) { return floor_int(v * (1.0f / kCell)); }
  std::size_t slot(int ix, int iy) const {
    return static_cast<std::size_t>(((ix & mask_) << bits_) | (iy & mask_));
  }
  void roll(int x, int y);
  /// Whether ground that falls by -`rise` over the gap to a cell may be a ramp between two rings.
  bool falls_by_slope(const Step& step, float rise, std::uint8_t gap, float lidar) const;
  void fit_ground(const Offset& offset, float z, const Eigen::Vector2f& tilt, float blind);

  GroundParams params_;
  int half_, side_;            ///< cells around the robot, and of the window
  int bits_, mask_;            ///< of the torus, which is larger than a window
  int kept_;                   ///< what was measured is kept this many cells around the robot
  std::vector<Step> steps_{};  ///< the window from the middle outwards
  /// Allowed where the last measured cell is so many away: as ground to climb, to fall, and by slope alone.
  std::array<float, 256> rise_{}, fall_{}, climb_{}, limit_{};
  // On the torus.
  std::vector<float> low_, high_;  ///< of this scan
  std::vector<float> height_;      ///< of the map
  std::vector<float> stamp_;       ///< measured last
  std::vector<std::uint8_t> is_ground_;
  // In the window.
  std::vector<float> ground_, floor_;
  std::vector<std::uint8_t> gap_, fresh_;
  std::vector<Eigen::Vector3f> samples_{};  ///< of a fit, from the robot on
  PlaneFit plane_{};
  Eigen::Vector2f at_{0, 0};  ///< where plane_ begins
  float reach_{0};            ///< of the ground that plane_ was fitted to, m
  std::vector<std::size_t> entered_{};
  int centre_x_{}, centre_y_{};
  bool placed_{false}, grown_{false};
  float now_{};
};

}  // namespace adit::nav
