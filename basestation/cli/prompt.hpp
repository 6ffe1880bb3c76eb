#pragma once
#include "basestation/cli/options.hpp"

namespace adit::station::cli {

/// Takes command lines until `quit` or Ctrl-D: in a terminal with history, completion and notifications as
/// they come; from a pipe line by line. The exit code is that of the last line that was not done, else 0.
int prompt(const Options& options);

}  // namespace adit::station::cli
