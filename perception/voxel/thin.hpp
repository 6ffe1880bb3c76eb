// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace adit::perception {

/// Thins clouds to about the same number of points, whatever the geometry: one point per voxel, with an edge
/// that follows the last cloud (as in LOCUS 2.0, Reinke et al. 2022).
///
/// Each point of a voxel remains with the same probability, by a hash of its number. The first one would not
/// do: a sweep comes in the order of its angle, so that of the points near a voxel's border those remain
/// whose range error pushes them into it early, outwards on one side of the body and inwards on the other: a
/// turn of the cloud, which adds up (0.7 degrees in 280 m of corridor).
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

  /// The points that remain, in the order in which their voxels came. The reference holds until the next
  /// call.
  const std::vector<Eigen::Vector3f>& thin(std::span<const Eigen::Vector3f> points);
  float edge() const { return edge_; }

 private:
  Params params_;
  float edge_{0.0f};  ///< 0: no cloud yet.
  struct Voxel {
    std::uint64_t key{};
    std::uint32_t points{};  ///< So far.
  };
  /// A point and its voxel.
  struct Place {
    const Eigen::Vector3f* point{};
    std::uint64_t key{}, hash{};
  };
  static constexpr std::uint32_t kFree = ~std::uint32_t{0};
  void take(const Place& place);
  /// Index of the first slot in which a voxel is searched.
  std::size_t first_slot(std::uint64_t hash) const { return (hash ^ hash >> 29) & (slots_.size() - 1); }
  /// The slot of a voxel; kFree in it: the voxel is new.
  std::uint32_t& slot(std::uint64_t key, std::uint64_t hash);
  /// Makes an index with `count` slots, a power of two, for the voxels so far.
  void clear_slots(std::size_t count);

  std::vector<Eigen::Vector3f> thinned_{};
  std::vector<Voxel> voxels_{};  ///< Of each point in thinned_.
  /// Hash table of indices into voxels_, at most half full. It holds nothing else, so that it stays in the
  /// processor's cache.
  std::vector<std::uint32_t> slots_{};
};

}  // namespace adit::perception
