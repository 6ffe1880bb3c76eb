// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "nav/terrain/ground_grid.hpp"
#include "nav/terrain/terrain_params.hpp"
#include "nav/terrain/view.hpp"

namespace adit::nav {

/// Where the ground is missing: edges, holes, stairs down. A ray that went on below where ground should have
/// stopped it shows one where it passed the ground's height, and so does a ray that did not come back though
/// its ring does elsewhere (a hole too deep to see, water) and it did before; what lies between that place
/// and the last ground seen counts, too. Ground that is measured there takes it back. What cannot be seen,
/// below the lowest ray, is remembered.
class Drops {
 public:
  explicit Drops(const TerrainParams& params);
  void clear();

  void begin_scan(const GroundGrid& ground, float now);
  /// A return that lies below the ground.
  void below(const View& view, const Eigen::Vector3f& point, const GroundGrid& ground);
  /// Directions without a return.
  void silent(const View& view, const RayImage& rays, const GroundGrid& ground);
  /// Works out the cells.
  void finish(const View& view, const RayImage& rays, const GroundGrid& ground);

  /// Cells of the ground's window, by index.
  std::span<const std::uint16_t> cells() const { return cells_; }

 private:
  void pass(const View& view, const Eigen::Vector3f& ray, float end, int votes, const GroundGrid& ground);
  void vote(int index, int votes, const GroundGrid& ground);

  TerrainParams params_;
  std::vector<std::uint8_t> votes_;  ///< of a GroundGrid's torus
  std::vector<float> stamp_;
  std::vector<std::uint8_t> quiet_;  ///< scans without a return in a direction; kUnknown: there never was one
  std::vector<std::uint16_t> cells_{};
  bool any_{false};
  float now_{};
};

}  // namespace adit::nav
