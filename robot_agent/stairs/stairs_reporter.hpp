// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/geometry/staircase.hpp"
#include "core/time/time.hpp"
#include "robot_agent/findings/finding_source.hpp"
#include "robot_agent/stairs/stairs_tracker.hpp"

namespace adit::agent {

/// Keeps findings of the robot's staircases as its searches know them. One that is known already, also from
/// before a restart, is not reported once more; a corrected map moves them.
class StairsReporter {
 public:
  static constexpr std::uint8_t kImportance = 5;
  static constexpr std::size_t kMostKeys = 1024;

  /// The present pose of an anchor's submap; may be empty, or return nothing: see findings::placed().
  using FindSubmap = std::function<std::optional<Pose3>(const findings::Anchor&)>;

  StairsReporter(std::string robot, FindingSource& findings, FindSubmap find_submap)
      : robot_(std::move(robot)), findings_(findings), find_submap_(std::move(find_submap)) {}
  /// @param tracked  In the map frame.
  /// @param stamp    The robot's clock, ns.
  /// Errors: as of FindingSource::report().
  Result<void> take(const StairsTracker::Tracked& tracked, std::uint64_t stamp);
  /// It is gone: its finding is withdrawn. An unknown id is ignored.
  void withdraw(std::uint64_t id);
  /// All that this robot reported and has not withdrawn, in the order of their ids, where they are in the map
  /// as it is now; map frame.
  std::vector<Staircase> all() const;

 private:
  /// The staircase of a finding where it is now. Errors: as of findings::stairs_of().
  Result<Staircase> present(const findings::Finding& finding) const;
  /// The finding of the same flight.
  std::optional<findings::Key> known(const Staircase& stairs) const;

  std::string robot_;
  FindingSource& findings_;
  FindSubmap find_submap_;
  std::map<std::uint64_t, findings::Key> keys_{};  ///< By id; at most kMostKeys.
};

/// For operators, for example "6 steps of 0.20 m, 1.2 m up".
std::string stairs_text(const Staircase& stairs);

}  // namespace adit::agent
