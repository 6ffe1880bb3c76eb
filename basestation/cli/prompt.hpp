// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/cli/options.hpp"

namespace adit::station::cli {

/// Reads and runs command lines until `quit` or Ctrl-D: in a terminal with history, completion and
/// notifications; from a pipe line by line. Returns the exit code of the last line that failed, otherwise 0.
int prompt(const Options& options);

}  // namespace adit::station::cli
