// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "core/findings/finding.hpp"
#include "core/geometry/staircase.hpp"

/// Staircases of the map from the reports of all robots. A report stays as it is; the staircases are computed
/// from all of them, so that every station that has the same reports has the same staircases.
namespace adit::findings {

/// A staircase as one finding states it.
struct SeenStairs {
  Key key{};
  Staircase stairs{};
  bool operator==(const SeenStairs&) const = default;
};

/// A staircase, and the findings that it was merged from.
struct MergedStairs {
  Staircase stairs{};
  std::vector<SeenStairs> seen{};  ///< At least one, in the order of their keys.
  bool operator==(const MergedStairs&) const = default;
};

/// Whether two reports can be of one flight: the headings differ by 15 degrees at most, the axes by less than
/// half of the smaller width, both flights climb along one line, and neither their lengths nor their heights
/// are farther apart than one step. Standard deviations widen the last two, but never up to the shortest
/// landing or to the headroom below another flight.
bool is_same_flight(const Staircase& a, const Staircase& b);

/// One staircase from reports of it, at least one: means weighted by their information, and all steps that
/// any of them has.
Staircase combined(std::span<const SeenStairs> seen);

/// Merges reports that are of the same flight, also by way of a third one. The result is in the order of
/// the first keys and does not depend on the order of `seen`.
std::vector<MergedStairs> merge_stairs(std::vector<SeenStairs> seen);

}  // namespace adit::findings
