// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "nav/correspondence.hpp"

namespace adit::nav {

/// How far a robot can turn on the spot, degrees from where it stands: [0, 360].
struct TurnRoom {
  int left{360};
  int right{360};

  /// Both directions together go all the way round.
  bool full() const { return left >= 360; }
};

/// Turning on the spot: only obstacles between the inscribed and the circumscribed circle of the body limit
/// it, each by an angle that depends on where it is; a table of those angles, polar like the correspondence
/// grid.
class RotationTable {
 public:
  RotationTable() = default;
  explicit RotationTable(const Footprint& body);

  int rings() const { return rings_; }
  /// Narrows `room` by an obstacle in `ring` (< rings()) at `angle` in [0, 360) degrees from the body's x.
  void limit(int ring, int angle, TurnRoom& room) const;

 private:
  int rings_{0};
  std::vector<std::uint16_t> left_{}, right_{};  ///< degrees of free turn, per (ring, angle)
};

}  // namespace adit::nav
