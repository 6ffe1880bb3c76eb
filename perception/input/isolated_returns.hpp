// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "perception/types/sweep.hpp"

namespace adit::perception {

/// Finds returns without a neighbour of about the same range, as dust, rain and mixed returns give them.
///
/// A neighbour is a return of the same ring or of the ring above or below, up to two columns away, whose
/// range differs by at most 0.1 m + 1 %. Thin things that are seen by one beam alone look the same: the
/// result is for the odometry, not for avoiding obstacles.
///
/// Rows of cells are rings, so a ring must be a cone of one elevation. The lines of a lidar that scans a
/// rosette (Livox) are none: the first sweep that shows it decides, and such a lidar has no mask.
class IsolatedReturns {
 public:
  static constexpr std::uint16_t kMaxRings = 128;

  /// More isolated returns than this share say that the mask is wrong, or that all is dust: there is none.
  static constexpr double kMost = 0.4;

  /// One number for each point of the sweep, not 0: isolated. Empty for a sweep without rings that are cones,
  /// and when too many are isolated. The reference holds until the next call.
  const std::vector<std::uint8_t>& find(const Sweep& sweep);
  /// Whether the last sweep had too many.
  bool scattered() const { return scattered_; }

 private:
  /// Whether the points of each ring have one elevation; nothing: the sweep has too few to say.
  static std::optional<bool> are_cones(const Sweep& sweep, std::uint32_t rings);

  std::optional<bool> cones_{};
  bool scattered_{false};
  std::vector<float> ranges_{};         ///< By ring and column, m; 0: none.
  std::vector<std::uint32_t> cells_{};  ///< Of each point.
  std::vector<std::uint8_t> isolated_{};
};

}  // namespace adit::perception
