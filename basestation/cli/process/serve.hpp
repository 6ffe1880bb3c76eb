#pragma once
#include "basestation/cli/options.hpp"

namespace adit::station::cli {

/// Runs the station of this name in this process until it is told to end. `ready_fd` (-1: none) is told
/// "ready" or why it could not start, then closed. Returns the exit code.
int serve(const Options& options, int ready_fd);

}  // namespace adit::station::cli
