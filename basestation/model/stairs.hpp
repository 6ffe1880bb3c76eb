// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "basestation/model/found.hpp"
#include "core/geometry/staircase.hpp"

namespace adit::station {

/// Whether a robot of the fleet may climb a staircase.
struct Climber {
  std::string robot{};
  bool may{};
  std::string reason{};  ///< Why it may not; empty: it may.
  bool operator==(const Climber&) const = default;
};

/// A staircase of the map, merged from the findings of all robots.
struct StairsItem {
  std::uint32_t number{};  ///< Of the first finding of it at this station; commands name it by that.
  Staircase stairs{};      ///< Map frame.
  std::vector<std::uint32_t> findings{};  ///< Numbers of all findings that it was merged from.
  std::vector<std::string> robots{};      ///< Whose findings they are, by name.
  Verdict verdict{Verdict::open};         ///< On the finding whose number it has.
  std::string note{};                     ///< The operator's, on that finding.
  std::vector<Climber> fleet{};           ///< One for each robot that was heard, by name.
  bool operator==(const StairsItem&) const = default;
};

/// The answer to `stairs`.
struct StairsReport {
  std::vector<StairsItem> stairs{};  ///< By number.
  std::uint32_t unreadable{};        ///< Number of findings of kind stairs whose data is damaged.
  bool operator==(const StairsReport&) const = default;
};

/// Names of the robots that may climb a staircase.
std::vector<std::string> climbers_of(const StairsItem& item);
/// Direction of climbing, whole degrees from x towards y of the map frame, [0, 360).
int degrees_of(const Staircase& stairs);

/// "2 staircases could not be read"; empty: all could.
std::string unreadable_text(const StairsReport& report);

/// Reads the outcome of `stairs`. Errors: as of health_of(); malformed for a staircase that is not valid().
Result<StairsReport> stairs_of(const CommandOutcome& outcome);

}  // namespace adit::station
