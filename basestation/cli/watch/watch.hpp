// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "basestation/cli/options.hpp"
#include "basestation/client/connection.hpp"

namespace adit::station::cli {

/// Runs the live dashboard: redraws after each change and processes keys until q or Ctrl-C. Returns the exit code.
int watch(client::Connection& client, const Options& options);

}  // namespace adit::station::cli
