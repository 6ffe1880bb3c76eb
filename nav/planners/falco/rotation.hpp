// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "nav/planners/falco/correspondence.hpp"

namespace adit::nav {

/// Free rotation on the spot to each side, degrees, [0, 360].
struct TurnRoom {
  int left{360};
  int right{360};

  /// Both directions together cover the full circle.
  bool full() const { return left >= 360; }
};

/// Lookup table for rotation on the spot. Only obstacles between the inscribed and the circumscribed circle
/// of the body limit it, each by an angle that depends on its place. The table of those angles is polar like
/// the correspondence grid.
class RotationTable {
 public:
  RotationTable() = default;
  explicit RotationTable(const Footprint& body);

  int rings() const { return rings_; }
  /// Limits `room` by an obstacle in `ring` (< rings()) at `angle` in [0, 360) degrees from the body's x
  /// axis.
  void limit(int ring, int angle, TurnRoom& room) const;

 private:
  int rings_{0};
  std::vector<std::uint16_t> left_{}, right_{};  ///< Degrees of free rotation, per (ring, angle).
};

}  // namespace adit::nav
