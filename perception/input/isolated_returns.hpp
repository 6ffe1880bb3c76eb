// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "perception/types/sweep.hpp"

namespace adit::perception {

/// Finds returns without a neighbour of about the same range, as dust, rain and mixed returns give them.
///
/// A neighbour is a return of the same ring or of the ring above or below, up to two columns away, whose
/// range differs by at most 0.1 m + 1 %. Thin things that are seen by one beam alone look the same: the
/// result is for the odometry, not for avoiding obstacles.
class IsolatedReturns {
 public:
  static constexpr std::uint16_t kMaxRings = 128;

  /// One number for each point of the sweep, not 0: isolated. Empty for a sweep without rings. The reference
  /// holds until the next call.
  const std::vector<std::uint8_t>& find(const Sweep& sweep);

 private:
  std::vector<float> ranges_{};         ///< By ring and column, m; 0: none.
  std::vector<std::uint32_t> cells_{};  ///< Of each point.
  std::vector<std::uint8_t> isolated_{};
};

}  // namespace adit::perception
