// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/cli/client.hpp"

namespace adit::station::cli {

/// Runs the live dashboard: redraws at 5 Hz and processes keys until q or Ctrl-C. Returns the exit code.
int watch(Client& client, const Options& options);

}  // namespace adit::station::cli
