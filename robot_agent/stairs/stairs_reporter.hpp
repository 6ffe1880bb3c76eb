// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/geometry/staircase.hpp"
#include "core/time/time.hpp"
#include "robot_agent/findings/finding_source.hpp"

namespace adit::agent {

/// Makes findings of staircases. One that is known already, also from before a restart, is not reported once
/// more.
class StairsReporter {
 public:
  static constexpr std::uint8_t kImportance = 5;

  StairsReporter(std::string robot, FindingSource& findings)
      : robot_(std::move(robot)), findings_(findings) {}
  /// @param stairs  Map frame.
  /// @param stamp   The robot's clock, ns.
  /// Errors: as of FindingSource::report().
  Result<void> take(const Staircase& stairs, std::uint64_t stamp);

 private:
  std::string robot_;
  FindingSource& findings_;
};

/// For operators, for example "6 steps of 0.20 m, 1.2 m up".
std::string stairs_text(const Staircase& stairs);

}  // namespace adit::agent
