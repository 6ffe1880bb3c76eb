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

  /// The robot's submaps in the map as it is now. The functions may be empty.
  struct Submaps {
    /// The pose of an anchor's submap; nothing: unknown, see findings::placed().
    std::function<std::optional<Pose3>(const findings::Anchor&)> pose{};
    std::function<std::uint64_t()> changes{};  ///< Rises with each change of a pose.
  };

  StairsReporter(std::string robot, FindingSource& findings, Submaps submaps)
      : robot_(std::move(robot)), findings_(findings), submaps_(std::move(submaps)) {}
  /// @param tracked  In the map frame.
  /// @param stamp    The robot's clock, ns.
  /// Errors: as of FindingSource::report().
  Result<void> take(const StairsTracker::Tracked& tracked, std::uint64_t stamp);
  /// It is gone: its finding is withdrawn. An unknown id is ignored.
  void withdraw(std::uint64_t id);
  /// All that this robot reported and has not withdrawn, in the order of their ids, where they are in the map
  /// as it is now; map frame. Valid until the next call.
  const std::vector<Staircase>& all() const;

 private:
  /// The staircase of a finding where it is now. Errors: as of findings::stairs_of().
  Result<Staircase> present(const findings::Finding& finding) const;
  /// The finding of the same flight.
  std::optional<findings::Key> known(const Staircase& stairs) const;

  std::string robot_;
  FindingSource& findings_;
  Submaps submaps_;
  std::map<std::uint64_t, findings::Key> keys_{};  ///< By id; at most kMostKeys.
  /// What all() returned last, and the changes of findings and of poses before.
  struct Decoded {
    std::uint64_t findings{}, poses{};
    std::vector<Staircase> stairs{};
  };
  mutable std::optional<Decoded> decoded_{};
};

/// For operators, for example "6 steps of 0.20 m, 1.2 m up".
std::string stairs_text(const Staircase& stairs);

}  // namespace adit::agent
