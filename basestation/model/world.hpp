// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "basestation/model/counts.hpp"
#include "basestation/model/notice.hpp"
#include "basestation/model/robot.hpp"

namespace adit::station {

/// A station on the air, this one or another operator's.
struct StationSummary {
  std::string name{};
  bool self{};
  double age{};                                 ///< Time since it was heard, s.
  bool lost{};                                  ///< Not heard for 2.5 s.
  std::optional<std::array<float, 3>> place{};  ///< Map frame, m; unset: unknown.
  bool operator==(const StationSummary&) const = default;
};

/// What an agent sends and receives, bytes/s, and the age of its report, s.
struct AgentRate {
  double out{}, in{}, age{};
  bool operator==(const AgentRate&) const = default;
};

/// How many findings a station lists. Front ends ask for the list when it changed.
struct FindingCounts {
  std::uint32_t listed{};   ///< Withdrawn and rejected ones, too.
  std::uint32_t open{};     ///< Neither judged nor withdrawn.
  std::uint64_t changes{};  ///< Changes of findings and judgements since the station's start.
  bool operator==(const FindingCounts&) const = default;
};

/// All that a station reports to its front ends at one time.
struct World {
  double at{};            ///< The station's clock, s; its start means nothing.
  std::string station{};  ///< Name of the operator.
  std::string link{};     ///< Link profile; empty: the traffic is not limited.
  Counts commands{};
  FindingCounts findings{};
  std::vector<Robot> robots{};             ///< By name; in natural order at front ends.
  std::vector<StationSummary> stations{};  ///< This station first.
  std::vector<Notice> notices{};           ///< The newest, oldest first.
  std::map<std::string, AgentRate> traffic{};

  /// The robot of that name; null if there is none.
  const Robot* robot(const std::string& name) const;
};

}  // namespace adit::station
