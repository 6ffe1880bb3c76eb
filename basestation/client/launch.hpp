// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "basestation/client/line_socket.hpp"
#include "basestation/client/options.hpp"

namespace adit::station::client {

/// A connection to a station, and what the operator should know of it; `remark` is empty otherwise.
struct Connected {
  LineSocket socket{};
  std::string remark{};
};

/// The words that run the program `basestation` for this operator, on the same network.
std::vector<std::string> program_words(const StationOptions& options);
/// Starts this operator's station as a process of its own, which outlives this one, and waits until it is
/// ready. Errors: the station's error when it could not start, no_answer. Uses no DDS in this process.
Result<void> launch(const StationOptions& options);
/// Connects to the station's socket; starts the station if none is running. Errors: bad_argument for an
/// unknown link, or if the running station is on another domain.
Result<Connected> connect_or_launch(const StationOptions& options);

}  // namespace adit::station::client
