// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace adit::perception {

/// Thins clouds to about the same number of points, whatever the geometry: one point per voxel, with an edge
/// that follows the last cloud (as in LOCUS 2.0, Reinke et al. 2022).
class Thinner {
 public:
  /// Number of points, edges of the voxels and ranges.
  struct Params {
    std::size_t wanted{1500};  ///< Points that are to remain.
    float min_edge{0.1f};      ///< m
    float max_edge{2.0f};      ///< m
    float min_range{0.4f};     ///< Nearer points are left out, m.
    float max_range{100.0f};   ///< Farther points are left out, m.
  };
  explicit Thinner(const Params& params) : params_(params) {}

  /// The points that remain, in the order of `points`. The reference holds until the next call.
  const std::vector<Eigen::Vector3f>& thin(std::span<const Eigen::Vector3f> points);
  float edge() const { return edge_; }

 private:
  Params params_;
  float edge_{0.0f};                   ///< 0: no cloud yet.
  std::vector<std::uint64_t> seen_{};  ///< Hash set of voxel keys, each with the number of its cloud.
  std::vector<std::uint32_t> cloud_{};
  std::uint32_t number_{};
  std::vector<Eigen::Vector3f> thinned_{};
};

}  // namespace adit::perception
