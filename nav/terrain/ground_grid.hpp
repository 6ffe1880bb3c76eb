// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "core/geometry/round_down.hpp"
#include "nav/terrain/plane_fit.hpp"

namespace adit::nav {

/// Parameters of GroundGrid.
struct GroundParams {
  float sigma_tilt{0.035f};  ///< Standard deviation of the body's attitude, rad.
  float slope{0.35f};        ///< Maximum ground slope, rise per run, [0, 1.5].
  float rise{0.06f};         ///< Maximum rise from one cell to the next, m, [0.01, 0.5].
  float drop{0.2f};          ///< Maximum fall of the ground, m, [0.05, 2].
  /// Up to this range rays are steep and dense enough to distinguish an edge from a ramp, m; farther away
  /// ground may fall by the slope from one ring to the next.
  float sure{2.3f};
  float rings{0.035f};  ///< Angle between two rings of the lidar, rad.
  float range{4.5f};    ///< Radius of the window around the robot, m, [1, 25].
  /// Maximum height of a first return above the preceding ground, m, (0, 5]: a wall that one level ring sees
  /// is not ground.
  float most{0.35f};
  float memory{60.0f};  ///< Lifetime of a height without a new measurement, s, (0, 600].
};

/// Elevation map of the ground around the robot: 10 cm cells in a grid that rolls with it. The height of a
/// cell is its lowest return, averaged over scans. The ground is grown outwards from the robot's feet: a cell
/// is ground when its height is consistent with its inner neighbours and the fitted plane within the limits
/// of slope, rise and drop. Other cells (walls, holes, cells without returns) inherit the height of those
/// neighbours.
///
/// The lidar sees no ground close to the robot, and an error of the body's attitude grows with the distance
/// to the first ring. Therefore a plane is fitted to the known ground around the robot, with the body's
/// attitude as the prior. Unmeasured ground continues along this plane, and until a first cell is accepted
/// the tolerance grows with the distance by the plane's remaining uncertainty.
///
/// Heights are relative to the map's own datum: odometry may lack a height (wheels), drift in it, or tilt
/// differently from the body. Each scan is registered to the map in height, roll and pitch by a robust fit to
/// the height differences (after the drift compensation of P. Fankhauser et al., *Probabilistic terrain
/// mapping for mobile robots with uncertain localization*, 2018).
class GroundGrid {
 public:
  static constexpr float kCell = 0.1f;         ///< m
  static constexpr std::uint8_t kNever = 200;  ///< Gap of a cell without a measured cell on the path to it.

  /// Correction of a scan's heights relative to the map, about the robot's place, m.
  struct Offset {
    float height{0};
    Eigen::Vector2f gradient{0, 0};  ///< Rise per metre along x and y.
    float sigma_gradient{0};         ///< Of the gradient in its less certain direction.
    bool none() const { return height == 0.0f && gradient.isZero(0); }
  };

  explicit GroundGrid(const GroundParams& params = {});
  void clear();

  /// Starts a scan of a robot at (x, y), m; `now`: s, not decreasing.
  void begin_scan(float x, float y, float now);
  /// Adds a return at (x, y, z), m, within range of the robot.
  void add(float x, float y, float z) {
    const std::size_t s = slot(cell(x), cell(y));
    low_[s] = z < low_[s] ? z : low_[s];
    high_[s] = z > high_[s] ? z : high_[s];
  }
  /// Computes the scan's correction relative to the map; zero when they overlap too little.
  Offset disagreement();
  /// Inserts the scan's heights, corrected by `offset`, and updates the ground around a robot at height `z`
  /// with attitude `tilt` (rise per metre along x and y). `lidar`: from the robot along x and y, and above
  /// the plane of its attitude, m. `blind`: horizontal distance from the robot at which the lowest ray meets
  /// level ground, m.
  void grow(const Offset& offset, float z, const Eigen::Vector2f& tilt, const Eigen::Vector3f& lidar,
            float blind);
  /// The plane of the ground around the robot after the last grow(); its height is the one under the robot.
  const PlaneFit& plane() const { return plane_; }
  /// Minimum depth of a place below that plane, m: the ground may bend away from the plane outside of the
  /// area of the fit.
  float below_plane(const Eigen::Vector3f& p) const;
  /// Whether grow() was called since the last clear().
  bool grown() const { return grown_; }

  /// Height of the ground at (x, y), m; outside of the window the height at its edge.
  float at(float x, float y) const { return ground_[window(x, y)]; }
  /// Support height: at(), but no higher than the slope permits from the preceding cells. The robot climbs
  /// from there.
  float before(float x, float y) const { return floor_[window(x, y)]; }
  /// A return that is lower than at() by more than this shows that the ground is missing, m.
  float drop_limit(int index) const { return limit_[gap_[static_cast<std::size_t>(index)]]; }
  /// Whether the ground in the cell of (x, y) was measured and not inherited.
  bool measured(float x, float y) const { return gap_[window(x, y)] == 0; }

  /// Number of cells of the window along each axis; the robot is in the middle.
  int side() const { return side_; }
  std::size_t cells() const { return ground_.size(); }
  /// Number of cells of the torus that place() indexes.
  std::size_t places() const { return low_.size(); }
  // By index in the window: side() columns along y for each step along x.
  float before(int index) const { return floor_[index]; }
  float height(int index) const { return ground_[index]; }
  bool measured(int index) const { return gap_[index] == 0; }
  /// Whether the newest scan measured it.
  bool fresh(int index) const { return fresh_[index] != 0; }
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
  Eigen::Vector2f middle(int index) const { return middle(index / side_, index % side_); }
  /// The same by row along x and column along y.
  Eigen::Vector2f middle(int i, int j) const {
    return {(static_cast<float>(centre_x_ + i - half_) + 0.5f) * kCell,
            (static_cast<float>(centre_y_ + j - half_) + 0.5f) * kCell};
  }
  /// Address of a window cell on the torus, below places(); constant while the cell is in the window.
  std::size_t place(int index) const {
    return slot(centre_x_ + index / side_ - half_, centre_y_ + index % side_ - half_);
  }
  /// Places of the cells that entered the window with this scan.
  const std::vector<std::size_t>& entered() const { return entered_; }

 private:
  /// A cell of the window and its two inner neighbours.
  struct Step {
    std::uint32_t index, inner_a, inner_b;
    std::int16_t dx, dy;
    std::int8_t from_a_x, from_a_y, from_b_x, from_b_y;  ///< Steps from those two, cells.
  };
  static constexpr float kNothing = 1e9f;

  static int cell(float v) { return round_down(v * (1.0f / kCell)); }
  std::size_t slot(int ix, int iy) const {
    return static_cast<std::size_t>(((ix & mask_) << bits_) | (iy & mask_));
  }
  void roll(int x, int y);
  /// Whether ground that falls by -`rise` over the gap before a cell may be a ramp between two rings.
  bool falls_by_slope(const Step& step, float rise, std::uint8_t gap, const Eigen::Vector3f& lidar) const;
  void fit_ground(const Offset& offset, float z, const Eigen::Vector2f& tilt, float blind);

  GroundParams params_;
  int half_, side_;            ///< Cells around the robot; cells of the window.
  int bits_, mask_;            ///< Of the torus, which is larger than the window.
  int memory_half_;            ///< Measurements are stored this many cells around the robot.
  std::vector<Step> steps_{};  ///< The window from the middle outwards.
  /// Limits by the number of cells since the last measured one: rise, fall, rise by slope alone, and drop.
  std::array<float, 256> rise_{}, fall_{}, climb_{}, limit_{};
  // On the torus.
  std::vector<float> low_, high_;  ///< Of this scan.
  std::vector<float> height_;      ///< Of the map.
  std::vector<float> stamp_;       ///< Time of the last measurement, s.
  std::vector<std::uint8_t> is_ground_;
  // In the window.
  std::vector<float> ground_, floor_;
  std::vector<std::uint8_t> gap_, fresh_;
  std::vector<Eigen::Vector3f> samples_{};  ///< Of a fit, relative to the robot.
  PlaneFit plane_{};
  Eigen::Vector2f at_{0, 0};  ///< Origin of plane_.
  float reach_{0};            ///< Radius of the ground that plane_ was fitted to, m.
  std::vector<std::size_t> entered_{};
  int centre_x_{}, centre_y_{};
  bool placed_{false}, grown_{false};
  float now_{};
};

}  // namespace adit::nav
