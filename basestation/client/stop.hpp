// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "basestation/client/options.hpp"
#include "basestation/model/outcome.hpp"

namespace adit::station::client {

/// Runs a `stop` line through the station and waits for its end. Nothing: the station does not begin within
/// 0.3 s, or does not say how it ended, so that the stop must go out without it.
std::optional<CommandOutcome> stop_by_station(const StationOptions& options, const std::string& front_end,
                                              const std::string& line);

/// Runs a `stop` line and waits for its end: through the station if possible, otherwise as
/// the program of the options, which needs no station. May block for 30 s.
CommandOutcome run_stop(const StationOptions& options, const std::string& front_end, const std::string& line);

}  // namespace adit::station::client
