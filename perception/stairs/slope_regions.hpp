// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "perception/stairs/surface_cells.hpp"

namespace adit::perception {

/// Surfaces that belong together and rise steadily: a staircase, a ramp, or rubble.
struct SlopeRegion {
  Eigen::Vector3f centre{Eigen::Vector3f::Zero()};  ///< Of its cells, m.
  Eigen::Vector2f uphill{Eigen::Vector2f::Zero()};  ///< Unit vector.
  float slope{};                                    ///< Rise per run.
  std::vector<Eigen::Vector3f> cells{};             ///< Their means, from the centre, m.
};

/// Where a region lies along a direction and across it, m from its centre.
struct SlopeExtent {
  float begin{}, end{};
  float right{}, left{};  ///< Of its inner seven tenths: beside it lie what its borders lean on.
};
SlopeExtent extent(const SlopeRegion& region, const Eigen::Vector2f& uphill);

/// Finds the regions whose planes over 0.8 m rise by 0.3 to 1.2 rad, the largest first, at most kMostRegions.
class SlopeRegions {
 public:
  static constexpr std::size_t kMostRegions = 6;
  const std::vector<SlopeRegion>& find(const SurfaceCells& cells);

 private:
  struct Local {
    Eigen::Vector2f gradient{Eigen::Vector2f::Zero()};
    bool steep{false};
  };
  Local plane_at(const SurfaceCells& cells, const SurfaceCell& cell) const;
  SlopeRegion measured(const SurfaceCells& cells) const;

  std::vector<Local> locals_{};
  std::vector<std::uint8_t> taken_{};
  std::vector<std::size_t> open_{}, members_{};
  std::vector<SlopeRegion> regions_{};
};

}  // namespace adit::perception
