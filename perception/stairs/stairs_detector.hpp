// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/staircase.hpp"
#include "perception/stairs/slope_regions.hpp"
#include "perception/stairs/step_evidence.hpp"
#include "perception/stairs/step_model.hpp"
#include "perception/stairs/surface_cells.hpp"

namespace adit::perception {

/// Finds straight flights of equal steps in a cloud, up and down, within 6 m. Pure.
///
/// Unlike detectors of single edges (Sriganesh et al., "Fast Staircase Detection and Estimation using 3D
/// Point Clouds with Multi-detection Merging for Heterogeneous Robots", 2025), it averages before it looks:
/// regions that rise steadily, in them the period of the distances from their plane, then all points'
/// distances from equal steps. A flight is accepted where equal steps explain the points better than a plane
/// (Bayesian information criterion), and where the faces differ little from them.
class StairsDetector {
 public:
  /// @param points   In a level frame, z up, m; the oldest first.
  /// @param eye      Place of the sensor, in the same frame.
  /// @param hides    Whether the sensor sees no riser from above and no tread from below, as a lidar. False
  /// for points
  ///     of many places, or of a model.
  /// @return  In the frame of the points, the nearest first.
  std::vector<Staircase> detect(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& eye,
                                bool hides = true);

 private:
  std::optional<Staircase> judge(const SlopeRegion& region, std::span<const Eigen::Vector3f> points,
                                 const Eigen::Vector3f& eye, bool hides);

  /// The points about a region's plane.
  void gather(const SlopeRegion& region, std::span<const Eigen::Vector3f> points);
  /// One of `stride` points.
  void collect(const SlopeRegion& region, const Eigen::Vector2f& uphill, std::size_t stride);
  /// False: nothing repeats.
  bool find_direction(const SlopeRegion& region, Eigen::Vector2f& uphill);
  void thin_core();

  SurfaceCells cells_{};
  SlopeRegions regions_{};
  StepFitter fitter_{};
  StepEvidence evidence_{};
  SlopeExtent extent_{};
  std::vector<Eigen::Vector3f> gathered_{};  ///< From the region's centre.
  std::vector<SlopePoint> around_{}, core_{};
  std::vector<std::size_t> slices_{};
};

}  // namespace adit::perception
