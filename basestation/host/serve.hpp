// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/client/options.hpp"

namespace adit::station::host {

/// Runs the station of this name in this process until a signal or a client ends it. Writes "ready" or the
/// reason of a failed start to `ready_fd` (-1: none) and closes it. Returns the exit code.
int serve(const client::StationOptions& options, int ready_fd);

}  // namespace adit::station::host
