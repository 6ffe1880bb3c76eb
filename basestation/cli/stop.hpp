// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/cli/options.hpp"

namespace adit::station::cli {

/// Runs `stop`: through the station if that accepts the command within 300 ms, otherwise with a participant
/// of this process that has the same name and identity. Returns the exit code.
int stop(const Options& options, const std::string& line, bool all);

}  // namespace adit::station::cli
