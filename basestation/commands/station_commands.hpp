// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/commands/outcome.hpp"
#include "basestation/content/content.hpp"
#include "basestation/model/counts.hpp"

/// Commands that the station carries out itself.
namespace adit::station {

/// The data that queries report on.
struct QuerySubject {
  const StationParams& params;
  const Fleet& fleet;
  const Counts& counts;
  Content& content;
  Duration up{};  ///< Time since the station's start.
  Time now{};
};

/// Answers `list`, `status`, `net`, `actions`, `health`, `findings` or `stairs`.
Outcome query_outcome(const command::Request& request, const QuerySubject& subject);
/// Why there is no robot of a name.
std::string unknown_text(const Fleet& fleet);

}  // namespace adit::station
