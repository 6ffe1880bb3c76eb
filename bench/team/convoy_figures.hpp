// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/team/convoy_course.hpp"
#include "sim/rehearsal/rehearsal.hpp"

namespace adit::bench {

/// What one run of a ConvoyCourse gave, from true poses.
struct ConvoyFigures {
  double gap_error{};     ///< Root mean square of the gaps' errors while the leader drives at kFast, m.
  double smallest_gap{};  ///< Between two neighbours, outline to outline, m.
  double cross_track{};   ///< Root mean square of the distance from the leader's path, m.
  double largest_cross_track{};  ///< m
  /// The last robot is stationary so long after the leader, s.
  std::optional<double> stop{};
  double amplification{};  ///< Largest ratio of two neighbours' changes of speed at kStep.
  /// From peel-off until the gap to the robot ahead of the one that left is right within 30 %, s.
  std::optional<double> splice{};
  int contacts{};
  std::vector<std::string> complaints{};  ///< Broken rules.
};

ConvoyFigures figures_of(const ConvoyCourse& course, const sim::RunOutcome& run);

}  // namespace adit::bench
