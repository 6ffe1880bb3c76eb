// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "basestation/cli/options.hpp"
#include "basestation/client/connection.hpp"

namespace adit::station::cli {

/// Drives a robot by keyboard or game controller until Esc, Ctrl-C or a refusal. Returns the exit code.
int teleop(client::Connection& client, const Options& options, const std::string& robot);

}  // namespace adit::station::cli
