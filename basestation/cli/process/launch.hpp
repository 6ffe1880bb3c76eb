// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "basestation/cli/options.hpp"
#include "basestation/cli/process/line_socket.hpp"

namespace adit::station::cli {

/// Path of the socket of this operator's station. Error: cannot_write.
Result<std::string> socket_path(const Options& options);
/// Starts this operator's station as a process of its own, which outlives this one, and waits until it is
/// ready. Errors: the station's error when it could not start, no_answer. Uses no DDS in this process.
Result<void> launch(const Options& options);
/// Connects to the station's socket; starts the station if none is running, and reports that on stderr.
/// Errors: bad_argument for an unknown link, or if the running station is on another domain.
Result<LineSocket> connect_or_launch(const Options& options);
/// The program's exit code if connect_or_launch() failed.
int exit_without_station(const Error& error);

}  // namespace adit::station::cli
